"""The data model of interfaces: names, primitive types, fields, constants and structures.

From services and actions, rosidl derives further definitions, such as the event message of a service.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import Enum
from typing import NamedTuple

KINDS = ("msg", "srv", "action")


class InterfaceName(NamedTuple):
    """The package, kind and name of an interface.

    `kind` is None for a name without a kind, such as ``sensor_msgs/JointState``.
    """

    package: str
    kind: str | None
    name: str

    def __str__(self) -> str:
        return "/".join(part for part in self if part)


def split_name(text: str) -> InterfaceName | None:
    """Return the parts of ``package/kind/Name`` or ``package/Name``, or None for other texts."""
    parts = text.split("/")
    if len(parts) == 3 and parts[1] in KINDS:
        package, kind, name = parts
    elif len(parts) == 2:
        package, name = parts
        kind = None
    else:
        return None
    return InterfaceName(package, kind, name) if is_package_name(package) and is_interface_name(name) else None


def is_package_name(text: str) -> bool:
    """Return whether a package name is valid (lower case, digits, single underscores)."""
    return _is_words(text) and text == text.lower()


def is_ros1_name(text: str) -> bool:
    """Return whether the name of an interface is valid in ROS 1, where it may begin with a lower-case letter."""
    return text.isascii() and text.isidentifier() and text[0].isalpha()


def is_interface_name(text: str) -> bool:
    """Return whether an interface name is valid.

    A valid name is CamelCase, optionally with a suffix as in ``SetBool_Request``.
    """
    return text.isascii() and all(part.isalnum() and part[0].isupper() for part in text.split("_"))


def is_field_name(text: str) -> bool:
    """Return whether a field name is valid (lower case, digits, single underscores)."""
    return is_package_name(text)


def is_constant_name(text: str) -> bool:
    """Return whether a constant name is valid (upper case, digits, single underscores)."""
    return _is_words(text) and text == text.upper()


def _is_words(text: str) -> bool:
    # Not a regular expression, because compiling it takes longer than checking all names of a process.
    return text.isascii() and text[:1].isalpha() and all(word.isalnum() for word in text.split("_"))


def to_snake_case(name: str) -> str:
    """Return the snake_case form of an interface's name, as rosidl uses it for modules.

    ``JointState`` gives ``joint_state``, and ``TFMessage`` gives ``tf_message``.
    """
    characters: list[str] = []
    for index, letter in enumerate(name):
        if letter.isupper() and index:
            previous_letter, next_letter = name[index - 1], name[index + 1 : index + 2]
            if previous_letter.islower() or previous_letter.isdigit() or next_letter.islower():
                characters.append("_")
        characters.append(letter.lower())
    return "".join(characters)


def python_module(type_name: str) -> str:
    """Return the name of the module that contains a class of rosidl_generator_py.

    For example, all classes of SetBool are in ``std_srvs.srv._set_bool``.
    """
    package, kind, name = type_name.split("/")
    return f"{package}.{kind}._{to_snake_case(name.split('_')[0])}"


class Primitive(NamedTuple):
    """A primitive type.

    Attributes:
        idl_name: the name in rosidl, as shown by `get_fields_and_field_types`.
        python: the Python type of a value.
        code: the `struct` code for one value; None for strings.
        size: the serialized size in bytes, which is also the alignment; for strings, the size of the length.
        type_id: the id in the type descriptions of REP 2016, from which type hashes are computed.
        array_code: the `array.array` code; None if rclpy stores several values in a list.
        low: the minimum of an integer type.
        high: the maximum of an integer type; the largest finite value of a floating-point type.
    """

    idl_name: str
    python: type
    code: str | None
    size: int
    type_id: int
    array_code: str | None = None
    low: int = 0
    high: int | float = 0

    @property
    def is_integer(self) -> bool:
        """Whether values are integers.

        ``byte`` and ``bool`` are not integer types.
        """
        return self.python is int

    @property
    def dtype(self) -> str:
        """The name of the numpy type, for types with an array code."""
        return {"float": "float32", "double": "float64"}.get(self.idl_name, self.idl_name)


def _integer(name: str, code: str, bits: int, type_id: int, *, signed: bool) -> Primitive:
    low, high = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if signed else (0, (1 << bits) - 1)
    return Primitive(name, int, code, bits // 8, type_id, code, low, high)


PRIMITIVES: dict[str, Primitive] = {
    "int8": _integer("int8", "b", 8, 2, signed=True),
    "uint8": _integer("uint8", "B", 8, 3, signed=False),
    # In .msg files, char has been an unsigned byte since ROS 1, and rosidl maps it to uint8.
    "char": _integer("uint8", "B", 8, 3, signed=False),
    "int16": _integer("int16", "h", 16, 4, signed=True),
    "uint16": _integer("uint16", "H", 16, 5, signed=False),
    "int32": _integer("int32", "i", 32, 6, signed=True),
    "uint32": _integer("uint32", "I", 32, 7, signed=False),
    "int64": _integer("int64", "q", 64, 8, signed=True),
    "uint64": _integer("uint64", "Q", 64, 9, signed=False),
    "float32": Primitive("float", float, "f", 4, 10, "f", 0, 3.402823466e38),
    "float64": Primitive("double", float, "d", 8, 11, "d", 0, 1.7976931348623157e308),
    "bool": Primitive("boolean", bool, "B", 1, 15),
    "byte": Primitive("octet", bytes, "c", 1, 16),
    "string": Primitive("string", str, None, 4, 17),
    "wstring": Primitive("wstring", str, None, 4, 18),
}
"""The primitive types by their names in ``.msg`` files."""

EMPTY_MEMBER = "structure_needs_at_least_one_member"
"""The field that rosidl adds to an empty structure.

