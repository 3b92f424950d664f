"""Find the names that Python classes inherit, to tell removed methods from inherited ones."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

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
_KNOWN_BASES: Mapping[tuple[str, str], frozenset[str]] = {
    ("", "object"): frozenset(),
    ("abc", "ABC"): frozenset({"register"}),
    ("threading", "Thread"): _THREAD_NAMES,
    ("rclpy.node", "Node"): NODE_NAMES,
    ("rclpy.lifecycle", "LifecycleNode"): NODE_NAMES | _LIFECYCLE_NAMES,
    ("rclpy.lifecycle", "Node"): NODE_NAMES | _LIFECYCLE_NAMES,
}
"""The public names of classes of other packages, by module and class."""
_DYNAMIC_NAMES = frozenset({"__getattr__", "__getattribute__"})
_MAX_DEPTH = 8


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
        found = _find_base_names(path, tree, ast.unparse(base), depth)
        if found is None:
            return None
        inherited |= found
    return inherited


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
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                if not prefix and (alias.asname or alias.name) == name:
                    return node.module or "", alias.name, node.level
                if prefix and (alias.asname or alias.name) == prefix:
                    return f"{node.module}.{alias.name}" if node.module else alias.name, name, node.level
        elif isinstance(node, ast.Import) and prefix:
            for alias in node.names:
                if (alias.asname or alias.name) == prefix:
                    return alias.name, name, 0
    return prefix, name, 0


def _list_names(definition: ast.ClassDef) -> set[str]:
    """Return the names that the body of a class defines."""
    names: set[str] = set()
    for node in definition.body:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            names.add(node.name)
        else:
            names |= {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}
    return names
