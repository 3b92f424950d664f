"""The descriptions of types that Cyclone gets, compared with those of its Python package."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest

from linkwright.messages import definition_of, get_message, interface_names, shipped_packages
from linkwright.messages.definitions.interfaces import Container, Field, FieldType, Structure
from linkwright.wire.dds.type_descriptions import WireTypes
from linkwright.wire.dds.type_objects import UndescribableError, encode_empty_type, encode_type
from linkwright.wire.type_names import to_wire_type

idl = pytest.importorskip("cyclonedds.idl", reason="cyclonedds is not installed")
types = pytest.importorskip("cyclonedds.idl.types")

_HEADER = b"\0\7\0\0"  # XCDR2, little-endian


def find_structure(type_name: str) -> Structure:
    return definition_of(get_message(type_name))


def describe_with_package(structure: Structure) -> Any:
    """Return the class by which the package itself describes a structure."""
    members = {field.name: describe_member(field.type) for field in structure.wire_fields}
    name = to_wire_type(structure.type_name)
    return idl.make_idl_struct(name.rpartition("::")[2], name.replace("::", "."), members, dataclassify=False)


def describe_member(field: FieldType) -> Any:
    if "/" in field.base:
        element = describe_with_package(find_structure(field.base))
    elif field.base == "string":
        element = str if field.string_bound is None else types.bounded_str[field.string_bound]
    elif field.base == "bool":
        element = bool
    else:
        element = getattr(types, "uint8" if field.base in ("byte", "char") else field.base)
    if field.container is Container.ARRAY:
        return types.array[element, field.size]
    if field.container is Container.SEQUENCE:
        return types.sequence[element] if field.size is None else types.sequence[element, field.size]
    return element


def contents(type_data: tuple[bytes, bytes]) -> list[Any]:
    """Return the information and the mapping of a type, without the order and the repetitions of nested types."""
    from cyclonedds.idl._typesupport.DDS.XTypes import TypeInformation, TypeMapping

    information = TypeInformation.deserialize(_HEADER + type_data[0])
    mapping = TypeMapping.deserialize(_HEADER + type_data[1])
    parts: list[Any] = [information.minimal, information.complete]
    lists: list[Any] = [*(part.dependent_typeids for part in parts), *vars(mapping).values()]
    return [[part.typeid_with_size for part in parts], *map(as_set, lists)]


def as_set(parts: Iterable[object]) -> set[str]:
    return {repr(part) for part in parts}


def package_data(structure: Structure) -> tuple[bytes, bytes]:
    description = describe_with_package(structure).__idl__
    description.fill_type_data()
    data: tuple[bytes, bytes] = description._xt_bytedata
    return data


def has_wide_string(structure: Structure) -> bool:
    return any(field.type.base == "wstring" for field in structure.fields)


def test_data_of_shipped_messages_match_cyclonedds() -> None:
    """The hashes of all types are those of the package, which calculates them from its own classes."""
    wire_types = WireTypes()
    packages = shipped_packages()
    names = [name for name in interface_names("msg") if name.split("/")[0] in packages]
    assert any(map(has_wide_string, map(find_structure, names)))
    for name in names:
        structure = find_structure(name)
        description = wire_types.message(get_message(name)).__idl__
        assert (description.idl_transformed_typename, description.keyless) == (to_wire_type(name), True)
        if has_wide_string(structure):
            assert description._xt_bytedata == encode_empty_type(to_wire_type(name)), name
        else:
            assert contents(description._xt_bytedata) == contents(package_data(structure)), name


MEMBERS = [
    *(
        FieldType(base)
        for base in ("byte", "char", "bool", "int8", "int64", "float32", "string", "test_msgs/msg/Empty")
    ),
    *(FieldType("string", bound) for bound in (1, 255, 256, 70_000)),
    *(FieldType("uint16", None, Container.ARRAY, size) for size in (1, 255, 256)),
    *(FieldType("string", 300, Container.SEQUENCE, size) for size in (None, 255, 256)),
    *(FieldType("std_msgs/msg/Header", None, container, 300) for container in (Container.ARRAY, Container.SEQUENCE)),
]


@pytest.mark.parametrize("length", range(1, 6))
@pytest.mark.parametrize("member", MEMBERS, ids=repr)
def test_data_of_each_kind_of_member_match_cyclonedds(member: FieldType, length: int) -> None:
    """The length of a name moves the positions of all that follow."""
    structure = Structure("some_interfaces/msg/Thing", (Field("a" * length, member), Field("last", member)))
    assert contents(encode_type(structure, find_structure)) == contents(package_data(structure))


def test_nested_wide_strings_cannot_be_described() -> None:
    """A structure that is described without its nested members would have other samples."""
    structure = Structure("some_interfaces/msg/Thing", (Field("text", FieldType("example_interfaces/msg/WString")),))
    with pytest.raises(UndescribableError):
        encode_type(structure, find_structure)


@pytest.mark.parametrize("name", ["A_", "Ab_", "Abc_", "ParticipantEntitiesInfo_", "Müller_"])
def test_empty_type_data_match_cyclonedds(name: str) -> None:
    type_name = f"some_interfaces::msg::dds_::{name}"
    description = idl.make_idl_struct(name, type_name.replace("::", "."), {}, dataclassify=False)
    description.__idl__.fill_type_data()
    assert encode_empty_type(type_name) == description.__idl__._xt_bytedata
