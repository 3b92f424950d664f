"""Find changed sources with new code that no compiler accepts, that always fails, or whose result is undefined."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, SourceText, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX
from linkwright.review.sources.python.subscripted_methods import find_subscripted_methods
from linkwright.review.sources.python_names import parse_source
from linkwright.review.sources.statements.broken_code import find_broken_code
from linkwright.review.sources.statements.missing_results import read_function_results
from linkwright.review.sources.unbuilt_sources import is_unbuilt
from linkwright.review.versions import TEST_FOLDERS, Versions


def find_faulty_code(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the changed sources whose new version has such code, and the old one does not, each with a change.

    It is not breaking in an added source, which has no users yet, unless it belongs to a package that was built before.
    """
    for file in changed_files:
        path = file.new_path
        if path is None or file.is_submodule or not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts):
            continue
        old_text = versions.old.text(file.old_path) if file.old_path else ""
        if path.endswith(CPP_SUFFIXES):
            text = versions.new.text(path)
            changes = [*_find_broken_code(versions, path, old_text, text), *_find_missing_results(path, old_text, text)]
        elif path.endswith(PYTHON_SUFFIX):
            changes = list(_find_subscripted(path, old_text, versions.new.text(path)))
        else:
            continue
        yield from ((path, change) for change in changes)


def _find_broken_code(versions: Versions, path: str, old_text: str, text: str) -> Iterator[Change]:
    found = find_broken_code(text)
    if found is None or find_broken_code(old_text) is not None:
        return
    package = versions.new.package_of(path)
    had_package = package is not None and versions.old.package_of(path) is not None
    is_built = had_package and not is_unbuilt(versions.new, package or "", path)
    reason = phrase("the package does not build") if is_built else None
    yield _make_change(found[0], reason, path, text, found[1])


def _find_missing_results(path: str, old_text: str, text: str) -> Iterator[Change]:
    new = read_function_results(text)
    missing = {key: item for key, item in new.items() if item.is_missing}
    old = read_function_results(old_text) if missing else {}
    for key, item in missing.items():
        if key not in old:
            sentence = phrase("function '{name}' returns no value of its type '{type}'", name=item.name, type=item.type)
            yield _make_change(sentence, None, path, text, item.start)
        elif not old[key].is_missing:
            sentence = phrase("function '{name}' no longer returns a value", name=item.name)
            yield _make_change(sentence, phrase("callers get an undefined value"), path, text, item.start)


def _find_subscripted(path: str, old_text: str, text: str) -> Iterator[Change]:
    before = {ast.unparse(node) for node in _parse_subscripted(old_text)}
    told: set[str] = set()
    for node in _parse_subscripted(text):
        code = ast.unparse(node)
        if code not in before | told:
            told.add(code)
            sentence = phrase("`{code}` has square brackets where a call has parentheses", code=code)
            reason = phrase("the code fails") if old_text else None
            location = Location(path, node.lineno, node.col_offset + 1)
            yield Change(sentence, Effect.CHANGED if reason is None else Effect.BREAKING, reason, location)


def _parse_subscripted(text: str) -> list[ast.Subscript]:
    try:
        return list(find_subscripted_methods(parse_source(SourceText("", text)).tree))
    except (SyntaxError, ValueError, RecursionError):
        return []


def _make_change(sentence: Phrase, reason: Phrase | None, path: str, text: str, offset: int) -> Change:
    location = Location(path, text.count("\n", 0, offset) + 1, offset - text.rfind("\n", 0, offset))
    return Change(sentence, Effect.CHANGED if reason is None else Effect.BREAKING, reason, location)
