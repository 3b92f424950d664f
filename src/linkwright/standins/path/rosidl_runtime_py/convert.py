"""Messages as dictionaries, YAML and CSV."""

from linkwright.standins.rosidl_api.convert import (
    convert_value as _convert_value,
)
from linkwright.standins.rosidl_api.convert import (
    get_message_slot_types,
    message_to_csv,
    message_to_ordereddict,
    message_to_yaml,
)

__all__ = [
    "get_message_slot_types",
    "message_to_csv",
    "message_to_ordereddict",
    "message_to_yaml",
]
