"""Report code with which a Python launch file fails: undefined names, and calls and indices of literals.

A built-in function in the place of an action fails as well.
"""

from __future__ import annotations

import ast
import builtins
from collections.abc import Iterator

from linkwright.diagnostics import SourceText, Span, phrase
from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.changes import Change, Location
from linkwright.review.file_pair import FilePair
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.sources.python.undefined_names import find_bound_names
from linkwright.review.sources.reading import read_source_names, try_read_source
from linkwright.review.versions import Version

_LITERALS = (ast.Tuple, ast.List, ast.Dict, ast.Set, ast.Constant, ast.JoinedStr, ast.ListComp, ast.DictComp)
"""The expressions that cannot be called."""
_LIST_CLASSES = ("LaunchDescription", "GroupAction")
"""The classes whose first argument is a list of actions."""


def report_undefined_names(pair: FilePair) -> None:
    """Report the undefined names, misplaced functions and called literals that only the new version has."""
    if pair.new_file.suffix != PYTHON_SUFFIX:
        return
    old, new = read_source_names(pair.old_file), read_source_names(pair.new_file)
    for name, span in new.undefined_names.items():
        if name in old.undefined_names:
            continue
        if name in old.bound_names - new.bound_names:
            text = phrase("uses '{name}', which it no longer defines or imports", name=name)
        else:
            text = phrase("uses '{name}', which it does not define or import", name=name)
        pair.add(text, pair.location(span), phrase("the code that uses the name fails"))
    if not any(_find_called_literals(try_read_source(pair.old_file))):
        for span in _find_called_literals(try_read_source(pair.new_file)):
            text = phrase("a comma is missing: an item of a list is called or indexed by the next one")
            pair.add(text, pair.location(span), phrase("the launch file fails"))
    known = {*old.bound_names, *(name for name, _ in _find_unbound_actions(try_read_source(pair.old_file)))}
    for name, span in _find_unbound_actions(try_read_source(pair.new_file)):
        if name not in known and callable(getattr(builtins, name, None)):
            text = phrase("the built-in function '{name}' is in a list of actions", name=name)
            pair.add(text, pair.location(span), phrase("the launch file fails"))


def find_undefined_names(version: Version, path: str) -> list[Change]:
    """Return a line for each name that an added launch file uses although nothing defines it."""
    if not path.endswith(PYTHON_SUFFIX):
        return []
    uses = read_source_names(version.file(path)).undefined_names
    return [
        Change(
            phrase("uses '{name}', which nothing defines", name=name),
            location=Location(path, span.line, span.column),
        )
        for name, span in uses.items()
    ]


def _find_unbound_actions(source: SourceText | None) -> Iterator[tuple[str, Span]]:
    """Yield the names in lists of actions that a file does not define.

    The lists are those that functions return, and those of descriptions.
    """
    python = _try_parse(source)
    if python is None:
        return
    bound_names = set(find_bound_names(python.tree))
    for node in ast.walk(python.tree):
        actions = None
        if isinstance(node, ast.Return):
            actions = node.value
        elif isinstance(node, ast.Call) and called_name(node).rpartition(".")[2] in _LIST_CLASSES:
            actions = next(iter(node.args), None)
        for item in actions.elts if isinstance(actions, ast.List) else ():
            if isinstance(item, ast.Name) and item.id not in bound_names:
                yield item.id, python.span(item)


def _find_called_literals(source: SourceText | None) -> Iterator[Span]:
    """Yield the literals that a file calls, or lists and texts that it indexes by several values or a text."""
    python = _try_parse(source)
    if python is None:
        return
    for node in ast.walk(python.tree):
        if isinstance(node, ast.Call) and isinstance(node.func, _LITERALS):
            yield python.span(node)
        elif isinstance(node, ast.Subscript) and isinstance(node.value, (ast.Tuple, ast.List, ast.Constant)):
            index = node.slice
            if isinstance(index, ast.Tuple) or (isinstance(index, ast.Constant) and isinstance(index.value, str)):
                yield python.span(node)


def _try_parse(source: SourceText | None) -> PythonFile | None:
    try:
        return None if source is None else PythonFile(source)
    except (SyntaxError, ValueError):
        return None
