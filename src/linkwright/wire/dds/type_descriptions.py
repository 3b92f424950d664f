"""Descriptions of ROS types, against which Cyclone checks samples.

Cyclone compares types structurally if both sides describe theirs. Therefore types are described member by member, like
the types that rmw_cyclonedds_cpp describes (final, keyless; ``byte`` and ``char`` are unsigned octets; an empty message
has the member that rosidl adds to it). The content of samples never passes through these classes: it is CDR from
`linkwright.messages`.
"""

from __future__ import annotations

from threading import RLock
from typing import Any

from linkwright.messages import definition_of, get_message
from linkwright.messages.definitions.interfaces import Structure
from linkwright.wire.dds.type_objects import UndescribableError, encode_empty_type, encode_type
from linkwright.wire.type_names import to_wire_type

DISCOVERY_TYPE = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"


class WireTypes:
    """A cache that creates the descriptions of types on first use.

    Any thread may use this object.
    """

    def __init__(self) -> None:
        self._classes: dict[object, Any] = {}
        self._lock = RLock()

    def message(self, message_class: type[Any]) -> Any:
        """Return the description of a message type."""
        return self._describe(definition_of(message_class))

    def discovery(self) -> Any:
        """Return the description of ``rmw_dds_common/msg/ParticipantEntitiesInfo`` (only its name).

        The members differ between distributions (`discovery_info`), and Cyclone would reject data that do not match.
        """
        return self._describe_name(DISCOVERY_TYPE)

    def by_name(self, type_name: str) -> Any:
        """Return a description with only a type's name.

        Cyclone does not check samples against it.
        """
        return self._describe_name(to_wire_type(type_name))

    def _describe_name(self, name: str) -> Any:
        with self._lock:
            if name not in self._classes:
                self._classes[name] = create_struct_class(name, encode_empty_type(name))
            return self._classes[name]

    def _describe(self, structure: Structure) -> Any:
        with self._lock:
            if structure not in self._classes:
                name = to_wire_type(structure.type_name)
                try:
                    type_data = encode_type(structure, _find_structure)
                except UndescribableError:  # only the name is described, as real ROS 2 nodes do
                    type_data = encode_empty_type(name)
                self._classes[structure] = create_struct_class(name, type_data)
            return self._classes[structure]


def create_struct_class(type_name: str, type_data: tuple[bytes, bytes]) -> Any:
    """Create a class that describes a structure to Cyclone.

    Of the class, Cyclone reads the name, that there are no keys, and the data.

    Args:
        type_name: the DDS name of the structure.
        type_data: its TypeInformation and TypeMapping.
    """
    from cyclonedds.idl import make_idl_struct

    short = type_name.rpartition("::")[2]
    description: Any = make_idl_struct(short, type_name.replace("::", "."), {}, dataclassify=False)
    description.__idl__.populate()
    description.__idl__._xt_bytedata = type_data
    return description


def _find_structure(type_name: str) -> Structure:
    return definition_of(get_message(type_name))
