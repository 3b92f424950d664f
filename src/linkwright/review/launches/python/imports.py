"""Compare the modules that Python launch files import."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import Phrase, Span, joined_first, phrase
from linkwright.packages.readers.python_values import PythonFile
from linkwright.review.changes import MAX_NAMES
from linkwright.review.file_pair import FilePair
from linkwright.review.required_packages import is_undeclared_and_new
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.sources.reading import try_read_source
from linkwright.review.versions import Version

_LAUNCH_MODULES = frozenset({"ament_index_python", "launch", "launch_ros", "osrf_pycommon"})
"""The modules of the launch system, which every installation of ROS has."""

_ROS_MODULE = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)+|xacro")
"""The names of most packages of ROS, which projects of Python rarely have."""
_PYTHON_MODULES = frozenset({"pkg_resources", "typing_extensions"})


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
        location = pair.location(next(iter(imports.values())), is_old=is_old)
        if is_old:
            pair.add(phrase("imports removed: {imports}", imports=names), location)
        else:
            reason = _find_missing_reason(pair, [module for module in own if module not in other])
            pair.add(phrase("imports added: {imports}", imports=names), location, reason)


def _find_missing_reason(pair: FilePair, modules: Iterable[str]) -> Phrase | None:
    """Return the reason why a package is missing that the file imports in any case; None if none certainly is.

    Args:
        pair: both versions of the launch file.
        modules: the modules that only the new version imports.
    """
    source = try_read_source(pair.new_file)
    for module in modules:
        is_package = _ROS_MODULE.fullmatch(module) is not None and module not in _PYTHON_MODULES
        always = re.search(rf"^(?:from|import)[ \t]+{module}\b", source.text if source else "", re.MULTILINE)
        is_missing = is_package and always is not None and not _has_module(pair.versions.new, module)
        if is_missing and is_undeclared_and_new(pair.versions, pair.new_path, module):
            return phrase("package.xml does not name '{name}', without which the launch file fails", name=module)
    return None


def _has_module(version: Version, name: str) -> bool:
    """Return whether a repository has a module or a folder of modules with a name."""
    paths = map(PurePosixPath, version.paths((PYTHON_SUFFIX,)))
    return any(path.stem == name or name in path.parts for path in paths)


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
