"""Load interface classes by name."""

from typing import Any

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.messages import classes
from linkwright.messages.definitions.interfaces import split_name
from linkwright.messages.definitions.library import LIBRARY


def get_message(identifier: str) -> Any:
    """Return the class of a message, such as ``std_msgs/msg/String``."""
    return _get_interface(classes.get_message, identifier, "message")


def get_service(identifier: str) -> Any:
    """Return the class of a service, such as ``std_srvs/srv/SetBool``."""
    return _get_interface(classes.get_service, identifier, "service")


def get_action(identifier: str) -> Any:
    """Return the class of an action, such as ``example_interfaces/action/Fibonacci``."""
    return _get_interface(classes.get_action, identifier, "action")


def get_interface(identifier: str) -> Any:
    """Return the class of the message, service or action with the given full name."""
    return _get_interface(classes.get_interface, identifier, "interface")


def import_message_from_namespaced_type(message_type: Any) -> Any:
    """Return the class for a ``rosidl_parser.definition.NamespacedType``."""
    return classes.get_message("/".join(message_type.namespaced_name()))


def _get_interface(getter: Any, identifier: str, kind_name: str) -> Any:
    # Raise the same exceptions as importing the generated module would, because callers expect them.
    name = split_name(identifier)
    if name is None or name.kind is None:
        raise ValueError(f"Expected the full name of a {kind_name}, got '{identifier}'")
    try:
        return getter(identifier)
    except LinkwrightError as error:
        existing_names = LIBRARY.names(name.kind, name.package)
        if not any(LIBRARY.names(kind, name.package) for kind in ("msg", "srv", "action")):
            raise ModuleNotFoundError(
                phrase("No module named '{package}'", package=name.package), name=name.package
            ) from error
        if identifier in existing_names:
            raise ValueError(f"Expected '{identifier}' to be a {kind_name}") from error
        raise AttributeError(str(error)) from error
