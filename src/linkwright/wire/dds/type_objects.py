"""Encode the XTypes descriptions of ROS types.

Source: DDS-XTypes 1.3, 7.3.4 and 7.6.3.2.2, and its annex B for the type objects.

Cyclone's Python package creates the same data, but imports classes for all of XTypes to do so, and builds a serializer
for each type. That took a quarter of the time in which a node starts. ROS types are final structures without keys, so
that they need few kinds of type objects.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from hashlib import md5
from typing import NamedTuple

from linkwright.messages.definitions.interfaces import Container, FieldType, Structure
from linkwright.wire.type_names import to_wire_type

_MINIMAL, _COMPLETE, _BOTH = 0xF1, 0xF2, 0xF3
_STRUCTURE = 0x51
_FINAL = 1
_TRY_CONSTRUCT_DISCARD = 1
_STRING, _SEQUENCE, _ARRAY = 0x70, 0x80, 0x90
"""The kinds with a bound of one byte. The kinds with a bound of four bytes follow them."""

_MINIMAL_MEMBER_ID, _COMPLETE_MEMBER_ID = 0x40001001, 0x40001002
_NO_ANNOTATIONS = bytes(2)

_PRIMITIVE_KINDS = {
    "bool": 0x01,
    "int16": 0x03,
    "int32": 0x04,
    "int64": 0x05,
    "uint16": 0x06,
    "uint32": 0x07,
    "uint64": 0x08,
    "float32": 0x09,
    "float64": 0x0A,
    "int8": 0x0C,
    "uint8": 0x0D,
    "byte": 0x0D,
    "char": 0x0D,
}


class UndescribableError(Exception):
    """Raised when a type has a member that Cyclone's package cannot describe (wide strings)."""


class TypeObjects(NamedTuple):
    """The minimal and the complete type object of a structure, in XCDR2, little-endian, without size."""

    minimal: bytes
    complete: bytes


def encode_type(structure: Structure, find_structure: Callable[[str], Structure]) -> tuple[bytes, bytes]:
    """Return TypeInformation and TypeMapping of a structure and of all structures in it.

    Args:
        structure: the structure.
        find_structure: returns the structure with a type name.

    Returns:
        Both as XCDR2, little-endian, without header.

    Raises:
        UndescribableError: a member has a type that Cyclone's package cannot describe.
    """
    objects: dict[str, TypeObjects] = {}
    _collect_objects(structure, find_structure, objects)
    own = objects.pop(structure.type_name)
    return _encode_types(own, list(objects.values()))


def encode_empty_type(type_name: str) -> tuple[bytes, bytes]:
    """Return TypeInformation and TypeMapping of a structure without members.

    Args:
        type_name: the DDS name of the structure.
    """
    return _encode_types(_encode_structure(type_name, (), {}), ())


def _collect_objects(
    structure: Structure, find_structure: Callable[[str], Structure], objects: dict[str, TypeObjects]
) -> None:
    """Add the type objects of a structure, after those of the structures in it."""
    for type_name in structure.references:
        if type_name not in objects:
            _collect_objects(find_structure(type_name), find_structure, objects)
    members = [(field.name, field.type) for field in structure.wire_fields]
    objects[structure.type_name] = _encode_structure(to_wire_type(structure.type_name), members, objects)


def _encode_structure(
    type_name: str, members: Sequence[tuple[str, FieldType]], objects: Mapping[str, TypeObjects]
) -> TypeObjects:
    name = type_name.encode() + b"\0"
    complete_header = bytes(4) + _pack_number(len(name)) + name  # no base, no annotations
    return TypeObjects(
        _encode_object(_MINIMAL, bytes(1), members, objects),
        _encode_object(_COMPLETE, complete_header, members, objects),
    )


def _encode_object(
    equivalence: int, header: bytes, members: Sequence[tuple[str, FieldType]], objects: Mapping[str, TypeObjects]
) -> bytes:
    data = bytearray((equivalence, _STRUCTURE, _FINAL, 0))
    data += _add_size(header)
    _align(data)
    encoded = [_encode_member(equivalence, number, member, objects) for number, member in enumerate(members)]
    return bytes(data + _encode_sequence(encoded))


