"""What an interface file says, as data: fields, constants, and how services and actions are put together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import Enum
from typing import NamedTuple

from linkwright.messages.primitives import PRIMITIVES, Primitive

EMPTY_MEMBER = "structure_needs_at_least_one_member"
"""What rosidl puts into a structure without fields: one byte on the wire, part of the hash, invisible to users."""


class Container(Enum):
    """How many values a field holds."""

    ONE = "one"
    ARRAY = "array"
    SEQUENCE = "sequence"


class FieldType(NamedTuple):
    """The type of a field.

    Attributes:
        base: of one value: a primitive's name as in ``.msg`` files, or the type name of another structure.
        string_bound: the most characters a string may have; None without a bound.
        container: one value, an array of fixed length, or a sequence.
        size: the length of an array or the most values of a bounded sequence; None otherwise.
    """

    base: str
    string_bound: int | None = None
    container: Container = Container.ONE
    size: int | None = None

    @property
    def primitive(self) -> Primitive | None:
        """What is known of the base type; None for another structure."""
        return PRIMITIVES.get(self.base)

    @property
    def is_numeric_array(self) -> bool:
        """Whether Python holds the values in a numpy array or an ``array.array`` instead of a list."""
        primitive = self.primitive
        return self.container is not Container.ONE and primitive is not None and primitive.array_code is not None

    def spelled(self, package: str | None = None) -> str:
        """As a ``.msg`` file of `package` has it, such as ``geometry_msgs/Point[<=3]`` or ``string<=10``."""
        text = self.base
        if "/" in text:
            owner, _, name = text.split("/")
            text = name if owner == package else f"{owner}/{name}"
        if self.string_bound is not None:
            text += f"<={self.string_bound}"
        if self.container is Container.ARRAY:
            text += f"[{self.size}]"
        elif self.container is Container.SEQUENCE:
            text += "[]" if self.size is None else f"[<={self.size}]"
        return text

    def described(self) -> str:
        """As ``get_fields_and_field_types`` has it, such as ``sequence<double, 3>`` or ``geometry_msgs/Point[3]``."""
        primitive = self.primitive
        if primitive is not None:
            text = primitive.idl_name
        else:
            owner, _, name = self.base.split("/")
            text = f"{owner}/{name}"
        if self.string_bound is not None:
            text += f"<{self.string_bound}>"
        if self.container is Container.ARRAY:
            return f"{text}[{self.size}]"
        if self.container is Container.SEQUENCE:
            return f"sequence<{text}>" if self.size is None else f"sequence<{text}, {self.size}>"
        return text


class Field(NamedTuple):
    """One field.

    Attributes:
        name: as Python users write it.
        type: of its value.
        default: as the file gives it (a tuple for arrays and sequences); None where the file gives none.
    """

    name: str
    type: FieldType
    default: object | None = None


class Constant(NamedTuple):
    """A named value; `type` is a primitive's name."""

    name: str
    type: str
    value: bool | int | float | str | bytes


class Structure(NamedTuple):
    """What a message holds; requests, goals and the like are such structures too.

    Attributes:
        type_name: such as ``geometry_msgs/msg/Point`` or ``std_srvs/srv/SetBool_Request``.
        fields: in the order of the file.
        constants: in the order of the file.
    """

    type_name: str
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...] = ()

    @property
    def wire_fields(self) -> tuple[Field, ...]:
        """The fields with rosidl's filler where there would be none."""
        return self.fields or (Field(EMPTY_MEMBER, FieldType("uint8")),)

    @property
    def references(self) -> Iterator[str]:
        """The type names of the structures that fields are made of, each as often as it occurs."""
        return (field.type.base for field in self.fields if "/" in field.type.base)


class Service(NamedTuple):
    """A service: a request and the response to it."""

    type_name: str
    request: Structure
    response: Structure


class Action(NamedTuple):
    """An action: a goal, feedback on the way, and a result."""

    type_name: str
    goal: Structure
    result: Structure
    feedback: Structure


Definition = Structure | Service | Action


def interface_of(type_name: str, structures: Sequence[Structure]) -> Definition:
    """The message, service or action of a name that consists of structures, in the order of the file."""
    kind = type_name.split("/")[1]
    if kind == "msg":
        return structures[0]
    return Service(type_name, *structures) if kind == "srv" else Action(type_name, *structures)


def structures_of(definition: Definition) -> tuple[Structure, ...]:
    """The structures that a file defines, in the order of the file."""
    if isinstance(definition, Structure):
        return (definition,)
    if isinstance(definition, Service):
        return (definition.request, definition.response)
    return (definition.goal, definition.result, definition.feedback)
