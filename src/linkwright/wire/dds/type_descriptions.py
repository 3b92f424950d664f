"""Descriptions of ROS types, against which Cyclone checks samples.

Cyclone also announces the descriptions to other tools, and compares types structurally if both sides describe theirs.
Therefore types are described member by member, like the types that rmw_cyclonedds_cpp describes (final, keyless;
``byte`` and ``char`` are unsigned octets; an empty message has the member that rosidl adds to it). The content of
samples never passes through these classes: it is CDR from `linkwright.messages`.
"""

from __future__ import annotations

from hashlib import md5
from importlib import import_module
from threading import RLock
from typing import Any

from linkwright.messages import definition_of, get_message
from linkwright.messages.definitions.interfaces import Container, FieldType, Structure
from linkwright.wire.type_names import to_wire_type

_OCTETS = ("byte", "char")

DISCOVERY_TYPE = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"


class UndescribableError(Exception):
    """Raised when a type has a member that Cyclone's package cannot describe (wide strings)."""


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
                self._classes[name] = create_struct_class(name, {})
            return self._classes[name]

    def _describe(self, structure: Structure) -> Any:
        with self._lock:
            if structure not in self._classes:
                self._classes[structure] = create_struct_class(
                    to_wire_type(structure.type_name), self._make_members(structure)
                )
            return self._classes[structure]

    def _make_members(self, structure: Structure) -> dict[str, Any]:
        members: dict[str, Any] = {}
        try:
            for field in structure.wire_fields:
                members[field.name] = self._make_member(field.type)
        except UndescribableError:
            return {}  # Without members, only the name is described, as real ROS 2 nodes do.
        return members

    def _make_member(self, field: FieldType) -> Any:
        types = _import_idl_types()
        element = self._make_element(field)
        if field.container is Container.ARRAY:
            return types.array[element, field.size]
        if field.container is Container.SEQUENCE:
            return types.sequence[element] if field.size is None else types.sequence[element, field.size]
        return element

    def _make_element(self, field: FieldType) -> Any:
        types = _import_idl_types()
        if field.base == "string":
            return str if field.string_bound is None else types.bounded_str[field.string_bound]
        if field.base == "wstring":
            raise UndescribableError(field.base)
        if field.base == "bool":
            return bool
        if "/" in field.base:
            return self.message(get_message(field.base))
        return getattr(types, "uint8" if field.base in _OCTETS else field.base)


def create_struct_class(type_name: str, members: dict[str, Any]) -> Any:
    """Create a class that describes a structure to Cyclone.

    Args:
        type_name: the DDS name of the structure.
        members: the `cyclonedds.idl.types` of the members, by name.
    """
    from cyclonedds.idl import make_idl_struct

    short = type_name.rpartition("::")[2]
    description: Any = make_idl_struct(short, type_name.replace("::", "."), members, dataclassify=False)
    description.__idl__.populate()
    if members:
        description.__idl__.fill_type_data()
    else:
        description.__idl__._xt_bytedata = encode_empty_type(type_name)
    return description


_MINIMAL = bytes.fromhex("f1510100 01000000 00000000 04000000 00000000")
_COMPLETE = bytes.fromhex("f2510100")
_NO_MEMBERS = bytes.fromhex("04000000 00000000")
_MINIMAL_ID, _COMPLETE_ID = 0x40001001, 0x40001002


def encode_empty_type(type_name: str) -> tuple[bytes, bytes]:
    """Return TypeInformation and TypeMapping of a final structure without members.

    Source: DDS-XTypes 1.3, 7.3.4 and 7.6.3.2.2.

    Cyclone's Python package creates the same data, but imports classes for all of XTypes to do so. That takes longer
    than joining a domain and discovering all its participants.

    Args:
        type_name: the DDS name of the structure.

    Returns:
        Both as XCDR2, little-endian, without header.
    """
    name = type_name.encode() + b"\0"
    complete = _COMPLETE + _pack_number(8 + len(name)) + _pack_number(0) + _pack_number(len(name)) + name
    complete += bytes(-len(complete) % 4) + _NO_MEMBERS
    information = _encode_with_dependencies(_MINIMAL_ID, _MINIMAL) + _encode_with_dependencies(_COMPLETE_ID, complete)
    complete_to_minimal = _pack_number(1) + _compute_type_id(complete) + _compute_type_id(_MINIMAL)
    return _add_size(information), _encode_pair(_MINIMAL) + _encode_pair(complete) + _add_size(complete_to_minimal)


def _encode_with_dependencies(member_id: int, type_object: bytes) -> bytes:
    """Encode a TypeIdentifierWithDependencies as a member of a mutable structure."""
    sized_id = _add_size(_compute_type_id(type_object) + b"\0" + _pack_number(len(type_object) + 4))
    return _pack_number(member_id) + _add_size(_add_size(sized_id + _pack_number(0) + _NO_MEMBERS))


def _encode_pair(type_object: bytes) -> bytes:
    """Encode a sequence of one TypeIdentifierTypeObjectPair."""
    return _add_size(_pack_number(1) + _compute_type_id(type_object) + b"\0" + _add_size(type_object))


def _compute_type_id(type_object: bytes) -> bytes:
    """Encode the type identifier of a type object.

    It consists of its kind, EK_MINIMAL or EK_COMPLETE, and its EquivalenceHash.
    """
    return type_object[:1] + md5(_add_size(type_object), usedforsecurity=False).digest()[:14]


def _add_size(data: bytes) -> bytes:
    return _pack_number(len(data)) + data


def _pack_number(value: int) -> bytes:
    return value.to_bytes(4, "little")


def _import_idl_types() -> Any:
    """Return the module `cyclonedds.idl.types`, untyped because of its unusual subscripts."""
    return import_module("cyclonedds.idl.types")