The field is serialized and hashed, but users do not see it.
"""


class Container(Enum):
    """The number of values of a field: one value, an array or a sequence."""

    ONE = "one"
    ARRAY = "array"
    SEQUENCE = "sequence"


class FieldType(NamedTuple):
    """The type of a field.

    Attributes:
        base: the type of one value: a primitive's name as in ``.msg`` files, or the type name of another structure.
        string_bound: the maximum number of characters of a string; None if there is no bound.
        container: whether the field has one value, an array of fixed length, or a sequence.
        size: the length of an array, or the maximum number of values of a bounded sequence; otherwise None.
    """

    base: str
    string_bound: int | None = None
    container: Container = Container.ONE
    size: int | None = None

    @property
    def primitive(self) -> Primitive | None:
        """The primitive type, or None if the base is another structure."""
        return PRIMITIVES.get(self.base)

    @property
    def is_numeric_array(self) -> bool:
        """Whether values are stored in a numpy array or an ``array.array`` instead of a list."""
        primitive = self.primitive
        return self.container is not Container.ONE and primitive is not None and primitive.array_code is not None

    def to_msg_text(self, package: str | None = None) -> str:
        """Return the type as written in a ``.msg`` file of `package`.

        An example is ``geometry_msgs/Point[<=3]``. For types of `package`, the package is omitted.
        """
        text = self.base
        if "/" in text:
            owner_package, _, name = text.split("/")
            text = name if owner_package == package else f"{owner_package}/{name}"
        if self.string_bound is not None:
            text += f"<={self.string_bound}"
        if self.container is Container.ARRAY:
            text += f"[{self.size}]"
        elif self.container is Container.SEQUENCE:
            text += "[]" if self.size is None else f"[<={self.size}]"
        return text

    def to_idl_text(self) -> str:
        """Return the type as shown by ``get_fields_and_field_types``.

        Examples are ``sequence<double, 3>`` and ``geometry_msgs/Point[3]``.
        """
        primitive = self.primitive
        if primitive is not None:
            text = primitive.idl_name
        else:
            owner_package, _, name = self.base.split("/")
            text = f"{owner_package}/{name}"
        if self.string_bound is not None:
            text += f"<{self.string_bound}>"
        if self.container is Container.ARRAY:
            return f"{text}[{self.size}]"
        if self.container is Container.SEQUENCE:
            return f"sequence<{text}>" if self.size is None else f"sequence<{text}, {self.size}>"
        return text


class Field(NamedTuple):
    """A field of a structure.

    Attributes:
        name: the name of the field.
        type: the type of the field, including its length.
        default: the default value in the file (a tuple for arrays and sequences); None if there is none.
    """

    name: str
    type: FieldType
    default: object | None = None


class Constant(NamedTuple):
    """A named constant.

    `type` is the name of a primitive.
    """

    name: str
    type: str
    value: bool | int | float | str | bytes


class Structure(NamedTuple):
    """The content of a message, or of a part of a service or action, such as a request.

    Attributes:
        type_name: the type, such as ``geometry_msgs/msg/Point`` or ``std_srvs/srv/SetBool_Request``.
        fields: the fields in the order of the file.
        constants: the constants in the order of the file.
    """

    type_name: str
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...] = ()

    @property
    def wire_fields(self) -> tuple[Field, ...]:
        """The serialized fields, or rosidl's filler field if the structure has none."""
        return self.fields or (Field(EMPTY_MEMBER, FieldType("uint8")),)

    @property
    def references(self) -> Iterator[str]:
        """The type name of the structure in each field that has one.

        Names may repeat.
        """
        return (field.type.base for field in self.fields if "/" in field.type.base)


