"""Find the names that Python classes inherit, to tell removed methods from inherited ones."""

from __future__ import annotations

import ast
import builtins
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

from linkwright.review.caching import cached_in_review
from linkwright.review.sources.names import SourceName
from linkwright.review.sources.shared_constants import find_own_module, read_module

NODE_NAMES = frozenset(
    {
        *("add_on_set_parameters_callback", "add_post_set_parameters_callback", "add_pre_set_parameters_callback"),
        *("add_waitable", "assert_liveliness", "clients", "context", "count_clients", "count_publishers"),
        *("count_services", "count_subscribers", "create_client", "create_guard_condition", "create_publisher"),
        *("create_rate", "create_service", "create_subscription", "create_timer", "declare_parameter"),
        *("declare_parameters", "default_callback_group", "describe_parameter", "describe_parameters"),
        *("destroy_client", "destroy_guard_condition", "destroy_node", "destroy_publisher", "destroy_rate"),
        *("destroy_service", "destroy_subscription", "destroy_timer", "executor"),
        *("get_client_names_and_types_by_node", "get_clients_info_by_service", "get_clock"),
        *(
            "get_fully_qualified_name",
            "get_fully_qualified_node_names",
            "get_action_names_and_types",
            "get_logger",
            "get_name",
            "get_namespace",
            "get_node_names",
        ),
        *("get_node_names_and_namespaces", "get_node_names_and_namespaces_with_enclaves", "get_parameter"),
        *("get_parameter_or", "get_parameter_type", "get_parameter_types", "get_parameters"),
        *("get_parameters_by_prefix", "get_publisher_names_and_types_by_node", "get_publishers_info_by_topic"),
        *("get_servers_info_by_service", "get_service_names_and_types", "get_service_names_and_types_by_node"),
        *("get_subscriber_names_and_types_by_node", "get_subscriptions_info_by_topic", "get_topic_names_and_types"),
        *("graph", "guards", "handle", "has_parameter", "list_parameters", "publishers"),
        *("remove_on_set_parameters_callback", "remove_post_set_parameters_callback"),
        *("remove_pre_set_parameters_callback", "remove_waitable", "resolve_service_name", "resolve_topic_name"),
        "PARAM_REL_TOL",
        *("services", "set_descriptor", "set_parameters", "set_parameters_atomically", "set_parameters_callback"),
        *("subscriptions", "timers", "undeclare_parameter", "wait_for_node", "waitables"),
    }
)
"""The public names of nodes in the versions of rclpy."""
_LIFECYCLE_NAMES = frozenset(
    {
        *("on_configure", "on_activate", "on_deactivate", "on_cleanup", "on_shutdown", "on_error"),
        *("trigger_configure", "trigger_activate", "trigger_deactivate", "trigger_cleanup", "trigger_shutdown"),
        *("create_lifecycle_publisher", "destroy_lifecycle_publisher", "add_managed_entity", "register_callback"),
    }
)
_THREAD_NAMES = frozenset(
    {"start", "run", "join", "name", "getName", "setName", "ident", "native_id", "is_alive", "isAlive", "daemon"}
) | {"isDaemon", "setDaemon"}
_WAITABLE_NAMES = frozenset(
    {"add_future", "add_to_wait_set", "callback_group", "destroy", "execute", "get_num_entities", "is_ready"}
) | {"remove_future", "take_data"}
_CLIENT_NAMES = _WAITABLE_NAMES | {"send_goal", "send_goal_async", "server_is_ready", "wait_for_server"}
_SERVER_NAMES = _WAITABLE_NAMES | {
    *("action_type", "notify_execute", "notify_goal_done", "register_cancel_callback", "register_execute_callback"),
    *("register_goal_callback", "register_handle_accepted_callback"),
}
_SIMPLE_CLIENT_NAMES = frozenset(
    {
        *("action_client", "cancel_all_goals", "cancel_goal", "cancel_goals_at_and_before_time", "done_condition"),
        *("get_goal_status_text", "get_result", "get_state", "gh", "send_goal", "send_goal_and_wait", "simple_state"),
        *("stop_tracking_goal", "wait_for_result", "wait_for_server"),
    }
)
_SIMPLE_SERVER_NAMES = frozenset(
    {
        *("accept_new_goal", "action_server", "current_goal", "executeLoop", "execute_callback", "execute_condition"),
        *("execute_thread", "get_default_result", "goal_callback", "internal_goal_callback", "is_active"),
        *("internal_preempt_callback", "is_new_goal_available", "is_preempt_requested", "lock", "need_to_terminate"),
        *("new_goal", "new_goal_preempt_request", "next_goal", "preempt_callback", "preempt_request"),
        *("publish_feedback", "register_goal_callback", "register_preempt_callback", "set_aborted", "set_preempted"),
        *("set_succeeded", "start", "terminate_mutex"),
    }
)
_STATE_NAMES = frozenset(
    {
        *("execute", "get_registered_input_keys", "get_registered_outcomes", "get_registered_output_keys"),
        *("preempt_requested", "recall_preempt", "register_input_keys", "register_io_keys", "register_outcomes"),
        *("register_output_keys", "request_preempt", "service_preempt", "userdata"),
    }
)
_KNOWN_BASES: Mapping[tuple[str, str], frozenset[str]] = {
    ("abc", "ABC"): frozenset({"register"}),
    ("typing", "Generic"): frozenset(),
    ("typing", "Protocol"): frozenset(),
    ("threading", "Thread"): _THREAD_NAMES,
    ("rclpy.node", "Node"): NODE_NAMES,
    ("rclpy.lifecycle", "LifecycleNode"): NODE_NAMES | _LIFECYCLE_NAMES,
    ("rclpy.lifecycle", "Node"): NODE_NAMES | _LIFECYCLE_NAMES,
    **dict.fromkeys((("rclpy.action", "ActionClient"), ("rclpy.action.client", "ActionClient")), _CLIENT_NAMES),
    **dict.fromkeys((("rclpy.action", "ActionServer"), ("rclpy.action.server", "ActionServer")), _SERVER_NAMES),
    ("actionlib", "SimpleActionClient"): _SIMPLE_CLIENT_NAMES,
    ("actionlib", "SimpleActionServer"): _SIMPLE_SERVER_NAMES,
    ("smach", "State"): _STATE_NAMES,
    **dict.fromkeys((("enum", "Enum"), ("enum", "Flag")), frozenset({"name", "value"})),
    **dict.fromkeys((("enum", "IntEnum"), ("enum", "IntFlag")), frozenset({"name", "value", *dir(int)})),
    **{("", name): frozenset(dir(value)) for name, value in vars(builtins).items() if isinstance(value, type)},
}
"""The public names of classes of other packages and built-in classes, by module and class."""
_DYNAMIC_NAMES = frozenset({"__getattr__", "__getattribute__"})
_MAX_DEPTH = 8
_MAX_TREES = 256
"""The maximum number of syntax trees whose imports are kept. A source can use many classes."""


