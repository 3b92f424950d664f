"""Create the classes of messages, services and actions from generated code, on first use.

The generated constructor and setters contain only the code that the fields need. They test for the usual case inline
(``value.__class__ is float``) and leave all other cases to `linkwright.messages.checks`. The property of a field reads
its slot through a C function, so reading a field is as fast as reading a plain attribute.
"""

from __future__ import annotations

import keyword
import threading
from array import array
from importlib import import_module
from operator import attrgetter
from typing import Any, cast

from linkwright.messages import checks
from linkwright.messages.definitions.interfaces import (
    Action,
    Container,
    Definition,
    Field,
    Service,
    Structure,
    make_event_structure,
    make_feedback_structure,
    make_get_result_service,
    make_send_goal_service,
    python_module,
)
from linkwright.messages.definitions.library import LIBRARY, make_wrong_kind_diagnostic
from linkwright.messages.errors import InterfaceNotFoundError
from linkwright.messages.message import ActionImplementation, ActionType, DurationValue, Message, ServiceType, TimeValue


def build_class(structure: Structure, base: type, classes: dict[str, type], module: str) -> type:
    """Build the class of a structure.

    Args:
        structure: the definition of the structure.
        base: the base class of the new class.
        classes: the class of every structure that the fields use, by type name.
        module: the module name that the class reports.
    """
    # The names start with an upper-case letter, so that they cannot be the names of fields.
    scope: dict[str, Any] = {
        "U": checks.UNSET,
        "Checks": checks,
        "Array": array,
        "Range": range,
        "List": list,
        "Set": set,
        "Map": map,
        "Type": type,
    }
    if any(field.type.is_numeric_array and field.type.container is Container.ARRAY for field in structure.fields):
        import numpy as np

        scope["Np"] = np
    fields = [_FieldCode(field, classes, scope) for field in structure.fields]
    code = "".join([_make_constructor(fields), *(field.setter() for field in fields)])
    exec(compile(code, f"<class of {structure.type_name}>", "exec"), scope)  # noqa: S102 - the names in it are checked
    name = structure.type_name.rpartition("/")[2]
    body: dict[str, Any] = {
        "__slots__": tuple("_" + field.name for field in structure.fields),
        "__module__": module,
        "__doc__": _make_docstring(name, structure),
        "__init__": scope["__init__"],
        "TYPE_NAME": structure.type_name,
        "_definition": structure,
    }
    for field in fields:
        body[field.name] = property(attrgetter("_" + field.name), scope["S_" + field.name], None, field.docstring())
        if field.field.default is not None:
            body[field.name.upper() + "__DEFAULT"] = field.default
    for constant in structure.constants:
        body[constant.name] = constant.value
    message_class = type(base)(name, (base,), body)
    for field in fields:
        function = scope["S_" + field.name]
        function.__qualname__ = f"{name}.{field.name}"
    return message_class


