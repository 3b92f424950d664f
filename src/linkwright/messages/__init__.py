"""ROS 2 messages, services and actions: classes, serialization, type hashes and texts.

The classes are created from the definitions of the interfaces.
"""

from typing import TYPE_CHECKING

from linkwright.loading.deferred import deferred
from linkwright.messages.catalog import list_packages as shipped_packages
from linkwright.messages.classes import get_action, get_interface, get_message, get_service
from linkwright.messages.definitions.embedded import add_definitions
from linkwright.messages.definitions.hashing import type_hash
from linkwright.messages.distribution import is_before_iron
from linkwright.messages.errors import DefinitionError, FieldValueError, InterfaceNotFoundError, MessageDataError
from linkwright.messages.message import (
    ActionType,
    Message,
    ServiceType,
    definition_of,
    deserialize,
    from_values,
    serialize,
)
from linkwright.messages.wellknown import (
    Duration,
    FloatSequence,
    Header,
    JointState,
    Quaternion,
    String,
    Time,
    Transform,
    TransformStamped,
    Vector3,
)

if TYPE_CHECKING:
    from linkwright.messages.conversion import to_csv, to_dict
    from linkwright.messages.field_values import set_fields
    from linkwright.messages.presentation import definition_text, interface_names, prototype
    from linkwright.messages.tf_message import TFMessage, TransformBatch
    from linkwright.messages.yaml_text import to_yaml

__all__ = [
    "ActionType",
    "DefinitionError",
    "Duration",
    "FieldValueError",
    "FloatSequence",
    "Header",
    "InterfaceNotFoundError",
    "JointState",
    "Message",
    "MessageDataError",
    "Quaternion",
    "ServiceType",
    "String",
    "TFMessage",
    "Time",
    "Transform",
    "TransformBatch",
    "TransformStamped",
    "Vector3",
    "add_definitions",
    "definition_of",
    "definition_text",
    "deserialize",
    "from_values",
    "get_action",
    "get_interface",
    "get_message",
    "get_service",
    "interface_names",
    "is_before_iron",
    "prototype",
    "serialize",
    "set_fields",
    "shipped_packages",
    "to_csv",
    "to_dict",
    "to_yaml",
    "type_hash",
]


__getattr__ = deferred(
    __name__,
    {
        "conversion": ("to_csv", "to_dict"),
        "field_values": ("set_fields",),
        "presentation": ("definition_text", "interface_names", "prototype"),
        "tf_message": ("TFMessage", "TransformBatch"),
        "yaml_text": ("to_yaml",),
    },
)
"""Lazy imports of functions that nodes rarely use, and of classes that import numpy (slow)."""
