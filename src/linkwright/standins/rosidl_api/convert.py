"""Convert messages to dictionaries, YAML and CSV."""

from collections import OrderedDict
from typing import Any

from linkwright.messages import to_csv, to_dict, to_yaml
from linkwright.messages.message import Message

_ELLIPSIS = "..."


def message_to_yaml(
    msg: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Return a message as YAML.

    Bytes become a mapping with the key ``bytes`` and a ``!!binary`` value.
    """
    if isinstance(msg, bytes):
        import yaml

        return str(yaml.safe_dump({"bytes": msg}))
    return to_yaml(msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str, flow_style=flow_style)


def message_to_csv(msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """Return the values of a message separated by commas.

    For bytes, return their Python literal.
    """
    if isinstance(msg, bytes):
        return str(msg)
    return to_csv(msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Return a message as a dictionary of plain values.

    Bytes become the value of the key ``bytes``.
    """
    if isinstance(msg, bytes):
        return OrderedDict(bytes=msg)
    return to_dict(msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)


def get_message_slot_types(msg: Any) -> OrderedDict[str, Any]:
    """Return the types of a message's fields by name."""
    return OrderedDict(zip((slot[1:] for slot in msg.__slots__), msg.SLOT_TYPES, strict=True))


def convert_value(
    value: Any,
    *,
    field_type: Any = None,  # noqa: ARG001 - as in rosidl_runtime_py
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
) -> Any:
    """Convert a value to plain Python values.

    Strings, lists and tuples, including nested ones, are truncated to `truncate_length`.
    """

    def convert(item: Any) -> Any:
        return convert_value(item, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)

    if isinstance(value, bytes):
        value = value.decode("latin-1")
    if isinstance(value, str):
        is_cut = truncate_length is not None and len(value) > truncate_length
        return value[:truncate_length] + _ELLIPSIS if is_cut else value
    if isinstance(value, dict):
        return type(value)((key, convert(item)) for key, item in value.items())
    if isinstance(value, (tuple, list)):
        plain_values = [convert(item) for item in value[:truncate_length]]
        if truncate_length is not None and len(value) > truncate_length:
            plain_values.append(_ELLIPSIS)
        return type(value)(plain_values)
    if isinstance(value, Message):
        return message_to_ordereddict(value, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)
    return value