def _encode_member(
    equivalence: int, number: int, member: tuple[str, FieldType], objects: Mapping[str, TypeObjects]
) -> bytes:
    """Encode a member of a structure, without size."""
    field_name, field = member
    name = field_name.encode()
    data = bytearray(_pack_number(number))
    data += bytes((_TRY_CONSTRUCT_DISCARD, 0))
    _add_type_id(data, equivalence, field, objects)
    if equivalence == _MINIMAL:
        return bytes(data + md5(name, usedforsecurity=False).digest()[:4])
    _align(data)
    return bytes(data + _pack_number(len(name) + 1) + name + b"\0" + _NO_ANNOTATIONS)


def _add_type_id(data: bytearray, equivalence: int, field: FieldType, objects: Mapping[str, TypeObjects]) -> None:
    """Append the TypeIdentifier of a field, whose alignment depends on the bytes before it."""
    if field.container is not Container.ONE:
        bound = field.size or 0
        is_large = bound > 0xFF
        is_array = field.container is Container.ARRAY
        data.append((_ARRAY if is_array else _SEQUENCE) + is_large)
        data.append(equivalence if "/" in field.base else _BOTH)
        _align(data, 2)
        data += bytes((_TRY_CONSTRUCT_DISCARD, 0))
        if is_array:  # the number of dimensions
            _align(data)
            data += _pack_number(1)
        _add_bound(data, bound, is_large=is_large)
    if "/" in field.base:
        data += _compute_type_id(objects[field.base][equivalence == _COMPLETE])
    elif field.base == "string":
        bound = field.string_bound or 0
        data.append(_STRING + (bound > 0xFF))
        _add_bound(data, bound, is_large=bound > 0xFF)
    elif field.base in _PRIMITIVE_KINDS:
        data.append(_PRIMITIVE_KINDS[field.base])
    else:
        raise UndescribableError(field.base)


def _add_bound(data: bytearray, bound: int, *, is_large: bool) -> None:
    if is_large:
        _align(data)
        data += _pack_number(bound)
    else:
        data.append(bound)


def _encode_types(own: TypeObjects, nested: Sequence[TypeObjects]) -> tuple[bytes, bytes]:
    """Encode the TypeInformation and the TypeMapping of a structure and of the structures in it."""
    all_objects = (own, *nested)
    information = b"".join(
        _encode_with_dependencies(member_id, own[index], list(dict.fromkeys(objects[index] for objects in nested)))
        for index, member_id in enumerate((_MINIMAL_MEMBER_ID, _COMPLETE_MEMBER_ID))
    )
    mapping = bytearray()
    for index in range(len(own)):
        mapping += _encode_pairs([objects[index] for objects in all_objects])
        _align(mapping)
    ids = b"".join(_compute_type_id(objects.complete) + _compute_type_id(objects.minimal) for objects in all_objects)
    return _add_size(information), bytes(mapping) + _add_size(_pack_number(len(all_objects)) + ids)


def _encode_with_dependencies(member_id: int, type_object: bytes, dependencies: list[bytes]) -> bytes:
    """Encode a TypeIdentifierWithDependencies as a member of a mutable structure."""
    sized_ids = _encode_sequence([_encode_sized_id(dependency) for dependency in dependencies])
    content = _add_size(_encode_sized_id(type_object)) + _pack_number(len(dependencies)) + sized_ids
    return _pack_number(member_id) + _add_size(_add_size(content))


def _encode_sized_id(type_object: bytes) -> bytes:
    return _compute_type_id(type_object) + b"\0" + _pack_number(len(type_object) + 4)


def _encode_sequence(elements: list[bytes]) -> bytes:
    """Encode a sequence of appendable structures."""
    data = bytearray(_pack_number(len(elements)))
    for element in elements:
        _align(data)
        data += _add_size(element)
    return _add_size(bytes(data))


def _encode_pairs(type_objects: list[bytes]) -> bytes:
    """Encode a sequence of TypeIdentifierTypeObjectPair."""
    data = bytearray(_pack_number(len(type_objects)))
    for type_object in type_objects:
        data += _compute_type_id(type_object)
        _align(data)
        data += _add_size(type_object)
    return _add_size(bytes(data))


def _compute_type_id(type_object: bytes) -> bytes:
    """Encode the type identifier of a type object.

    It consists of its kind, EK_MINIMAL or EK_COMPLETE, and its EquivalenceHash.
    """
    return type_object[:1] + md5(_add_size(type_object), usedforsecurity=False).digest()[:14]


def _align(data: bytearray, size: int = 4) -> None:
    data.extend(bytes(-len(data) % size))


def _add_size(data: bytes) -> bytes:
    return _pack_number(len(data)) + data


def _pack_number(value: int) -> bytes:
    return value.to_bytes(4, "little")
