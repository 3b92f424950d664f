"""Compare the modules that Python launch files import, and find imports that fail."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import Phrase, Span, joined_first, phrase
from linkwright.review.changes import MAX_NAMES, Change, Location
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.programs.missing import find_packages
from linkwright.review.required_packages import is_undeclared_and_new
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.sources.reading import try_parse
from linkwright.review.versions import Version, Versions

_LAUNCH_MODULES = frozenset({"ament_index_python", "launch", "launch_ros", "osrf_pycommon"})
"""The modules of the launch system, which every installation of ROS has."""

_ROS_MODULE = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)+|xacro")
"""The names of most packages of ROS, which projects of Python rarely have."""
_PYTHON_MODULES = frozenset({"pkg_resources", "typing_extensions"})
_PACKAGE_FILE = "__init__.py"
_GENERATED_MODULES = ("msg", "srv", "action")
"""The modules of a package that are generated from its interfaces."""


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
    known = {module for module, _ in _find_missing_modules(pair.versions.old, pair.old_path)}
    for module, span in _find_missing_modules(pair.versions.new, pair.new_path):
        if module not in known:
            pair.add(_describe_missing(module), pair.location(span), phrase("the launch file fails"))


def find_failing_imports(versions: Versions, path: str) -> Iterator[Change]:
    """Yield a line for each module that an added launch file imports in any case and that nothing provides."""
    imports = _read_imports(versions.new.file(path)) if path.endswith(PYTHON_SUFFIX) else None
    for module, (_, span) in (imports or {}).items():
        if _needs_package(versions, path, module):
            text = phrase("imports the package '{name}', which no package.xml names", name=module)
            yield Change(text, location=Location(path, span.line, span.column))
    for module, span in _find_missing_modules(versions.new, path) if imports else ():
        yield Change(_describe_missing(module), location=Location(path, span.line, span.column))


def _describe_missing(module: str) -> Phrase:
    package, _, name = module.partition(".")
    return phrase("imports '{name}', which the package '{package}' does not have", name=name, package=package)


def _find_missing_modules(version: Version, path: str) -> Iterator[tuple[str, Span]]:
    """Yield the modules that a launch file imports in any case from a Python package which certainly lacks them.

    The package is the one in the ROS package of the same name, whose build makes no modules.
    """
    python = try_parse(version.file(path))
    if python is None:
        return
    for node in python.tree.body:
        modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom) and not node.level:
            modules = [node.module or ""]
        for module in modules:
            package, *parts = module.split(".")
            owner = find_packages(version).get(package) if parts and parts[0] not in _GENERATED_MODULES else None
            folder = None if owner is None else version.file(owner.folder) / package
            if owner is None or folder is None or not (folder / _PACKAGE_FILE).is_file() or owner.may_generate:
                continue
            stems = {name.partition(".")[0] for name in owner.names}
            is_named = re.search(rf"\b{parts[-1]}\b", owner.build_text) is not None
            if not is_named and parts[-1] not in stems and not any(folder.parent.rglob(parts[-1])):
                yield module, python.span(node)


def _find_missing_reason(pair: FilePair, modules: Iterable[str]) -> Phrase | None:
    """Return the reason why a package is missing that the file imports in any case; None if none certainly is.

    Args:
        pair: both versions of the launch file.
        modules: the modules that only the new version imports.
    """
    for module in modules:
        if _needs_package(pair.versions, pair.new_path, module):
            return phrase("package.xml does not name '{name}', without which the launch file fails", name=module)
    return None


def _needs_package(versions: Versions, path: str, module: str) -> bool:
    """Return whether a launch file imports in any case a package that is certainly new and not declared."""
    if _ROS_MODULE.fullmatch(module) is None or module in _PYTHON_MODULES:
        return False
    always = re.search(rf"^(?:from|import)[ \t]+{module}\b", versions.new.text(path), re.MULTILINE)
    return (
        always is not None and not _has_module(versions.new, module) and is_undeclared_and_new(versions, path, module)
    )


def _has_module(version: Version, name: str) -> bool:
    """Return whether a repository has a module or a folder of modules with a name."""
    paths = map(PurePosixPath, version.paths((PYTHON_SUFFIX,)))
    return any(path.stem == name or name in path.parts for path in paths)


def _read_imports(path: Path) -> dict[str, tuple[str, Span]] | None:
    """Return the first import of each module and its location, by the first part of the name of the module.

    The result is None if the file cannot be read.
    """
    python = try_parse(path)
    if python is None:
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
