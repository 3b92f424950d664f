"""Compare the modules that Python launch files import."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

from linkwright.diagnostics import Span, joined_first, phrase
from linkwright.packages.readers.python_values import PythonFile
from linkwright.review.changes import MAX_NAMES
from linkwright.review.file_pair import FilePair
from linkwright.review.sources.reading import try_read_source

_LAUNCH_MODULES = frozenset({"ament_index_python", "launch", "launch_ros", "osrf_pycommon"})
"""The modules of the launch system, which every installation of ROS has."""


def compare_imports(pair: FilePair) -> None:
    """Report modules that only one version imports, except those of Python and of the launch system."""
    old, new = _read_imports(pair.old_file), _read_imports(pair.new_file)
    if old is None or new is None:
        return
    for own, other, is_old in ((new, old, False), (old, new, True)):
        imports = {text: span for module, (text, span) in own.items() if module not in other}
        if not imports:
            continue
        names = joined_first([f"'{text}'" for text in imports], MAX_NAMES)
        sentence = phrase("imports added: {imports}", imports=names)
        if is_old:
            sentence = phrase("imports removed: {imports}", imports=names)
        pair.add(sentence, pair.location(next(iter(imports.values())), is_old=is_old))


def _read_imports(path: Path) -> dict[str, tuple[str, Span]] | None:
    """Return the first import of each module and its location, by the first part of the name of the module.

    The result is None if the file cannot be read.
    """
    source = try_read_source(path)
    if source is None:
        return None
    try:
        python = PythonFile(source)
    except (SyntaxError, ValueError, RecursionError):
        return None
    imports: dict[str, tuple[str, Span]] = {}
    for node in ast.walk(python.tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and not node.level and node.module:
            names = [node.module]
        else:
            continue
        for name in names:
            module = name.partition(".")[0]
            if module not in _LAUNCH_MODULES and module not in sys.stdlib_module_names:
                imports.setdefault(module, (ast.unparse(node), python.span(node)))
    return imports