class _FieldCode:
    """A generator of the code for one field."""

    def __init__(self, field: Field, classes: dict[str, type], scope: dict[str, Any]) -> None:
        self.field = field
        self.name = field.name
        self.kind = field.type
        scope["K_" + field.name] = field.type
        if self.kind.primitive is None:
            scope["C_" + field.name] = classes[self.kind.base]
        self.default = self._get_default()
        if self.default is not None and not self._is_single():
            scope["D_" + field.name] = self.default

    def docstring(self) -> str:
        return f"Message field '{self.name}'."

    def parameter(self) -> str:
        # A field may have the name of a Python keyword, such as 'from', which must be given through **other.
        return "" if keyword.iskeyword(self.name) else f"{self.name}=U, "

    def initial(self) -> str:
        """Return the lines of the constructor that set this field."""
        name = argument = self.name
        lines = ""
        if keyword.iskeyword(name):
            argument = name + "_"
            lines = f"    {argument} = Rest.pop({name!r}, U)\n"
        lines += f"    if {argument} is U: M._{name} = {self._make_default_expression()}\n"
        if self.kind.is_numeric_array:
            convert = "to_fixed_array" if self.kind.container is Container.ARRAY else "to_sequence"
            return lines + f"    else: M._{name} = Checks.{convert}({name!r}, {argument}, K_{name})\n"
        if self._is_single():  # as in the setter, but without calling it
            lines += f"    elif {self._make_usual_test(argument)}: M._{name} = {argument}\n"
        return lines + f"    else: S_{name}(M, {argument})\n"

    def setter(self) -> str:
        name = self.name
        return f"def S_{name}(self, value):\n{self._make_check_lines()}    self._{name} = value\n"

    # --- the check ------------------------------------------------------------------------------------------

    def _make_check_lines(self) -> str:
        name, kind, primitive = self.name, self.kind, self.kind.primitive
        if kind.is_numeric_array and kind.container is Container.ARRAY:
            return f"    value = Checks.check_fixed_array({name!r}, value, K_{name})\n"
        if kind.is_numeric_array:
            assert primitive is not None
            usual_case = (
                f"value.__class__ is Array and value.typecode == {primitive.array_code!r}" + self._make_length_check()
            )
            return f"    if not ({usual_case}): value = Checks.check_sequence({name!r}, value, K_{name})\n"
        if kind.container is not Container.ONE:
            cls = f"C_{name}" if primitive is None else primitive.python.__name__
            check = f"value = Checks.check_values({name!r}, value, K_{name}, {cls})"
            if kind.string_bound is not None:
                return f"    {check}\n"
            usual_case = f"value.__class__ is List and Set(Map(Type, value)) <= {{{cls}}}" + self._make_length_check()
            return f"    if not ({usual_case}): {check}\n"
        if primitive is None:
            check = f"check_message({name!r}, value, C_{name})"
        elif primitive.python is int:
            check = f"check_int({name!r}, value, {primitive.low}, {primitive.high})"
        elif primitive.python is float:
            check = f"check_float({name!r}, value, {primitive.high!r})"
        elif primitive.python is bool:
            check = f"check_bool({name!r}, value)"
        elif primitive.python is bytes:
            check = f"check_byte({name!r}, value)"
        else:
            check = f"check_text({name!r}, value, {kind.string_bound})"
        return f"    if not ({self._make_usual_test('value')}): value = Checks.{check}\n"

    def _make_length_check(self) -> str:
        """Return an expression that tests the number of values.

        The expression is empty if any number is valid.
        """
        if self.kind.size is None:
            return ""
        return f" and len(value) {'==' if self.kind.container is Container.ARRAY else '<='} {self.kind.size}"

    def _make_usual_test(self, value: str) -> str:
        """Return an expression that tests whether a single value can be stored unchanged."""
        kind, primitive = self.kind, self.kind.primitive
        if primitive is None:
            return f"{value}.__class__ is C_{self.name}"
        test = f"{value}.__class__ is {primitive.python.__name__}"
        if primitive.python is int:
            test += f" and {primitive.low} <= {value} <= {primitive.high}"
        elif primitive.code == "f":
            test += f" and -{primitive.high!r} <= {value} <= {primitive.high!r}"
        elif primitive.python is bytes:
            test += f" and len({value}) == 1"
        elif primitive.python is str and kind.string_bound is not None:
            test += f" and len({value}) <= {kind.string_bound}"
        return test

    # --- the default ----------------------------------------------------------------------------------------

    def _is_single(self) -> bool:
        return self.kind.container is Container.ONE

    def _get_default(self) -> Any:
        """Return the default value as the field stores it, or None if there is no default."""
        value = self.field.default
        if value is None or self._is_single():
            return value
        assert isinstance(value, tuple)
        return list(value)

    def _make_default_expression(self) -> str:
        kind, primitive, name = self.kind, self.kind.primitive, self.name
        if kind.is_numeric_array:
            assert primitive is not None
            values = "" if self.default is None else f"D_{name}"
            if kind.container is Container.ARRAY:
                dtype = f"dtype={primitive.dtype!r}"
                return f"Np.array({values}, {dtype})" if values else f"Np.zeros({kind.size}, {dtype})"
            return f"Array({primitive.array_code!r}" + (f", {values})" if values else ")")
        if not self._is_single():
            if self.default is not None:
                return f"List(D_{name})"
            if kind.container is Container.SEQUENCE:
                return "[]"
            return f"[{self._make_single_default()} for _ in Range({kind.size})]"
        return self._make_single_default() if self.default is None else repr(self.default)

    def _make_single_default(self) -> str:
        primitive = self.kind.primitive
        if primitive is None:
            return f"C_{self.name}()"
        return {int: "0", float: "0.0", bool: "False", str: "''", bytes: "b'\\0'"}[primitive.python]


def _make_constructor(fields: list[_FieldCode]) -> str:
    parameters = "".join(field.parameter() for field in fields)
    lines = "".join(field.initial() for field in fields)
    keyword_only = "*, " if fields else ""
    return f"def __init__(M, {keyword_only}{parameters}**Rest):\n{lines}    if Rest: Checks.refuse_arguments(Rest)\n"


def _make_docstring(name: str, structure: Structure) -> str:
    text = f"Message class '{name}'."
    if structure.constants:
        text += "\n\nConstants:\n" + "\n".join(f"  {constant.name}" for constant in structure.constants)
    return text


_classes: dict[str, Any] = {}
_lock = threading.RLock()

_BASE_CLASSES: dict[str, type[Message]] = {
    "builtin_interfaces/msg/Time": TimeValue,
    "builtin_interfaces/msg/Duration": DurationValue,
}
"""The base classes of message classes with additional methods, by type name."""

_HAND_WRITTEN_MODULES = {"tf2_msgs/msg/TFMessage": "linkwright.messages.tf_message"}
"""The modules of hand-written classes, by type name.

They are imported on demand, because their import of numpy takes long.
"""


