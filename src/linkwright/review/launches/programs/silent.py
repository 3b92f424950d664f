"""Find programs without topics, services and actions of their own, such as scripts that call a service once."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

from linkwright.review.caching import cached_in_review
from linkwright.review.launches.programs.modules import find_program_modules
from linkwright.review.sources.names import NameKind
from linkwright.review.sources.python_names import parse_source
from linkwright.review.sources.reading import read_source_names, try_read_source

_OFFERING_KINDS = frozenset(
    {
        NameKind.PUBLISHER,
        NameKind.SUBSCRIPTION,
        NameKind.SERVICE,
        NameKind.ACTION,
        NameKind.FRAME,
        NameKind.RECONFIGURATION,
        NameKind.ROUTE,
        NameKind.WEB_EVENT,
    }
)
_LIBRARIES = frozenset({"__future__", "numpy", "rclpy", "roslib", "rosparam", "rospy", "yaml"})
"""Modules that offer no names on their own."""
_INTERFACE_MODULES = ("msg", "srv", "action")


@cached_in_review(maxsize=256)
def offers_no_names(root: Path | None, program: str) -> bool:
    """Return whether a Python program of the repository certainly offers and subscribes to nothing.

    It uses no libraries that may.

    Args:
        root: the folder of the repository; None if it is unknown.
        program: the package and the executable, such as ``arm/calibrate.py``.
    """
    modules = () if root is None else find_program_modules(root, program)
    sources = [read_source_names(module) for module in modules]
    kinds = {item.kind for names in sources for item in (*names.names, *names.expressions)}
    makes_node = any(names.makes_node for names in sources)
    return (
        makes_node and kinds.isdisjoint(_OFFERING_KINDS) and all(_uses_only_known_libraries(path) for path in modules)
    )


def _uses_only_known_libraries(path: Path) -> bool:
    source = try_read_source(path)
    if source is None:
        return False
    for node in ast.walk(parse_source(source).tree):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom):
            names = [node.module or ""]
        for name in names:
            package, _, module = name.partition(".")
            is_known = package in _LIBRARIES or package in sys.stdlib_module_names
            if not is_known and module.partition(".")[0] not in _INTERFACE_MODULES:
                return False
    return True
