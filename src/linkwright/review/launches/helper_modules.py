"""Compare the functions and classes that a module with actions offers to launch files of other packages."""

from __future__ import annotations

import ast

from linkwright.diagnostics import Phrase, joined_first, phrase, quoted
from linkwright.packages.readers.python_values import PythonFile
from linkwright.review.changes import MAX_NAMES
from linkwright.review.file_pair import FilePair
from linkwright.review.installed_paths import find_module
from linkwright.review.launches.files import compare_launch_files
from linkwright.review.sources.details import compare_details
from linkwright.review.sources.names import NameKind
from linkwright.review.sources.reading import read_source_names, try_parse
from linkwright.review.versions import Version

_Definition = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef


def compare_launch_helpers(pair: FilePair) -> None:
    """Compare two versions of a Python module that makes actions for launch files."""
    compare_launch_files(pair)
    package = pair.versions.old.package_of(pair.old_path)
    if pair.is_lost or package is None or find_module(pair.versions.old, package, pair.old_path) is None:
        return
    old, new = try_parse(pair.old_file), try_parse(pair.new_file)
    if old is None or new is None:
        return
    left = _find_names(new)
    definitions = {node.name: node for node in new.tree.body if isinstance(node, _Definition)}
    old_names = _find_names(old)
    for node in old.tree.body:
        if not isinstance(node, _Definition) or node.name.startswith("_") or node.name in left:
            continue
        renamed = [name for name, other in definitions.items() if name not in old_names and _are_equal(node, other)]
        text = phrase("'{name}' removed", name=node.name)
        if len(renamed) == 1:
            text = phrase("'{old}' renamed to '{new}'", old=node.name, new=renamed[0])
        pair.add(text, pair.location(old.span(node), is_old=True), phrase("launch files that import it do not find it"))
    _compare_functions(pair)


def helper_contents(version: Version, path: str) -> Phrase | None:
    """Return the public functions and classes of a module, or None if it has none."""
    names = read_source_names(version.file(path))
    found = [item.name for kind in (NameKind.FUNCTION, NameKind.CLASS) for item in names.of_kind(kind)]
    return joined_first(map(quoted, found), MAX_NAMES) if found else None


def _compare_functions(pair: FilePair) -> None:
    """Report the functions and classes of a module that take other arguments or return another number of values."""
    old_names, new_names = read_source_names(pair.old_file), read_source_names(pair.new_file)
    for kind in (NameKind.FUNCTION, NameKind.CLASS):
        before = {item.name: item for item in old_names.of_kind(kind)}
        for item in new_names.of_kind(kind):
            changes = compare_details(before[item.name], item) if item.name in before else ()
            for text, reason, _ in changes:
                pair.add(text, pair.location(item.span), reason)


def _find_names(python: PythonFile) -> set[str]:
    """Return the names that other modules can import from a module."""
    names = {node.name for node in python.tree.body if isinstance(node, _Definition)}
    for node in ast.walk(python.tree):
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            names |= {alias.asname or alias.name for alias in node.names}
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
    return names


def _are_equal(old: _Definition, new: _Definition) -> bool:
    """Return whether two definitions differ in their names only."""
    return type(old) is type(new) and ast.unparse(old).replace(old.name, new.name) == ast.unparse(new)
