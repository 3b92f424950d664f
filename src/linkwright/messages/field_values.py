"""Set the fields of a message from plain data, such as the YAML of ``ros2 topic pub``."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from linkwright.diagnostics import Diagnostic, Phrase, did_you_mean, foreign, joined, phrase, quoted
from linkwright.messages.checks import is_array, is_scalar
from linkwright.messages.classes import get_message
from linkwright.messages.definitions.interfaces import Container, FieldType, Primitive
from linkwright.messages.errors import UnknownFieldError, WrongValueError
from linkwright.messages.message import Message, definition_of

_HEADER = "std_msgs/msg/Header"
_TIME = "builtin_interfaces/msg/Time"

StampSetter = Callable[[Any], None]
"""A function that sets a field to a builtin_interfaces/msg/Time, its argument."""


def set_fields(
    message: Message, values: Mapping[str, Any], *, expand_header_auto: bool = False, expand_time_now: bool = False
) -> list[StampSetter]:
    """Set the fields of a message from numbers, bools, strings, lists and nested mappings.

    A nested message is replaced, so fields missing in the values have their defaults. An integer is accepted for a
    float, a number for a string, and a string for a number if the string contains a number.

    Args:
        message: the message to change.
        values: the values by field name.
        expand_header_auto: whether to accept ``auto`` for a Header; its stamp is then the time of sending.
        expand_time_now: whether to accept ``now`` for a Time, which is then the time of sending.

    Returns:
        A function for each ``auto`` or ``now``, which sets the field to the Time that is its argument.

    Raises:
        UnknownFieldError: MSG301, a field does not exist; also an AttributeError.
        WrongValueError: MSG302, a value is invalid for its field; also a TypeError.
    """
    setter = _Setter(expand_header=expand_header_auto, expand_time=expand_time_now)
    setter.fields(message, values, "")
    if setter.diagnostics:
        unknown = setter.diagnostics[0].code == "MSG301"
        raise (UnknownFieldError if unknown else WrongValueError)(*setter.diagnostics)
    return setter.stamps


class _InvalidValueError(Exception):
    """Raised when a value is invalid for a field.

    The argument describes a valid value.
    """


class _Setter:
    """A setter of fields from plain data that collects all errors."""

    def __init__(self, *, expand_header: bool, expand_time: bool) -> None:
        self._expand_header = expand_header
        self._expand_time = expand_time
        self.diagnostics: list[Diagnostic] = []
        self.stamps: list[StampSetter] = []

    def fields(self, message: Message, values: Any, path: str) -> None:
        if not isinstance(values, Mapping):
            subject = quoted(path) if path else phrase("a {type}", type=message.TYPE_NAME)
            names = joined(field.name for field in definition_of(type(message)).fields)
            self._report_invalid_value(
                phrase(
                    "{subject} must be a mapping of fields to values, not {actual}",
                    subject=subject,
                    actual=_describe_value(values),
                ),
                phrase("its fields: {names}", names=names or phrase("none")),
            )
            return
        types_by_name = {field.name: field.type for field in definition_of(type(message)).fields}
        for name, value in values.items():
            kind = types_by_name.get(name)
            if kind is None:
                self._report_unknown_field(message, str(name), path)
            else:
                self._set_field(message, name, kind, value, f"{path}.{name}" if path else name)

    def _set_field(self, message: Message, name: str, kind: FieldType, value: Any, path: str) -> None:
        if self._is_stamp(message, name, kind, value):
            return
        try:
            setattr(message, name, self._convert_value(kind, value, path))
        except _InvalidValueError as unfit:
            self._report_invalid_value(
                phrase("'{path}' cannot be {value}", path=path, value=_describe_value(value)),
                phrase("it must be {expected}", expected=unfit),
            )
        except AssertionError as error:
            reason = str(error).partition(" must ")[2]
            self._report_invalid_value(
                phrase("'{path}' cannot be {value}", path=path, value=_describe_value(value)),
                phrase("it must {reason}", reason=foreign(reason)),
            )

    def _is_stamp(self, message: Message, name: str, kind: FieldType, value: Any) -> bool:
        if kind.container is not Container.ONE:
            return False
        if kind.base == _HEADER and value == "auto" and self._expand_header:
            self.stamps.append(partial(setattr, getattr(message, name), "stamp"))
            return True
        if kind.base == _TIME and value == "now" and self._expand_time:
            self.stamps.append(partial(setattr, message, name))
            return True
        return False

    # --- values ---------------------------------------------------------------------------------------------

    def _convert_value(self, kind: FieldType, value: Any, path: str) -> Any:
        primitive = kind.primitive
        if kind.container is Container.ONE:
            return (
                self._convert_message(kind, value, path)
                if primitive is None
                else _convert_primitive(primitive, kind, value)
            )
        if kind.base in {"uint8", "char"} and isinstance(value, (bytes, bytearray)):
            value = list(value)
        if not (isinstance(value, (Sequence, array)) or is_array(value)) or isinstance(value, (str, bytes)):
            raise _InvalidValueError(_describe_type(kind))
        item_type = FieldType(kind.base, kind.string_bound)
        values = [self._convert_value(item_type, item, f"{path}[{index}]") for index, item in enumerate(value)]
        has_fixed_length = kind.container is Container.ARRAY
        if kind.size is not None and (len(values) > kind.size or (has_fixed_length and len(values) < kind.size)):
            raise _InvalidValueError(
                phrase("{list}, not of {count} values", list=_describe_type(kind), count=len(values))
            )
        return values

    def _convert_message(self, kind: FieldType, value: Any, path: str) -> Any:
        cls = get_message(kind.base)
        if isinstance(value, cls):
            return value
        message = cls()
        self.fields(message, value, path)
        return message

    # --- mistakes -------------------------------------------------------------------------------------------

    def _report_unknown_field(self, message: Message, name: str, path: str) -> None:
        names = [field.name for field in definition_of(type(message)).fields]
        hint = did_you_mean(name, names) or phrase("its fields: {names}", names=joined(names) or phrase("none"))
        subject = phrase("{type} ('{path}')", type=message.TYPE_NAME, path=path) if path else message.TYPE_NAME
        self.diagnostics.append(
            Diagnostic(
                "MSG301",
                phrase("{subject} has no field '{name}'", subject=subject, name=name),
                hint=hint,
            )
        )

    def _report_invalid_value(self, message: Phrase, hint: Phrase) -> None:
        self.diagnostics.append(Diagnostic("MSG302", message, hint=hint))


def _convert_primitive(primitive: Primitive, kind: FieldType, value: Any) -> Any:
    """Return a value converted to the Python type of its field.

    The setter checks ranges and lengths.
    """
    if is_scalar(value):
        value = value.item()
    python = primitive.python
    if python is str:
        if isinstance(value, (str, int, float)):
            return _convert_to_text(value)
    elif python is bool:
        if isinstance(value, bool) or value in (0, 1):
            return bool(value)
    elif python is bytes:
        return _convert_to_byte(value)
    elif isinstance(value, (bool, int, float, str)):
        try:
            number = python(value)
        except (ValueError, OverflowError):
            raise _InvalidValueError(_describe_type(kind)) from None
        if python is int and isinstance(value, float) and number != value:
            raise _InvalidValueError(_describe_type(kind))
        return number
    raise _InvalidValueError(_describe_type(kind))


def _convert_to_text(value: str | float) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value)


def _convert_to_byte(value: Any) -> bytes:
    if isinstance(value, (bytes, bytearray)) and len(value) == 1:
        return bytes(value)
    if isinstance(value, int) and 0 <= value <= 255:
        return bytes([value])
    if isinstance(value, str) and len(value) == 1 and ord(value) <= 255:
        return value.encode("latin-1")
    raise _InvalidValueError(phrase("a byte, 0 to 255"))


def _describe_type(kind: FieldType) -> Phrase:
    descriptions = {
        int: phrase("an integer"),
        float: phrase("a number"),
        str: phrase("a string"),
        bool: phrase("true or false"),
        bytes: phrase("a byte, 0 to 255"),
    }
    primitive = kind.primitive
    value_description = phrase("{type}", type=kind.base) if primitive is None else descriptions[primitive.python]
    if primitive is not None and primitive.is_integer:
        value_description = phrase(
            "{description}, {minimum} to {maximum}",
            description=value_description,
            minimum=primitive.low,
            maximum=primitive.high,
        )
    if kind.container is Container.ARRAY:
        return phrase("a list of {size} ({type_name})", size=kind.size, type_name=kind.to_msg_text())
    if kind.container is Container.SEQUENCE:
        return phrase("a list ({type_name})", type_name=kind.to_msg_text())
    return value_description


def _describe_value(value: Any) -> str:
    text = repr(value) if isinstance(value, str) else str(value)
    return text if len(text) <= 60 else text[:57] + "..."
