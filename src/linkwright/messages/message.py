"""The base classes of messages, services and actions, and serialization to CDR as in ROS 2."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from linkwright.diagnostics import foreign, phrase
from linkwright.messages.cdr.values import READ_FAULTS, DataFaultError
from linkwright.messages.checks import find_ndarray_class
from linkwright.messages.definitions.interfaces import Structure
from linkwright.messages.errors import MessageDataError, data_error
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_M = TypeVar("_M")


def definition_of(message_class: type[Any]) -> Structure:
    """Return the definition of a message class, with its fields and constants."""
    definition: Structure = message_class._definition
    return definition


class _SlotTypes:
    """A class attribute that computes ``SLOT_TYPES`` on first access."""

    def __get__(self, instance: object, owner: type[Message]) -> tuple[Any, ...]:
        from linkwright.messages.definitions.slot_types import make_slot_types

        types = make_slot_types(definition_of(owner))
        owner.SLOT_TYPES = types
        return types


class Message:
    """A ROS 2 message: an object whose fields are checked on assignment as in rclpy.

    As in the classes of rosidl_generator_py, the slot ``_x`` contains the value of the field ``x``, and the property
    ``x`` gives access to it. A published message is passed to every subscriber in the process without a copy.
    Subscribers may read the message but must not change it.
    """

    __slots__: tuple[str, ...] = ()

    TYPE_NAME: ClassVar[str]
    """The full type name, such as ``sensor_msgs/msg/JointState``."""

    SLOT_TYPES: ClassVar[Any] = _SlotTypes()
    """The types of the fields in order, as objects with the interface of rosidl_parser's."""

    _definition: ClassVar[Structure]

    # Functions that create classes; `linkwright.messages.classes` assigns them.
    _class_named: ClassVar[Callable[[str], type[Any]]]
    _class_of: ClassVar[Callable[[Structure], type[Any]]]

    def _write(self) -> bytes:
        """Serialize the message to CDR with its header.

        As for `_read`, the function for the class is compiled on first use.
        """
        from linkwright.messages.cdr.writer import compile_writer

        cls = type(self)
        cls._write = compile_writer(cls._definition)  # type: ignore[method-assign, assignment]  # for this class, from now on
        return self._write()

    @classmethod
    def _read(cls, data: bytes) -> Any:
        """Deserialize a message from bytes with a little-endian header.

        The function for the class is compiled on first use and replaces this method.
        """
        from linkwright.messages.cdr.reader import compile_reader

        reader = compile_reader(cls._definition, cls._class_of)
        cls._read = staticmethod(reader)  # type: ignore[assignment]  # for this class, from now on
        return reader(data)

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        """Return the type of each field by name, such as ``{'position': 'sequence<double>'}``."""
        return {field.name: field.type.to_idl_text() for field in cls._definition.fields}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, self.__class__):
            return False
        ndarray = find_ndarray_class()
        for slot in self.__slots__:
            own_value, other_value = getattr(self, slot), getattr(other, slot)
            if type(own_value) is ndarray or type(other_value) is ndarray:
                if own_value.size != other_value.size or not (own_value.ravel() == other_value.ravel()).all():
                    return False
            elif own_value != other_value:
                return False
        return True

    __hash__ = None  # type: ignore[assignment]  # a mutable value

    def __repr__(self) -> str:
        values = []
        for field in self._definition.fields:
            value = getattr(self, field.name)
            text = repr(value)
            if text.startswith("array('"):  # For array('d', [1.0]), show only the list, as rclpy does.
                text = text[len("array('d', ") : -1] if len(value) else "[]"
            values.append(f"{field.name}={text}")
        module = type(self).__module__.rpartition(".")[0]
        return f"{module}.{type(self).__name__}({', '.join(values)})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (self.TYPE_NAME, tuple(getattr(self, slot) for slot in self.__slots__))


