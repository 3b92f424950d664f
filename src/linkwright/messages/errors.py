"""The errors of this room."""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase


class InterfaceNotFoundError(LinkwrightError):
    """No message, service or action has this name."""


class DefinitionError(LinkwrightError):
    """An interface file cannot be used; one diagnostic for each mistake in it."""


class MessageDataError(LinkwrightError, ValueError):
    """Bytes are not a message of the type, or a message cannot be written as bytes."""


class FieldValueError(LinkwrightError, ValueError):
    """Values of YAML do not fit the fields of a message."""


class UnknownFieldError(FieldValueError, AttributeError):
    """A message lacks a field."""


class WrongValueError(FieldValueError, TypeError):
    """A field cannot have a value."""


def data_error(code: str, message: Phrase) -> MessageDataError:
    """The error for bytes that cannot be read, or for a message that cannot be written."""
    return MessageDataError(Diagnostic(code, message))
