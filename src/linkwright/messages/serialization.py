"""Messages as bytes and back: CDR as ROS 2's middlewares send it (XCDR1, little-endian, four header bytes)."""

from __future__ import annotations

import struct
from typing import Any, TypeVar

from linkwright.diagnostics import foreign, phrase
from linkwright.messages.cdr.values import READ_FAULTS, DataFaultError
from linkwright.messages.classes import class_of
from linkwright.messages.errors import MessageDataError, data_error
from linkwright.messages.message import Message, definition_of

MessageT = TypeVar("MessageT")

_LITTLE = b"\x00\x01"
_BIG = b"\x00\x00"
_HEADERS = {
    b"\x00\x02": "PL_CDR_BE",
    b"\x00\x03": "PL_CDR_LE",
    b"\x00\x06": "CDR2_BE",
    b"\x00\x07": "CDR2_LE",
    b"\x00\x08": "D_CDR2_BE",
    b"\x00\x09": "D_CDR2_LE",
    b"\x00\x0a": "PL_CDR2_BE",
    b"\x00\x0b": "PL_CDR2_LE",
}

_WRITE_FAULTS = (struct.error, AttributeError, TypeError, ValueError, OverflowError)
_big_readers: dict[str, Any] = {}


def serialize(message: Message) -> bytes:
    """A message as CDR: header bytes 00 01 00 00, then the fields; nothing is filled up at the end.

    Raises:
        MessageDataError: MSG202, a value is of the wrong type or out of range (which only happens when the checks on
            assignment were evaded, as by appending to a list).
    """
    try:
        return message._write()
    except _WRITE_FAULTS as fault:
        raise _unwritable(message, fault) from fault


def deserialize(data: bytes | bytearray | memoryview, message_class: type[MessageT]) -> MessageT:
    """The message in some bytes, header included; bytes behind its end are ignored.

    Raises:
        MessageDataError: MSG201, the bytes are not a message of this class.
    """
    if type(data) is not bytes:
        data = bytes(data)
    little = data[:2] == _LITTLE
    read = message_class._read if little else _reader_for(data, message_class)  # type: ignore[attr-defined]  # of Message
    try:
        message: MessageT = read(data)
    except READ_FAULTS as fault:
        raise _unreadable(message_class, data, fault) from None
    return message


def _reader_for(data: bytes, message_class: type[Any]) -> Any:
    if data[:2] != _BIG or len(data) < 4:
        if len(data) < 4:
            why = phrase("{count} bytes are too few for the header", count=len(data))
        elif data[:2] in _HEADERS:
            why = phrase("its header says {headers}; ROS 2 sends plain CDR", headers=_HEADERS[data[:2]])
        else:
            why = phrase("it begins with {hex} instead of the header of CDR", hex=data[:4].hex(" "))
        raise data_error(
            "MSG201",
            phrase("this is not a message of type '{type_name}': {why}", type_name=message_class.TYPE_NAME, why=why),
        )
    name = message_class.TYPE_NAME
    reader = _big_readers.get(name)
    if reader is None:
        from linkwright.messages.cdr.reader import compile_reader

        reader = _big_readers[name] = compile_reader(definition_of(message_class), class_of, ">")
    return reader


def _unreadable(message_class: type[Any], data: bytes, fault: Exception) -> MessageDataError:
    if isinstance(fault, UnicodeDecodeError):
        why = phrase("a text in it is not UTF-8")
    elif isinstance(fault, DataFaultError):
        why = foreign(fault)
    else:
        why = phrase("the data, {count} bytes, ends in the middle of the message", count=len(data))
    return data_error(
        "MSG201",
        phrase("this is not a message of type '{type_name}': {why}", type_name=message_class.TYPE_NAME, why=why),
    )


def _unwritable(message: object, fault: Exception) -> MessageDataError:
    if not isinstance(message, Message):
        return data_error("MSG202", phrase("'{name}' is not a message class", name=type(message).__name__))
    return data_error(
        "MSG202",
        phrase(
            "this '{type_name}' cannot be written: {bad_field}",
            type_name=message.TYPE_NAME,
            bad_field=foreign(_bad_field(message, "") or fault),
        ),
    )


def _bad_field(message: Message, path: str) -> str | None:
    """The field whose value could not be assigned now, and why, in the words of the checks on assignment."""
    for field in definition_of(type(message)).fields:
        here = f"{path}.{field.name}" if path else field.name
        try:
            value = getattr(message, field.name)
            setattr(type(message)(), field.name, value)
        except AttributeError:
            return phrase("'{here}' was never set", here=here)
        except AssertionError as error:
            return str(error).replace(f"'{field.name}'", f"'{here}'", 1)
        within = [value] if isinstance(value, Message) else value if "/" in field.type.base else ()
        for number, item in enumerate(within):
            found = _bad_field(item, here if item is value else f"{here}[{number}]")
            if found:
                return found
    return None