def get_message(name: str) -> type[Any]:
    """Return the class of a message, or of a part of a service or action.

    An example of a part is ``std_srvs/srv/SetBool_Request``.

    Args:
        name: the type name, such as ``sensor_msgs/msg/JointState`` or ``sensor_msgs/JointState``.

    Raises:
        InterfaceNotFoundError: MSG101 with the nearest names, MSG102 for a text that is not a name.
        DefinitionError: the interface file in the workspace has mistakes.
    """
    return _find_class(name, Message, "msg")


def get_service(name: str) -> type[Any]:
    """Return the class of a service, with `Request` and `Response`.

    Names and errors are as in `get_message`.
    """
    return _find_class(name, ServiceType, "srv")


def get_action(name: str) -> type[Any]:
    """Return the class of an action, with `Goal`, `Result`, `Feedback` and `Impl`.

    Names and errors are as in `get_message`.
    """
    return _find_class(name, ActionType, "action")


def get_interface(name: str) -> type[Any]:
    """Return the class of a message, service or action.

    For ``package/Name``, a message is preferred to a service, and a service to an action.
    """
    return cast("type[Any]", _classes.get(name) or _get_class(LIBRARY.definition(name)))


def class_of(structure: Structure) -> type[Any]:
    """Return the message class for a structure.

    The class is created on first use.
    """
    return cast("type[Any]", _get_class(structure))


def add_class(message_class: type[Message]) -> None:
    """Register a hand-written class for its type."""
    _classes[message_class.TYPE_NAME] = message_class


def _find_class(name: str, base: type, kind: str) -> type[Any]:
    interface_class = _classes.get(name)
    if interface_class is None:
        # The kind in a full name is not checked, because a message may be 'std_srvs/srv/SetBool_Request'.
        interface_class = _get_class(LIBRARY.definition(name, *(() if name.count("/") == 2 else (kind,))))
    if not issubclass(interface_class, base):
        raise InterfaceNotFoundError(make_wrong_kind_diagnostic(LIBRARY.definition(name), kind))
    return cast("type[Any]", interface_class)


def _get_class(definition: Definition) -> Any:
    interface_class = _classes.get(definition.type_name)
    if interface_class is None:
        with _lock:
            interface_class = _classes.get(definition.type_name)
            if interface_class is None:
                interface_class = _classes[definition.type_name] = _create_class(definition)
    return interface_class


def _create_class(definition: Definition) -> type:
    if isinstance(definition, Structure):
        return _create_message_class(definition)
    if isinstance(definition, Service):
        return _create_service_class(definition)
    return _create_action_class(definition)


def _create_message_class(structure: Structure) -> type:
    classes = {name: _get_class(LIBRARY.structure(name)) for name in structure.references}
    if structure.type_name in _HAND_WRITTEN_MODULES:
        import_module(_HAND_WRITTEN_MODULES[structure.type_name])  # The module calls `add_class` when it is imported.
        return cast("type", _classes[structure.type_name])
    base = _BASE_CLASSES.get(structure.type_name, Message)
    return build_class(structure, base, classes, python_module(structure.type_name))


def _create_service_class(service: Service) -> type:
    name = service.type_name
    return type(
        name.rpartition("/")[2],
        (ServiceType,),
        {
            "__module__": python_module(name),
            "__doc__": f"Service class '{name.rpartition('/')[2]}'.",
            "TYPE_NAME": name,
            "Request": _get_class(service.request),
            "Response": _get_class(service.response),
            "Event": _LazyClass(make_event_structure(service)),
        },
    )


def _create_action_class(action: Action) -> type:
    name = action.type_name
    implementation = type(
        "Impl",
        (ActionImplementation,),
        {
            "SendGoalService": _get_class(make_send_goal_service(action)),
            "GetResultService": _get_class(make_get_result_service(action)),
            "FeedbackMessage": _get_class(make_feedback_structure(action)),
            "CancelGoalService": get_service("action_msgs/srv/CancelGoal"),
            "GoalStatusMessage": get_message("action_msgs/msg/GoalStatusArray"),
        },
    )
    return type(
        name.rpartition("/")[2],
        (ActionType,),
        {
            "__module__": python_module(name),
            "__doc__": f"Action class '{name.rpartition('/')[2]}'.",
            "TYPE_NAME": name,
            "Goal": _get_class(action.goal),
            "Result": _get_class(action.result),
            "Feedback": _get_class(action.feedback),
            "Impl": implementation,
        },
    )


class _LazyClass:
    """A class attribute that creates its value, a message class, on first access."""

    def __init__(self, structure: Structure) -> None:
        self._structure = structure

    def __get__(self, instance: object, owner: type) -> type:
        return cast("type", _get_class(self._structure))


Message._class_named = staticmethod(get_message)
Message._class_of = staticmethod(class_of)
