"""Messages as dictionaries, YAML and CSV."""

from collections import OrderedDict
from typing import Any

from linkwright.messages import to_csv, to_dict, to_yaml


def message_to_yaml(
    msg: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """A message as YAML."""
    return to_yaml(msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str, flow_style=flow_style)


def message_to_csv(msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """The values of a message with commas between them."""
    return to_csv(msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """The fields of a message as plain values."""
    return to_dict(msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)


def get_message_slot_types(msg: Any) -> OrderedDict[str, Any]:
    """The names and types of a message's fields."""
    return OrderedDict(zip((slot[1:] for slot in msg.__slots__), msg.SLOT_TYPES, strict=True))
