"""Report Python launch files that start or stop naming the arguments of nodes as before ROS 2 Foxy."""

from __future__ import annotations

import ast

from linkwright.diagnostics import phrase, quoted_names
from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.outlines import NODE_CLASSES
from linkwright.review.launches.python.conditions import try_parse_version
from linkwright.review.launches.python.syntax import OLD_KEYWORDS


def report_old_keywords(pair: FilePair) -> None:
    """Report names such as ``node_executable`` if only one version has any.

    launch_ros has the new names since Foxy, and raises an error for the old ones since Galactic.
    """
    old, new = (_find_nodes(try_parse_version(pair, is_old=is_old)) for is_old in (True, False))
    old_names, new_names = ({word: call for call in calls for word in _list_old_keywords(call)} for calls in (old, new))
    if old_names and new and not new_names:
        text = phrase("no longer uses {names}, which ROS 2 Galactic and later refuse", names=quoted_names(old_names))
        pair.add(text, None)
    elif new_names and old and not old_names:
        text = phrase("uses {names}, which ROS 2 Galactic and later refuse", names=quoted_names(new_names))
        python = try_parse_version(pair)
        location = None if python is None else pair.location(python.span(next(iter(new_names.values()))))
        pair.add(text, location, phrase("the launch file fails in these distributions"))


def _find_nodes(python: PythonFile | None) -> list[ast.Call]:
    """Return the calls that make nodes."""
    nodes = [] if python is None else ast.walk(python.tree)
    calls = (node for node in nodes if isinstance(node, ast.Call))
    return [call for call in calls if called_name(call).rpartition(".")[2] in NODE_CLASSES]


def _list_old_keywords(call: ast.Call) -> list[str]:
    return [keyword.arg for keyword in call.keywords if keyword.arg in OLD_KEYWORDS]
