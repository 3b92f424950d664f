"""Find conditions under which launch files newly fail, because a function of their package raises an error."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import joined_first, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.sources.reading import read_source_names, try_parse_versions, try_read_source
from linkwright.review.sources.shared_constants import find_own_module
from linkwright.review.sources.statements.code import read_code
from linkwright.review.sources.statements.new_failures import FailureSide
from linkwright.review.texts.excerpts import shorten
from linkwright.review.versions import Versions

_FILE_TEST = re.compile(r"\b(?:exists|isfile|is_file|isdir|is_dir)\b")
"""A test of a file, which mostly exists."""
_MAX_CHARACTERS = 80


def find_helper_failures(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the launch files in Python that newly call a function of their package which raises an error."""
    for file in changed_files:
        is_launch = file.path.endswith(PYTHON_SUFFIX) and is_launch_file_name(PurePosixPath(file.path).name)
        if not is_launch or file.old_path is None or file.new_path is None or file.is_submodule:
            continue
        path = versions.new.file(file.new_path)
        parsed = try_parse_versions(versions.old.file(file.old_path), path)
        if parsed is None:
            continue
        old, new = parsed
        known = {name for name, _ in _list_calls(old)}
        called = {name: call for name, call in _list_calls(new) if name not in known}
        for module in _list_modules(path, new) if called else ():
            conditions = _find_conditions(module, called)
            if conditions:
                shown = joined_first([f"`{shorten(item, _MAX_CHARACTERS)}`" for item in conditions], MAX_NAMES)
                text = phrase("'{file}' raises errors now if {conditions}", file=module.name, conditions=shown)
                span = new.span(next(iter(conditions.values())))
                reason = phrase("values for which this holds stop the launch")
                location = Location(file.new_path, span.line, span.column)
                yield file.new_path, Change(text, Effect.BREAKING, reason, location)


def _list_calls(python: PythonFile) -> Iterator[tuple[str, ast.Call]]:
    """Yield the calls with the last names of the functions."""
    for node in ast.walk(python.tree):
        if isinstance(node, ast.Call):
            yield called_name(node).rpartition(".")[2], node


def _list_modules(path: Path, python: PythonFile) -> list[Path]:
    """Return the modules of the package from which a launch file imports names."""
    imports = (node for node in ast.walk(python.tree) if isinstance(node, ast.ImportFrom))
    files = (find_own_module(path, node.module or "", node.level) for node in imports)
    return [file for file in dict.fromkeys(files) if file is not None]


def _find_conditions(module: Path, called: Mapping[str, ast.Call]) -> dict[str, ast.Call]:
    """Return the conditions under which called functions of a module raise an error, each with the call."""
    source = try_read_source(module)
    if source is None:
        return {}
    side = FailureSide(read_code(source), read_source_names(module), source.text, is_cpp=False)
    return {
        failure.condition: called[name]
        for function, failures in side.failures.items()
        if (name := function.rpartition(".")[2]) in called
        for failure in failures
        if not _FILE_TEST.search(failure.condition)
    }
