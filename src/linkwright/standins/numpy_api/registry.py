"""The registry of conversions between messages and arrays (API of ``ros2_numpy.registry``).

A conversion belongs to a message type, or to a sequence of messages of one type (``plural``). Programs add conversions
of their own types with the decorators.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

_F = TypeVar("_F", bound=Callable[..., Any])
_Key = tuple[type[Any], bool]

_to_numpy: dict[_Key, Callable[..., Any]] = {}
_from_numpy: dict[_Key, Callable[..., Any]] = {}


def converts_to_numpy(msgtype: type[Any], plural: bool = False) -> Callable[[_F], _F]:
    """Return a decorator that registers a function as the conversion of a message type to an array.

    Args:
        msgtype: the message class.
        plural: whether the function converts a sequence of messages.
    """

    def register(convert: _F) -> _F:
        _to_numpy[msgtype, plural] = convert
        return convert

    return register


def converts_from_numpy(msgtype: type[Any], plural: bool = False) -> Callable[[_F], _F]:
    """Return a decorator that registers a function as the conversion of an array to a message type.

    Args:
        msgtype: the message class.
        plural: whether the function returns a list of messages.
    """

    def register(convert: _F) -> _F:
        _from_numpy[msgtype, plural] = convert
        return convert

    return register


def numpify(msg: Any, *args: Any, **kwargs: Any) -> Any:
    """Convert a message, or a sequence of messages, to an array.

    Args:
        msg: the message or messages; None gives None.
        args: further arguments of the conversion.
        kwargs: further arguments of the conversion.

    Raises:
        ValueError: the sequence is empty, or the type has no conversion; the message lists the types that have one.
    """
    if msg is None:
        return None
    convert = _to_numpy.get((type(msg), False))
    if convert is None and isinstance(msg, Sequence) and not isinstance(msg, (str, bytes)):
        if not msg:
            raise ValueError("Cannot determine the type of an empty Collection")
        convert = _to_numpy.get((type(msg[0]), True))
    if convert is None:
        raise ValueError(f"Unable to convert message {type(msg).__name__} - only supports {_list_types(_to_numpy)}")
    return convert(msg, *args, **kwargs)


def msgify(msg_type: type[Any], numpy_obj: Any, *args: Any, **kwargs: Any) -> Any:
    """Convert an array to a message.

    Args:
        msg_type: the class of the message.
        numpy_obj: the array.
        args: further arguments of the conversion.
        kwargs: further arguments of the conversion, and ``plural`` for a list of messages.

    Raises:
        ValueError: the type has no conversion; the message lists the types that have one.
    """
    convert = _from_numpy.get((msg_type, kwargs.pop("plural", False)))
    if convert is None:
        raise ValueError(f"Unable to build message {msg_type.__name__} - only supports {_list_types(_from_numpy)}")
    return convert(numpy_obj, *args, **kwargs)


def _list_types(converters: dict[_Key, Callable[..., Any]]) -> str:
    return ", ".join(message_type.__name__ + "[]" * plural for message_type, plural in converters)
