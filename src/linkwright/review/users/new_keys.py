"""Find YAML files that lack a key which a Python program newly reads from each of their entries."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator, Sequence
from pathlib import PurePosixPath
from typing import NamedTuple

from linkwright.diagnostics import joined_first, phrase, quoted
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.readers.python_values import parse_python
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.yaml_values import read_yaml_text, read_yaml_values
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_YAML_SUFFIXES = (".yaml", ".yml")
_LOADING = ("yaml.load", "yaml.safe_load", "yaml.full_load")
_BRANCHES = (ast.If, ast.Try, ast.While, ast.IfExp, ast.BoolOp, ast.Match)
"""Statements and expressions that may leave out a part."""
_MIN_COMMON_KEYS = 2
"""The minimum number of keys that an entry has in common with what the program reads."""


class _Read(NamedTuple):
    """A read of a key that is certain for each entry, and the other keys that are read from the entry."""

    key: str
    others: frozenset[str]
    line: int
    column: int


def find_new_keys(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the programs that newly read a key, without which they fail, from YAML files that lack it."""
    for file in changed_files:
        if not (file.old_path and file.new_path and file.path.endswith(PYTHON_SUFFIX)) or file.is_submodule:
            continue
        old_text, new_text = versions.old.text(file.old_path), versions.new.text(file.new_path)
        if not TEST_FOLDERS.isdisjoint(PurePosixPath(file.path).parts) or not any(
            call in new_text for call in _LOADING
        ):
            continue
        reads = {read.key: read for read in reversed(_find_reads(new_text)) if read.key not in old_text}
        for read in reads.values():
            lacking = list(_find_lacking(versions.new, file.new_path, read)) if read.others else []
            if lacking:
                text = phrase(
                    "reads the key '{name}', which is missing in {files}",
                    name=read.key,
                    files=joined_first([quoted(item) for item in lacking], MAX_NAMES),
                )
                reason = phrase("the program fails with entries of YAML files that lack the key")
                location = Location(file.new_path, read.line, read.column)
                yield file.new_path, Change(text, Effect.BREAKING, reason, location)


def _find_reads(text: str) -> list[_Read]:
    """Return the reads of literal keys of a variable that no condition can leave out."""
    try:
        tree = parse_python(text)
    except (SyntaxError, ValueError, RecursionError):
        return []
    return [read for loop in ast.walk(tree) if isinstance(loop, ast.For) for read in _find_in_loop(loop)]


def _find_in_loop(loop: ast.For) -> Iterator[_Read]:
    if not isinstance(loop.target, ast.Name):
        return
    name = loop.target.id
    subscripts = [node for part in loop.body for node in ast.walk(part) if _get_key(node, name) is not None]
    keys = [_get_key(node, name) for node in subscripts]
    tested = {
        node.left.value
        for part in loop.body
        for node in ast.walk(part)
        if isinstance(node, ast.Compare)
        if isinstance(node.left, ast.Constant) and any(isinstance(item, (ast.In, ast.NotIn)) for item in node.ops)
    }
    for node in _find_certain(loop.body):
        key = _get_key(node, name)
        if key is not None and key not in tested and isinstance(node, ast.Subscript):
            others = frozenset(other for other in keys if other is not None and other != key)
            yield _Read(key, others, node.lineno, node.col_offset + 1)


def _get_key(node: ast.AST, name: str) -> str | None:
    """Return the literal key that an expression reads from a variable, or None."""
    if not isinstance(node, ast.Subscript) or not isinstance(node.ctx, ast.Load):
        return None
    is_of_name = isinstance(node.value, ast.Name) and node.value.id == name
    is_text = isinstance(node.slice, ast.Constant) and isinstance(node.slice.value, str)
    return str(node.slice.value) if is_of_name and is_text and isinstance(node.slice, ast.Constant) else None


def _find_certain(body: Sequence[ast.stmt]) -> Iterator[ast.AST]:
    """Yield the nodes of a block that run whenever the block does, up to a statement that may leave it."""
    for statement in body:
        if isinstance(statement, ast.If):
            yield from _walk_certain(statement.test)
        else:
            yield from _walk_certain(statement)
        if any(isinstance(node, (ast.Continue, ast.Break, ast.Return)) for node in ast.walk(statement)):
            return


def _walk_certain(node: ast.AST) -> Iterator[ast.AST]:
    if isinstance(node, (*_BRANCHES, ast.For, ast.FunctionDef, ast.Lambda)):
        return
    yield node
    for child in ast.iter_child_nodes(node):
        yield from _walk_certain(child)


def _find_lacking(version: Version, path: str, read: _Read) -> Iterator[str]:
    """Yield the YAML files of the package of a program that have entries like those it reads, without the key."""
    package = version.package_of(path)
    if package is None:
        return
    for other in version.paths(_YAML_SUFFIXES, package):
        text = version.text(other)
        if not any(key in text for key in read.others):
            continue
        entries = _read_entries(version, other)
        if any(read.key not in keys and len(keys & read.others) >= _MIN_COMMON_KEYS for keys in entries):
            yield other


def _read_entries(version: Version, path: str) -> Collection[set[str]]:
    """Return the keys of each entry of the lists in a YAML file."""
    try:
        values = read_yaml_values(read_yaml_text(version.file(path)))
    except (UnreadableFileError, OSError, ValueError, RecursionError):
        return ()
    entries: dict[str, set[str]] = {}
    for name in values:
        words = name.split(".")
        for number in range(1, len(words)):
            if words[number - 1].endswith("]"):
                entries.setdefault(".".join(words[:number]), set()).add(words[number].partition("[")[0])
    return entries.values()
