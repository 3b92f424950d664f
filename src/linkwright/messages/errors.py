"""The errors for interfaces, message data and field values."""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase


class InterfaceNotFoundError(LinkwrightError):
    """Raised when no message, service or action has the given name."""


class DefinitionError(LinkwrightError):
    """Raised when an interface file has errors, with one finding for each."""


class MessageDataError(LinkwrightError, ValueError):
    """Raised if bytes are not a message of the expected type, or if serialization fails."""


class FieldValueError(LinkwrightError, ValueError):
    """Raised when values, for example from YAML, are invalid for the fields of a message."""


class UnknownFieldError(FieldValueError, AttributeError):
    """Raised when a message has no field with the given name."""


class WrongValueError(FieldValueError, TypeError):
    """Raised when a value is invalid for its field."""


def data_error(code: str, message: Phrase) -> MessageDataError:
    """Create the error for a message that cannot be deserialized or serialized."""
    return MessageDataError(Diagnostic(code, message))