class Service(NamedTuple):
    """A service: a request and its response."""

    type_name: str
    request: Structure
    response: Structure


class Action(NamedTuple):
    """An action: a goal, feedback during its execution, and a result."""

    type_name: str
    goal: Structure
    result: Structure
    feedback: Structure


Definition = Structure | Service | Action


def build_interface(type_name: str, structures: Sequence[Structure]) -> Definition:
    """Build a message, service or action from its structures.

    The structures must be in the order of the file.
    """
    kind = type_name.split("/")[1]
    if kind == "msg":
        return structures[0]
    return Service(type_name, *structures) if kind == "srv" else Action(type_name, *structures)


def list_structures(definition: Definition) -> tuple[Structure, ...]:
    """Return the structures that a file defines, in the order of the file."""
    if isinstance(definition, Structure):
        return (definition,)
    if isinstance(definition, Service):
        return (definition.request, definition.response)
    return (definition.goal, definition.result, definition.feedback)


# --- definitions that rosidl adds to services and actions -------------------------------------------------------

_GOAL_ID = Field("goal_id", FieldType("unique_identifier_msgs/msg/UUID"))


def make_event_structure(service: Service) -> Structure:
    """Return the message of a service's introspection topic (REP 2012)."""
    return Structure(
        service.type_name + "_Event",
        (
            Field("info", FieldType("service_msgs/msg/ServiceEventInfo")),
            Field("request", FieldType(service.request.type_name, container=Container.SEQUENCE, size=1)),
            Field("response", FieldType(service.response.type_name, container=Container.SEQUENCE, size=1)),
        ),
    )


def make_send_goal_service(action: Action) -> Service:
    """Return the service through which an action server accepts goals."""
    name = action.type_name + "_SendGoal"
    return Service(
        name,
        Structure(name + "_Request", (_GOAL_ID, Field("goal", FieldType(action.goal.type_name)))),
        Structure(
            name + "_Response",
            (Field("accepted", FieldType("bool")), Field("stamp", FieldType("builtin_interfaces/msg/Time"))),
        ),
    )


def make_get_result_service(action: Action) -> Service:
    """Return the service through which an action server returns a goal's status and result."""
    name = action.type_name + "_GetResult"
    return Service(
        name,
        Structure(name + "_Request", (_GOAL_ID,)),
        Structure(
            name + "_Response",
            (Field("status", FieldType("int8")), Field("result", FieldType(action.result.type_name))),
        ),
    )


def make_feedback_structure(action: Action) -> Structure:
    """Return the message of an action's feedback topic: the feedback and the goal's id."""
    return Structure(
        action.type_name + "_FeedbackMessage", (_GOAL_ID, Field("feedback", FieldType(action.feedback.type_name)))
    )


def derive_definitions(definition: Definition) -> dict[str, Definition]:
    """Return an interface and all definitions that rosidl derives from it, by type name."""
    parts: dict[str, Definition] = {definition.type_name: definition}
    if isinstance(definition, Service):
        for structure in (definition.request, definition.response, make_event_structure(definition)):
            parts[structure.type_name] = structure
    elif isinstance(definition, Action):
        for structure in (definition.goal, definition.result, definition.feedback, make_feedback_structure(definition)):
            parts[structure.type_name] = structure
        for service in (make_send_goal_service(definition), make_get_result_service(definition)):
            parts |= derive_definitions(service)
    return parts
