"""Find executables of ``setup.py`` files whose module or function is gone."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import SourceText, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.readers.setup_py import Program, SetupFile, read_setup
from linkwright.review.caching import cached_in_review
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.files.build.setup_files import SETUP_FILE
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.sources.python.undefined_names import find_bound_names
from linkwright.review.sources.python_names import parse_source
from linkwright.review.sources.reading import try_read_source
from linkwright.review.versions import Version, Versions

_DEFINITIONS = (ast.FunctionDef, ast.ClassDef)
_DYNAMIC_NAMES = frozenset({"__getattr__", "globals", "exec"})


def find_lost_entry_points(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the ``setup.py`` files that still name a removed module or function, each with a change.

    The comparison of a changed ``setup.py`` tells its removed modules.
    """
    changed = {file.new_path for file in changed_files}
    for file in changed_files:
        path = file.old_path
        if path is None or file.is_submodule or not path.endswith(PYTHON_SUFFIX):
            continue
        folder = versions.new.package_of(path)
        if folder is None:
            continue
        setup_path = (PurePosixPath(folder) / SETUP_FILE).as_posix()
        module = ".".join(PurePosixPath(path).relative_to(folder).with_suffix("").parts)
        old, new = (_read_setup(version, setup_path) for version in (versions.old, versions.new))
        old_names = {program.executable for program in old.entry_points if program.module == module}
        is_removed = not versions.new.file(path).is_file() and setup_path not in changed
        for program in new.entry_points:
            if program.module != module or program.executable not in old_names:
                continue
            names = {"name": program.executable}
            if is_removed:
                text = phrase("executable '{name}': its module '{module}' was removed", **names, module=module)
            elif path == file.new_path and _has_lost(versions, path, program):
                names["function"] = program.function or ""
                text = phrase("executable '{name}': its function '{function}' was removed", **names)
            else:
                continue
            location = Location(setup_path, program.span.line, program.span.column)
            yield setup_path, Change(text, Effect.BREAKING, phrase("the executable no longer starts"), location)


@cached_in_review(maxsize=64)
def _read_setup(version: Version, path: str) -> SetupFile:
    return read_setup(SourceText(str(version.file(path)), version.text(path)))


def _has_lost(versions: Versions, path: str, program: Program) -> bool:
    """Return whether only the old version of a module defines the function of a program.

    An import of all names of another package hardly brings a name that the module defined itself beside it.
    """
    name = (program.function or "").partition(".")[0]
    old, new = (_parse(version, path) for version in (versions.old, versions.new))
    if old is None or new is None or not any(isinstance(node, _DEFINITIONS) and node.name == name for node in old.body):
        return False
    bound, used = set(find_bound_names(new)), {node.id for node in ast.walk(new) if isinstance(node, ast.Name)}
    package = program.module.partition(".")[0]
    known = {ast.unparse(node) for node in old.body if isinstance(node, ast.ImportFrom)}
    may_import = any(
        isinstance(node, ast.ImportFrom)
        and node.names[0].name == "*"
        and (node.level or (node.module or "").partition(".")[0] == package or ast.unparse(node) not in known)
        for node in ast.walk(new)
    )
    return name not in bound and _DYNAMIC_NAMES.isdisjoint(bound | used) and not may_import


def _parse(version: Version, path: str) -> ast.Module | None:
    source = try_read_source(version.file(path))
    try:
        return None if source is None else parse_source(source).tree
    except (SyntaxError, ValueError, RecursionError):
        return None
