"""The fields of a message, set from a dictionary."""

from linkwright.standins.rosidl_api.set_message import (
    set_message_fields,
)

__all__ = [
    "set_message_fields",
]