def find_inherited_names(path: Path, tree: ast.Module, definition: ast.ClassDef, depth: int = 0) -> set[str] | None:
    """Return the public names that a class inherits, or None if they are uncertain.

    They are uncertain if a decorator, a metaclass or a base class of an unknown package may add names.

    Args:
        path: the path of the source.
        tree: the syntax tree of the source.
        definition: the class.
        depth: the number of classes that lead to this one.
    """
    names = _list_names(definition)
    if definition.decorator_list or definition.keywords or not names.isdisjoint(_DYNAMIC_NAMES) or depth > _MAX_DEPTH:
        return None
    inherited: set[str] = set()
    for base in definition.bases:
        name = base.value if isinstance(base, ast.Subscript) else base  # ``Generic[T]``
        found = _find_base_names(path, tree, ast.unparse(name), depth)
        if found is None:
            return None
        inherited |= found
    return inherited


def list_known_names(path: Path, tree: ast.Module, definition: ast.ClassDef, depth: int = 0) -> set[str]:
    """Return the names that a class and those of its base classes that the package defines have.

    Args:
        path: the path of the source.
        tree: the syntax tree of the source.
        definition: the class.
        depth: the number of classes that lead to this one.
    """
    names = _list_names(definition)
    for base in definition.bases if depth < _MAX_DEPTH else ():
        found = find_class(path, tree, ast.unparse(base))
        if found is not None:
            names |= list_known_names(*found, depth + 1)
    return names


