"""Find the modules of the repository that a Python program runs."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from linkwright.review.caching import cached_in_review
from linkwright.review.launches.programs.default_names import find_package_folders, find_script
from linkwright.review.sources.names import CPP_SUFFIXES
from linkwright.review.sources.python.package_imports import PACKAGE_FILE
from linkwright.review.sources.python_names import parse_source
from linkwright.review.sources.reading import try_read_source
from linkwright.review.sources.shared_constants import find_own_module

_MAX_MODULES = 200


@cached_in_review(maxsize=256)
def find_program_modules(root: Path, program: str) -> tuple[Path, ...]:
    """Return the script of a Python program and the modules of the repository that it imports, also indirectly.

    The result is empty if the repository has no such script, or if a module cannot be read.

    Args:
        root: the folder of the repository.
        program: the package and the executable, such as ``arm/driver``.
    """
    script = find_script(root, program)
    if script is None or script.suffix in CPP_SUFFIXES:
        return ()
    found = {script.resolve(): None}
    pending = list(found)
    while pending:
        modules = _list_imported_modules(root, pending.pop())
        if modules is None or len(found) > _MAX_MODULES:
            return ()
        new = [module for module in modules if module not in found]
        found.update(dict.fromkeys(new))
        pending += new
    return tuple(found)


def _list_imported_modules(root: Path, path: Path) -> set[Path] | None:
    """Return the modules of the repository that a source imports, or None if it cannot be read."""
    source = try_read_source(path)
    try:
        tree = None if source is None else parse_source(source).tree
    except (SyntaxError, ValueError, RecursionError):
        return None
    if tree is None:
        return None
    modules = {_find_module(root, path, name, level) for name, level in _list_imports(tree)}
    return {module.resolve() for module in modules if module is not None}


def _list_imports(tree: ast.Module) -> Iterator[tuple[str, int]]:
    """Yield the name of each imported module, with the number of dots before it. A name may be that of a class."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name, 0) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            prefix = f"{node.module}." if node.module else ""
            yield node.module or "", node.level
            yield from ((f"{prefix}{alias.name}", node.level) for alias in node.names if alias.name != "*")


def _find_module(root: Path, path: Path, name: str, level: int) -> Path | None:
    """Return the file of a module of the package of a source, or of another package of the repository."""
    if not name and level:
        file = path.parents[level - 1] / PACKAGE_FILE if level <= len(path.parents) else None
        return file if file is not None and file.is_file() else None
    own = find_own_module(path, name, level)
    if own is not None or level:
        return own
    package = find_package_folders(root).get(name.partition(".")[0])
    return None if package is None else find_own_module(package / PACKAGE_FILE, name, 0)
