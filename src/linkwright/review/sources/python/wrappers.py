"""Find Python classes of a package that make a publisher, subscription, service or client for their callers."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from linkwright.packages.readers.python_values import argument_of, called_name
from linkwright.review.sources.names import NameKind
from linkwright.review.sources.python.bases import find_class

CREATING_METHODS = {
    "create_publisher": (NameKind.PUBLISHER, "msg_type", "topic", 2),
    "create_lifecycle_publisher": (NameKind.PUBLISHER, "msg_type", "topic", 2),
    "create_subscription": (NameKind.SUBSCRIPTION, "msg_type", "topic", 3),
    "create_service": (NameKind.SERVICE, "srv_type", "srv_name", -1),
    "create_client": (NameKind.CLIENT, "srv_type", "srv_name", -1),
}
"""The kind of each method of rclpy, the keywords of its type and name, and the index of its QoS argument."""
_CONSTRUCTOR = "__init__"
_SELF = "self"
_MAX_DEPTH = 8
_ROS1_CLASSES = {
    "rospy.Publisher": NameKind.PUBLISHER,
    "rospy.Subscriber": NameKind.SUBSCRIPTION,
    "rospy.Service": NameKind.SERVICE,
    "rospy.ServiceProxy": NameKind.CLIENT,
}
"""The classes of rospy whose first two arguments are the name and the type."""


class WrappedName(NamedTuple):
    """A topic or service that a class makes, whose name the callers of the class pass.

    Attributes:
        kind: the kind of the name.
        expression: the name in the code of the class.
        name: the index and the parameter with the name.
        type: the index and the parameter with the type; None if callers do not pass it.
        qos: the index and the parameter with the QoS; None if callers do not pass it.
        default: the default of the name; None if there is none.
    """

    kind: NameKind
    expression: str
    name: tuple[int, str]
    type: tuple[int, str] | None
    qos: tuple[int, str] | None
    default: ast.expr | None


class WrapperClasses:
    """The classes that a Python source defines or imports from its package, with the names that they make.

    Args:
        path: the path of the source.
        tree: the syntax tree of the source.
    """

    def __init__(self, path: Path, tree: ast.Module) -> None:
        self._path = path
        self._tree = tree
        self._found: dict[str, list[WrappedName]] = {}

    def find(self, call: ast.Call) -> list[WrappedName]:
        """Return the names that the class makes that a call constructs. The list is empty for other calls."""
        name = ast.unparse(call.func) if isinstance(call.func, (ast.Name, ast.Attribute)) else ""
        if not name.rpartition(".")[2][:1].isupper() or name.partition(".")[0] == _SELF:
            return []
        if name not in self._found:
            self._found[name] = _find_in_class(self._path, self._tree, name)
        return self._found[name]

    def list_arguments(self) -> set[str]:
        """Return the expressions of names in the classes of the source that callers of the classes pass."""
        classes = (node for node in self._tree.body if isinstance(node, ast.ClassDef))
        return {wrapped.expression for node in classes for wrapped in find_wrapped_names(node)}


def _find_in_class(path: Path, tree: ast.Module, name: str, depth: int = 0) -> list[WrappedName]:
    """Return the names that a class makes. A class without a constructor has that of its base class."""
    found = find_class(path, tree, name)
    if found is None:
        return []
    file, module, definition = found
    if len(definition.bases) != 1 or depth >= _MAX_DEPTH:
        return list(find_wrapped_names(definition))
    base = ast.unparse(definition.bases[0])
    if _find_constructor(definition) is None:
        return _find_in_class(file, module, base, depth + 1)
    found_base = find_class(file, module, base)
    return list(find_wrapped_names(definition, None if found_base is None else found_base[2]))


def _find_inherited_members(
    base: ast.ClassDef, constructor: ast.FunctionDef, places: Mapping[str, tuple[int, str]]
) -> dict[str, tuple[int, str]]:
    """Return the members that the constructor of a base class sets to arguments which a constructor passes on.

    Args:
        base: the base class.
        constructor: the constructor that calls the one of the base class.
        places: the indexes of the parameters of the calling constructor.
    """
    own = _find_constructor(base)
    calls = [
        node
        for node in ast.walk(constructor)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == _CONSTRUCTOR
    ]
    if own is None or len(calls) != 1:
        return {}
    is_explicit = bool(calls[0].args) and ast.unparse(calls[0].args[0]) == _SELF  # ``Base.__init__(self, ...)``
    members = {}
    for member, (index, name) in _find_members(base, own, _find_places(own)).items():
        argument = get_argument(calls[0], index + is_explicit if index >= 0 else index, name)
        if isinstance(argument, ast.Name) and argument.id in places:
            members[member] = places[argument.id]
    return members


def _find_places(constructor: ast.FunctionDef) -> dict[str, tuple[int, str]]:
    """Return the index and the name of each parameter that a constructor does not assign, by its name."""
    parameters = constructor.args
    positional = [*parameters.posonlyargs, *parameters.args][1:]
    indexes = {argument.arg: index for index, argument in enumerate(positional)}
    indexes |= {argument.arg: -1 for argument in parameters.kwonlyargs}
    return {name: (index, name) for name, index in indexes.items() if not _is_assigned(constructor, name)}


def _find_constructor(definition: ast.ClassDef) -> ast.FunctionDef | None:
    methods = (node for node in definition.body if isinstance(node, ast.FunctionDef))
    return next((method for method in methods if method.name == _CONSTRUCTOR), None)


def find_wrapped_names(definition: ast.ClassDef, base: ast.ClassDef | None = None) -> Iterator[WrappedName]:
    """Yield the topics and services that a class makes with names that its constructor gets.

    Args:
        definition: the class.
        base: the base class, to whose constructor that of the class may pass the names; None if it is unknown.
    """
    constructor = _find_constructor(definition)
    if constructor is None:
        return
    parameters = constructor.args
    positional = [*parameters.posonlyargs, *parameters.args][1:]
    defaults = {
        argument.arg: value
        for argument, value in zip(reversed(positional), reversed(parameters.defaults), strict=False)
    }
    places = _find_places(constructor)
    members = _find_members(definition, constructor, places)
    inherited = {} if base is None else _find_inherited_members(base, constructor, places)
    stored = _list_stored_members(definition)
    members |= {member: place for member, place in inherited.items() if member not in stored}
    stored = _list_stored_members(constructor)  # other methods run later
    first_members = members | {member: place for member, place in inherited.items() if member not in stored}
    constructor_nodes = {id(node) for node in ast.walk(constructor)}

    def find_place(node: ast.expr | None, *, is_inside: bool) -> tuple[int, str] | None:
        if isinstance(node, ast.Name) and is_inside:
            return places.get(node.id)
        return None if node is None else (first_members if is_inside else members).get(ast.unparse(node))

    for call in (node for node in ast.walk(definition) if isinstance(node, ast.Call)):
        made = _read_creation(call)
        if made is None or made[1] is None:
            continue
        kind, name, type_node, qos = made
        is_inside = id(call) in constructor_nodes
        place = find_place(name, is_inside=is_inside)
        if name is not None and place is not None:
            type_place, qos_place = (find_place(node, is_inside=is_inside) for node in (type_node, qos))
            yield WrappedName(kind, ast.unparse(name), place, type_place, qos_place, defaults.get(place[1]))


def _is_assigned(function: ast.FunctionDef, name: str) -> bool:
    names = (node for node in ast.walk(function) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store))
    return any(node.id == name for node in names)


def _find_members(
    definition: ast.ClassDef, constructor: ast.FunctionDef, places: Mapping[str, tuple[int, str]]
) -> dict[str, tuple[int, str]]:
    """Return the members, such as ``self.topic``, that only get an argument of the constructor."""
    stored = _list_stored_members(definition)
    members: dict[str, tuple[int, str]] = {}
    for node in ast.walk(constructor):
        targets = (
            node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
        )
        value = node.value if isinstance(node, (ast.Assign, ast.AnnAssign)) else None
        place = places.get(value.id) if isinstance(value, ast.Name) else None
        for target in targets if place is not None else ():
            text = ast.unparse(target)
            if text.startswith(f"{_SELF}.") and stored.count(text) == 1 and place is not None:
                members[text] = place
    return members


def _list_stored_members(definition: ast.ClassDef | ast.FunctionDef) -> list[str]:
    """Return the attributes that get a value in a class or method, as often as they do."""
    nodes = (node for node in ast.walk(definition) if isinstance(node, ast.Attribute))
    return [ast.unparse(node) for node in nodes if isinstance(node.ctx, ast.Store)]


def _read_creation(
    call: ast.Call,
) -> tuple[NameKind, ast.expr | None, ast.expr | None, ast.expr | None] | None:
    """Return the kind, name, type and QoS of the topic or service that a call makes; None for other calls."""
    method = call.func.attr if isinstance(call.func, ast.Attribute) else ""
    if method in CREATING_METHODS:
        kind, type_keyword, name_keyword, index = CREATING_METHODS[method]
        qos = get_argument(call, index, "qos_profile")
        return kind, get_argument(call, 1, name_keyword), get_argument(call, 0, type_keyword), qos
    ros1_kind = _ROS1_CLASSES.get(called_name(call))
    if ros1_kind is None:
        return None
    return ros1_kind, get_argument(call, 0, "name"), get_argument(call, 1, "data_class"), None


def get_argument(call: ast.Call, index: int, keyword: str) -> ast.expr | None:
    """Return the argument of a call at an index or with a keyword, or None."""
    if 0 <= index < len(call.args):
        return call.args[index]
    return argument_of(call, keyword)