def _rebuild(type_name: str, values: tuple[Any, ...]) -> Message:
    """Create a message from the values of its slots, for copies and pickles.

    The type name identifies the class, so that pickle does not need to import the class from a module.
    """
    cls = Message._class_named(type_name)
    message: Message = object.__new__(cls)
    for slot, value in zip(cls.__slots__, values, strict=True):
        setattr(message, slot, value)
    return message


def from_values(message_class: type[_M], values: Iterable[object]) -> _M:
    """Return a message whose fields have values, in the order of the definition."""
    names = [field.name for field in definition_of(message_class).fields]
    return message_class(**dict(zip(names, values, strict=True)))


class ServiceType:
    """The base class of services, which contain the classes of request and response.

    A service cannot be instantiated.
    """

    TYPE_NAME: ClassVar[str]
    Request: ClassVar[type[Any]]
    Response: ClassVar[type[Any]]
    Event: ClassVar[type[Any]]
    """The class of the messages on the service's introspection topic."""

    def __init__(self) -> None:
        """Refuse to create an object of a service.

        Raises:
            NotImplementedError: always, as in rclpy.
        """
        raise NotImplementedError("Service classes can not be instantiated")


class ActionImplementation:
    """The services and messages of an action.

    Attributes:
        SendGoalService: the service that accepts goals.
        GetResultService: the service that returns the result when a goal has ended.
        FeedbackMessage: the message with feedback and the id of the goal.
        CancelGoalService: ``action_msgs/srv/CancelGoal``.
        GoalStatusMessage: ``action_msgs/msg/GoalStatusArray``.
    """

    SendGoalService: ClassVar[type[ServiceType]]
    GetResultService: ClassVar[type[ServiceType]]
    FeedbackMessage: ClassVar[type[Any]]
    CancelGoalService: ClassVar[type[ServiceType]]
    GoalStatusMessage: ClassVar[type[Any]]


class ActionType:
    """The base class of actions, which contain the classes of goal, result and feedback.

    An action cannot be instantiated.
    """

    TYPE_NAME: ClassVar[str]
    Goal: ClassVar[type[Any]]
    Result: ClassVar[type[Any]]
    Feedback: ClassVar[type[Any]]
    Impl: ClassVar[type[ActionImplementation]]

    def __init__(self) -> None:
        """Refuse to create an object of an action.

        Raises:
            NotImplementedError: always, as in rclpy.
        """
        raise NotImplementedError("Action classes can not be instantiated")


_Self = TypeVar("_Self", bound="_Nanoseconds")


class _Nanoseconds(Message):
    __slots__ = ()

    sec: Any
    nanosec: Any

    if TYPE_CHECKING:  # The constructor is generated at run time.

        def __init__(self, *, sec: int = 0, nanosec: int = 0) -> None: ...

    @classmethod
    def from_nanoseconds(cls: type[_Self], nanoseconds: int) -> _Self:  # noqa: PYI019 - Python 3.10 has no Self
        """Create the message that represents a number of nanoseconds.

        Raises:
            AssertionError: the seconds do not fit into 32 bits.
        """
        seconds, remainder = divmod(nanoseconds, NANOSECONDS_PER_SECOND)
        return cls(sec=seconds, nanosec=remainder)

    @property
    def nanoseconds(self) -> int:
        """The time in nanoseconds."""
        count: int = self.sec * NANOSECONDS_PER_SECOND + self.nanosec
        return count


class TimeValue(_Nanoseconds):
    """A point in time: seconds since the epoch, plus nanoseconds from 0 to 999 999 999."""

    __slots__ = ()


class DurationValue(_Nanoseconds):
    """A duration: seconds, which may be negative, plus nanoseconds from 0 to 999 999 999."""

    __slots__ = ()


MessageT = TypeVar("MessageT")

