"""The errors of this room."""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase


class InterfaceNotFoundError(LinkwrightError):
    """No message, service or action has this name."""


class DefinitionError(LinkwrightError):
    """An interface file that cannot be used; one diagnostic for each mistake in it."""


class MessageDataError(LinkwrightError, ValueError):
    """Bytes that are no message of the type, or a message that cannot be written as bytes."""


class FieldValueError(LinkwrightError, ValueError):
    """Values, as a user writes them in YAML, that do not fit the fields of a message."""


class UnknownFieldError(FieldValueError, AttributeError):
    """A field that the message does not have."""


class WrongValueError(FieldValueError, TypeError):
    """A value that a field cannot have."""


def data_error(code: str, message: Phrase, hint: Phrase | None = None) -> MessageDataError:
    """The error for bytes or for a message on its way to them."""
    return MessageDataError(Diagnostic(code, message, hint=hint))
