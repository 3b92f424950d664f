"""Report actions of Python launch files that lack an argument without which the launch file fails."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from linkwright.diagnostics import Span, phrase, quoted_names
from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.python_tests import try_parse_version

_REQUIRED = {
    "Node": ("executable", "node_executable"),
    "LifecycleNode": ("executable", "node_executable"),
    "ComposableNodeContainer": ("executable", "node_executable"),
    "ComposableNode": ("plugin", "node_plugin"),
    "ExecuteProcess": ("cmd",),
    "IncludeLaunchDescription": ("launch_description_source",),
}
"""The keywords of which each class requires one; the second one is of ROS Dashing."""
_POSITIONAL = frozenset({"IncludeLaunchDescription"})
"""The classes that accept the required argument without its keyword."""
_MODULES = ("launch.", "launch_ros.")


def report_incomplete_calls(pair: FilePair) -> None:
    """Report the actions without a required argument that only the new version has."""
    old, new = try_parse_version(pair, is_old=True), try_parse_version(pair)
    known = {source for source, _, _, _ in _find_incomplete_calls(old)}
    for source, name, keyword, span in _find_incomplete_calls(new):
        if source not in known:
            text = phrase("{function}() has no argument {name}", function=name, name=quoted_names([keyword]))
            pair.add(text, pair.location(span), phrase("the launch file fails"))


def _find_incomplete_calls(python: PythonFile | None) -> Iterator[tuple[str, str, str, Span]]:
    """Yield the source, the class, the missing keyword and the location of each call."""
    nodes = [] if python is None else list(ast.walk(python.tree))
    imports = [node for node in nodes if isinstance(node, ast.ImportFrom) and node.module]
    classes = {alias.asname or alias.name for node in imports if (node.module or "").startswith(_MODULES)
               for alias in node.names}  # fmt: skip
    for node in nodes:
        name = called_name(node) if isinstance(node, ast.Call) else ""
        if python is None or not isinstance(node, ast.Call) or name not in _REQUIRED or name not in classes:
            continue
        keywords = {keyword.arg for keyword in node.keywords}
        has_other = None in keywords or (bool(node.args) and (name in _POSITIONAL or _is_unpacked(node)))
        if keywords.isdisjoint(_REQUIRED[name]) and not has_other:
            yield ast.unparse(node), name, _REQUIRED[name][0], python.span(node)


def _is_unpacked(call: ast.Call) -> bool:
    return any(isinstance(argument, ast.Starred) for argument in call.args)
