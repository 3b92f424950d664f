"""Find parts of the syntax tree of a Python launch file."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterable, Iterator, Sequence

from linkwright.packages.readers.python_values import PythonFile, called_name

ADD_METHODS = ("add_action", "add_entity")
"""The methods that add an action to a launch description."""
LIST_METHODS = ("append", "extend", "insert")
"""The methods that add items to a list."""
_GROUPS = frozenset(
    {
        *("GroupAction", "RegisterEventHandler", "TimerAction"),
        *("OnProcessExit", "OnProcessStart", "OnExecutionComplete", "OnStateTransition", "OnShutdown"),
    }
)
"""The classes of actions that start other actions, and of the handlers of events that do."""
_VALUE_KEYWORDS = {"SetRemap": ("src", "dst")}
_DEFAULT_VALUE_KEYWORDS = ("name", "value")
"""The names of the arguments of the classes that set a value; the first item of each is what is set."""

_REQUIRED_ARGUMENTS = {
    "Node": ("executable",),
    "LifecycleNode": ("executable", "name", "namespace"),
    "ComposableNodeContainer": ("executable", "name", "namespace"),
    "ComposableNode": ("package", "plugin"),
    "ExecuteProcess": ("cmd",),
}
"""The keyword arguments without which a class of launch and launch_ros raises an error."""
_PROCESS_ARGUMENTS = """
    additional_env cached_output cmd condition cwd emulate_tty env log_cmd name on_exit output output_format prefix
    respawn respawn_delay respawn_max_retries shell sigkill_timeout sigterm_timeout"""
_NODE_ARGUMENTS = f"""
    {_PROCESS_ARGUMENTS} arguments exec_name executable namespace node_name node_namespace package parameters remappings
    ros_arguments"""
_KNOWN_ARGUMENTS = {
    "Node": _NODE_ARGUMENTS,
    "LifecycleNode": f"{_NODE_ARGUMENTS} autostart",
    "ComposableNodeContainer": f"{_NODE_ARGUMENTS} composable_node_descriptions",
    "ExecuteProcess": _PROCESS_ARGUMENTS,
}
"""All keyword arguments of a class of launch and launch_ros in any distribution; others raise an error."""
OLD_KEYWORDS = {f"node_{name}": name for name in ("executable", "plugin", "name", "namespace")}
"""The new names of the arguments of nodes before ROS 2 Foxy. Galactic and later refuse the old ones."""
_LAUNCH_PACKAGES = ("launch", "launch_ros")


def find_unused_values(tree: ast.AST) -> frozenset[int]:
    """Return the identities of values that nothing uses.

    These are the values of unused names with the items of their lists and the actions of their groups and handlers,
    items that are added to such a list, and values that a later assignment replaces before they are used. A name that
    only an unused list, group or handler uses is unused, too.
    """
    nodes = list(ast.walk(tree))
    names = [node for node in nodes if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Store)]
    while True:
        unused = [part for item in _find_unused_values(nodes, names) for part in _flatten_lists(item)]
        groups = [part for part in unused if isinstance(part, ast.Name) or _find_items(part)]
        lost = {id(node) for group in groups for node in ast.walk(group)}
        used = [name for name in names if id(name) not in lost]
        if len(used) == len(names):
            return frozenset(id(value) for value in unused)
        names = used


def _find_unused_values(nodes: Sequence[ast.AST], names: Sequence[ast.Name]) -> Iterator[ast.expr]:
    """Yield the values of names that are unused or get another value first, and what is added to unused lists.

    Args:
        nodes: the nodes of the syntax tree.
        names: the nodes that use a name.
    """
    additions = [call for node in nodes for call in _find_additions(node)]
    lists = {id(call.func.value) for call in additions if isinstance(call.func, ast.Attribute)}
    used = {node.id for node in names if id(node) not in lists}
    assignments = (node for node in nodes if isinstance(node, (ast.Assign, ast.AnnAssign, ast.AugAssign)))
    for node in assignments:
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        is_unused = all(isinstance(target, ast.Name) and target.id not in used for target in targets)
        if node.value is not None and is_unused:
            yield node.value
    for call in additions:
        owner = call.func.value if isinstance(call.func, ast.Attribute) else None
        if isinstance(owner, ast.Name) and owner.id not in used:
            yield from call.args
    yield from _find_replaced_values(nodes, names)


def is_filled(tree: ast.AST, name: str) -> bool:
    """Return whether a statement adds items to the list of a name."""
    for node in ast.walk(tree):
        owners = [call.func.value for call in _find_additions(node) if isinstance(call.func, ast.Attribute)]
        target = node.target if isinstance(node, ast.AugAssign) else None
        if any(isinstance(owner, ast.Name) and owner.id == name for owner in (*owners, target)):
            return True
    return False


def _find_additions(node: ast.AST) -> Iterator[ast.Call]:
    """Yield the call if a node is a statement that adds items to a list of a name."""
    call = node.value if isinstance(node, ast.Expr) else None
    if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute) and call.func.attr in LIST_METHODS:
        yield call


def _flatten_lists(node: ast.expr) -> Iterator[ast.expr]:
    """Yield an expression and, if it is a list, a group or a handler, its items."""
    yield node
    for item in _find_items(node):
        yield from _flatten_lists(item)


def _find_items(node: ast.expr) -> list[ast.expr]:
    """Return the items of a list, a group of actions or the handler of an event; none for other expressions."""
    if isinstance(node, ast.Call) and called_name(node).rpartition(".")[2] in _GROUPS:
        return [*node.args, *(keyword.value for keyword in node.keywords)]
    return node.elts if isinstance(node, (ast.List, ast.Tuple)) else []


def _find_replaced_values(nodes: Sequence[ast.AST], names: Sequence[ast.Name]) -> Iterator[ast.expr]:
    """Yield the values of names that get another value in the same block before they are used."""
    lines: dict[str, list[int]] = {}
    for name in names:
        lines.setdefault(name.id, []).append(name.lineno)
    for node in nodes:
        body = getattr(node, "body", None)
        last: dict[str, ast.Assign] = {}
        for statement in body if isinstance(body, list) else ():
            target = statement.targets[0] if isinstance(statement, ast.Assign) else None
            if not isinstance(statement, ast.Assign) or not isinstance(target, ast.Name) or len(statement.targets) > 1:
                continue
            earlier = last.get(target.id)
            end = statement.end_lineno or statement.lineno
            if earlier is not None and not any(earlier.lineno <= line <= end for line in lines.get(target.id, ())):
                yield earlier.value
            last[target.id] = statement


def find_name_and_value(call: ast.Call, function: str) -> tuple[ast.expr | None, ast.expr | None]:
    """Return the two arguments of a call that sets a value, which may be keywords in any order."""
    keywords = {keyword.arg: keyword.value for keyword in call.keywords}
    names = _VALUE_KEYWORDS.get(function, _DEFAULT_VALUE_KEYWORDS)
    first, second = (
        call.args[index] if len(call.args) > index else keywords.get(name) for index, name in enumerate(names)
    )
    return first, second


def find_added_action(statement: ast.stmt) -> ast.expr | None:
    """Return the action that a statement adds to a launch description, or None."""
    value = statement.value if isinstance(statement, ast.Expr) else None
    is_addition = isinstance(value, ast.Call) and called_name(value).rpartition(".")[2] in ADD_METHODS
    return value.args[0] if is_addition and isinstance(value, ast.Call) and value.args else None


def find_list_item(node: ast.List | ast.Tuple, index: ast.expr) -> ast.expr | None:
    """Return the item of a literal list at an index, which may be negative, or None if it is unknown."""
    if any(isinstance(item, ast.Starred) for item in node.elts):
        return None
    try:
        number = ast.literal_eval(index)
    except (ValueError, TypeError, SyntaxError, RecursionError):
        return None
    is_index = type(number) is int and -len(node.elts) <= number < len(node.elts)
    return node.elts[number] if is_index else None


def find_missing_argument(python: PythonFile, call: ast.Call, names: Collection[str]) -> str | None:
    """Return the required argument that a call of a class of launch or launch_ros lacks, or None.

    Args:
        python: the parsed file.
        call: the call.
        names: the names of the keyword arguments of the call, with the new ones in place of old ones.
    """
    if call.args or any(keyword.arg is None for keyword in call.keywords):
        return None
    function = _find_launch_class(python, call)
    missing = [name for name in _REQUIRED_ARGUMENTS.get(function, ()) if name not in names]
    return missing[0] if missing else None


def find_unknown_argument(python: PythonFile, call: ast.Call, names: Iterable[str]) -> str | None:
    """Return the first keyword argument that a class of launch or launch_ros does not have, or None.

    Args:
        python: the parsed file.
        call: the call.
        names: the names of the keyword arguments of the call, with the new ones in place of old ones.
    """
    known = _KNOWN_ARGUMENTS.get(_find_launch_class(python, call))
    unknown = [] if known is None else [name for name in names if name not in known.split()]
    return unknown[0] if unknown else None


def _find_launch_class(python: PythonFile, call: ast.Call) -> str:
    """Return the name of the called class, or an empty text for a class of another package with such a name."""
    owner, _, function = called_name(call).rpartition(".")
    sources = python.find_import_sources(owner.partition(".")[0] or function)
    modules = [module for module, _ in sources] or [owner]
    return function if all(module.partition(".")[0] in _LAUNCH_PACKAGES for module in modules) else ""