_LITTLE_ENDIAN = b"\x00\x01"
_BIG_ENDIAN = b"\x00\x00"
_OTHER_ENCODINGS = {
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
_big_endian_readers: dict[str, Any] = {}


def serialize(message: Message) -> bytes:
    """Serialize a message to little-endian CDR.

    The header bytes 00 01 00 00 precede the fields, and there is no padding at the end.

    Raises:
        MessageDataError: MSG202, a value has the wrong type or is out of range. This happens only if the checks on
            assignment were bypassed, for example by appending to a list.
    """
    try:
        return message._write()
    except _WRITE_FAULTS as fault:
        raise _write_error(message, fault) from fault


def deserialize(data: bytes | bytearray | memoryview, message_class: type[MessageT]) -> MessageT:
    """Deserialize a message from CDR bytes with a header.

    Bytes after the end of the message are ignored.

    Raises:
        MessageDataError: MSG201, the bytes are not a message of this class.
    """
    if type(data) is not bytes:
        data = bytes(data)
    is_little_endian = data[:2] == _LITTLE_ENDIAN
    reader = message_class._read if is_little_endian else _reader_for(data, message_class)  # type: ignore[attr-defined]  # of Message
    try:
        message: MessageT = reader(data)
    except READ_FAULTS as fault:
        raise _read_error(message_class, data, fault) from None
    return message


def _reader_for(data: bytes, message_class: type[Any]) -> Any:
    if data[:2] != _BIG_ENDIAN or len(data) < 4:
        if len(data) < 4:
            reason = phrase("{count} bytes are too few for the header", count=len(data))
        elif data[:2] in _OTHER_ENCODINGS:
            reason = phrase(
                "its header declares the encoding {headers}, but ROS 2 uses plain CDR",
                headers=_OTHER_ENCODINGS[data[:2]],
            )
        else:
            reason = phrase("it begins with {bytes} instead of a CDR header", bytes=data[:4].hex(" "))
        raise data_error(
            "MSG201",
            phrase(
                "this is not a message of type '{type_name}': {reason}",
                type_name=message_class.TYPE_NAME,
                reason=reason,
            ),
        )
    name = message_class.TYPE_NAME
    reader = _big_endian_readers.get(name)
    if reader is None:
        from linkwright.messages.cdr.reader import compile_reader

        reader = _big_endian_readers[name] = compile_reader(definition_of(message_class), message_class._class_of, ">")
    return reader


def _read_error(message_class: type[Any], data: bytes, fault: Exception) -> MessageDataError:
    if isinstance(fault, UnicodeDecodeError):
        why = phrase("a string is not UTF-8")
    elif isinstance(fault, DataFaultError):
        why = foreign(fault)
    else:
        why = phrase("the data has only {count} bytes and ends in the middle of the message", count=len(data))
    return data_error(
        "MSG201",
        phrase("this is not a message of type '{type_name}': {reason}", type_name=message_class.TYPE_NAME, reason=why),
    )


def _write_error(message: object, fault: Exception) -> MessageDataError:
    if not isinstance(message, Message):
        if isinstance(message, type):
            name = message.__name__
            return data_error("MSG202", phrase("'{name}' is a class, not a message; write {name}()", name=name))
        return data_error("MSG202", phrase("'{name}' is not a message class", name=type(message).__name__))
    return data_error(
        "MSG202",
        phrase(
            "this message of type '{type_name}' cannot be serialized: {reason}",
            type_name=message.TYPE_NAME,
            reason=foreign(_invalid_field(message, "") or fault),
        ),
    )


def _invalid_field(message: Message, path: str) -> str | None:
    """Return a message about the first field with an invalid value, or None.

    The message is the one that the checks on assignment raise.
    """
    for field in definition_of(type(message)).fields:
        field_path = f"{path}.{field.name}" if path else field.name
        try:
            value = getattr(message, field.name)
            setattr(type(message)(), field.name, value)
        except AttributeError:
            return phrase("'{field}' is not set", field=field_path)
        except AssertionError as error:
            return str(error).replace(f"'{field.name}'", f"'{field_path}'", 1)
        nested_messages = [value] if isinstance(value, Message) else value if "/" in field.type.base else ()
        for index, item in enumerate(nested_messages):
            error_text = _invalid_field(item, field_path if item is value else f"{field_path}[{index}]")
            if error_text:
                return error_text
    return None
