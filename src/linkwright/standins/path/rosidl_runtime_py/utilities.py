"""Classes of interfaces, by their names."""

from linkwright.standins.rosidl_api.utilities import (
    get_action,
    get_interface,
    get_message,
    get_service,
    import_message_from_namespaced_type,
)

__all__ = [
    "get_action",
    "get_interface",
    "get_message",
    "get_service",
    "import_message_from_namespaced_type",
]