def find_class(path: Path, tree: ast.Module, name: str, depth: int = 0) -> tuple[Path, ast.Module, ast.ClassDef] | None:
    """Return a class that a source defines or imports from its package, with its source; None for other classes.

    Args:
        path: the path of the source.
        tree: the syntax tree of the source.
        name: the name of the class in the source, such as ``Widget`` or ``widgets.Widget``.
        depth: the number of sources that lead to this one.
    """
    definitions = [node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == name]
    if definitions:
        return (path, tree, definitions[0]) if len(definitions) == 1 else None
    module, own_name, level = _find_import(tree, name)
    file = find_own_module(path, module, level) if module or level else None
    other = None if file is None or file == path else read_module(str(file), file.stat().st_mtime_ns)
    if file is None or other is None or depth >= _MAX_DEPTH:
        return None
    return find_class(file, other, own_name, depth + 1)


def select_methods(
    items: Iterable[SourceName], own: Mapping[str, Collection[str]], other: Mapping[str, Collection[str]]
) -> list[SourceName]:
    """Return the functions that only one version has, without methods that the other version inherits.

    Methods of classes that one version lacks are left out, too.

    Args:
        items: the functions and methods of one version.
        own: the names that each class of this version inherits.
        other: the names that each class of the other version inherits.
    """
    parts = ((item, *item.name.rpartition(".")[::2]) for item in items)
    return [
        item
        for item, owner, name in parts
        if not owner or (owner in own and owner in other and name not in other[owner])
    ]


def _find_base_names(path: Path, tree: ast.Module, base: str, depth: int) -> set[str] | None:
    """Return the public names that objects of a base class have, or None if they are uncertain."""
    definitions = [node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == base]
    if definitions:
        inherited = find_inherited_names(path, tree, definitions[0], depth + 1) if len(definitions) == 1 else None
        return None if inherited is None else inherited | _list_names(definitions[0])
    module, name, level = _find_import(tree, base)
    known = _KNOWN_BASES.get((module, name)) if not level else None
    if known is not None:
        return set(known)
    file = find_own_module(path, module, level)
    other = None if file is None else read_module(str(file), file.stat().st_mtime_ns)
    is_defined = other is not None and any(isinstance(node, ast.ClassDef) and node.name == name for node in other.body)
    if file is None or other is None or not is_defined or depth >= _MAX_DEPTH:
        return None
    return _find_base_names(file, other, name, depth + 1)


def _find_import(tree: ast.Module, base: str) -> tuple[str, str, int]:
    """Return the module and name of a base class, and the number of dots before the module."""
    prefix, _, name = base.rpartition(".")
    for node in _list_imports(tree):
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                if not prefix and (alias.asname or alias.name) == name:
                    return node.module or "", alias.name, node.level
                if prefix and (alias.asname or alias.name) == prefix:
                    return f"{node.module}.{alias.name}" if node.module else alias.name, name, node.level
        elif prefix:
            for alias in node.names:
                if (alias.asname or alias.name) == prefix:
                    return alias.name, name, 0
    return prefix, name, 0


@cached_in_review(maxsize=_MAX_TREES)
def _list_imports(tree: ast.Module) -> tuple[ast.Import | ast.ImportFrom, ...]:
    """Return the imports of a source, also those inside of functions."""
    return tuple(node for node in ast.walk(tree) if isinstance(node, (ast.Import, ast.ImportFrom)))


def _list_names(definition: ast.ClassDef) -> set[str]:
    """Return the names that the body of a class defines."""
    names: set[str] = set()
    for node in definition.body:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            names.add(node.name)
        else:
            names |= {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}
    return names
