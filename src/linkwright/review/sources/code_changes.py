"""Find functions whose code changes, even if no shared name changes."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from functools import lru_cache
from itertools import zip_longest
from typing import NamedTuple

from linkwright.diagnostics import Phrase, joined, joined_first, phrase
from linkwright.review.changes import MAX_NAMES, Change
from linkwright.review.sources.code import Code, Part
from linkwright.review.sources.names import SourceNames
from linkwright.review.sources.statements import statement_of
from linkwright.review.sources.tokens import cpp_tokens

_QUOTED = re.compile(r"'([^']+)'")
_LITERAL = re.compile("\"((?:\\\\.|[^\"\\\\])*)\"|'((?:\\\\.|[^'\\\\])*)'")
_VALUES = "values in {name}: {values}"
_MAX_COMPARED = 4_000_000
"""The maximum number of pairs of statements of a compared function."""


class CodeChange(NamedTuple):
    """The functions of a source whose code changes.

    Attributes:
        text: the names of the functions.
        line: the line of the first function.
        is_old: whether the line is in the old version.
    """

    text: Phrase
    line: int
    is_old: bool


def code_change(
    old: Code,
    new: Code,
    reported: Sequence[Change],
    has_moved: Callable[[str, Code], bool],
    names: SourceNames,
) -> CodeChange | None:
    """Return the changed functions of a source that no other line names; None if there are none.

    Without changed functions and other lines, the change names classes with changes outside of functions, or imports.

    Args:
        old: the code of the old version.
        new: the code of the new version.
        reported: the other lines about the source.
        has_moved: whether another source has a function of the given code, with the same code.
        names: the names in the new version.
    """
    lines = _ReportedLines(reported)
    removed = [name for name in old.functions if name not in new.functions and not has_moved(name, old)]
    added = [name for name in new.functions if name not in old.functions and not has_moved(name, new)]
    pairs = [(name, name) for name in new.functions if name in old.functions]
    renamed = []
    for old_name, new_name in _find_renamed(old, new, removed, added, lines):
        removed.remove(old_name)
        added.remove(new_name)
        is_same_name = _short_name(old_name) == _short_name(new_name)
        pairs += [(old_name, new_name)] if is_same_name else []
        renamed += [] if is_same_name else [(old_name, new_name)]
    changed = [
        pair for pair in pairs if lines.has_unreported_change(old.functions[pair[0]], new.functions[pair[1]], pair[1])
    ]
    removed, added = ([name for name in items if not lines.names(name)] for items in (removed, added))
    texts = []
    if changed:
        texts.append(
            phrase("code changed in {names}", names=_list_names(_with_topic(name, names) for _, name in changed))
        )
    if added:
        texts.append(phrase("code added: {names}", names=_list_names(_with_topic(name, names) for name in added)))
    if removed:
        texts.append(phrase("code removed: {names}", names=_list_names(f"'{name}()'" for name in removed)))
    if renamed:
        texts.append(phrase("code renamed: {names}", names=_list_names(f"'{a}()' -> '{b}()'" for a, b in renamed)))
    if texts:
        new_names = [*(name for _, name in changed), *added, *(name for _, name in renamed)]
        sides = (new, old) if new_names else (old, new)
        name = new_names[0] if new_names else removed[0]
        line = _first_line(sides[0].functions[name], sides[1].functions.get(name, ()))
        return CodeChange(joined(texts, "; "), line, is_old=not new_names)
    return None if reported else _other_change(old, new)


def _other_change(old: Code, new: Code) -> CodeChange | None:
    """Return the classes whose code changes outside of functions, or else the source; None if nothing changes there."""
    sides = ((phrase("code changed in {names}", names=""), new, old.others.keys() & new.others.keys()),
             (phrase("code added: {names}", names=""), new, new.others.keys() - old.others.keys()),
             (phrase("code removed: {names}", names=""), old, old.others.keys() - new.others.keys()))  # fmt: skip
    texts = []
    lines = []
    for text, code, names in sides:
        changed = [
            name
            for name in code.others
            if name in names and name and _part_texts(old.others.get(name, ())) != _part_texts(new.others.get(name, ()))
        ]
        if changed:
            texts.append(text.with_arguments(names=_list_names(f"'{name}'" for name in changed)))
            other = old if code is new else new
            lines.append((_first_line(code.others[changed[0]], other.others.get(changed[0], ())), code is old))
    if texts:
        return CodeChange(joined(texts, "; "), *lines[0])
    parts = new.others.get("", ())
    if parts and _part_texts(old.others.get("", ())) != _part_texts(parts):
        line = _first_line(parts, old.others.get("", ()))
        return CodeChange(phrase("code changed outside of functions"), line, is_old=False)
    return _import_change(old.imports, new.imports)


def _import_change(old: Sequence[Part], new: Sequence[Part]) -> CodeChange | None:
    """Return the imports that only one version of a source has, or None if the imports are equal."""
    before, after = set(_part_texts(old)), set(_part_texts(new))
    removed = [part for part in old if part.text not in after]
    added = [part for part in new if part.text not in before]
    texts = []
    if added:
        texts.append(phrase("imports added: {imports}", imports=_list_names(f"'{part.text}'" for part in added)))
    if removed:
        texts.append(phrase("imports removed: {imports}", imports=_list_names(f"'{part.text}'" for part in removed)))
    return CodeChange(joined(texts, "; "), (added or removed)[0].first, is_old=not added) if texts else None


def _first_line(parts: Sequence[Part], others: Sequence[Part]) -> int:
    """Return the line of the first statement that differs from the other version."""
    pairs = zip_longest(parts, others)
    return next(
        (part.first for part, other in pairs if part and (not other or part.text != other.text)), parts[-1].last
    )


def _list_names(names: Iterable[str]) -> Phrase:
    return joined_first(names, MAX_NAMES)


def _part_texts(parts: Sequence[Part]) -> list[str]:
    return [part.text for part in parts]


def _short_name(name: str) -> str:
    return re.split(r"\.|::", name)[-1]


def _find_renamed(
    old: Code, new: Code, removed: Sequence[str], added: Sequence[str], lines: _ReportedLines
) -> list[tuple[str, str]]:
    """Return the old and new names of renamed functions: their code is equal, or their class was renamed."""
    pairs = []
    rest = list(added)
    for name in removed:
        scope, short = name[: -len(_short_name(name))], _short_name(name)
        same = [candidate for candidate in rest if old.body(name) and old.body(name) == new.body(candidate)]
        is_class_removed = bool(scope) and not any(candidate.startswith(scope) for candidate in new.functions)
        moved = [
            candidate
            for candidate in rest
            if is_class_removed
            and _short_name(candidate) == short
            and (not lines.names(candidate) or lines.renames(name, candidate))
            and not any(other.startswith(candidate[: -len(short)] or candidate) for other in old.functions)
        ]
        best = next((candidate for candidate in [*same, *moved] if _short_name(candidate) == short), None) or next(
            iter(same), None
        )
        if best is not None:
            pairs.append((name, best))
            rest.remove(best)
    return pairs


def _with_topic(name: str, names: SourceNames) -> str:
    """Return the name of a function with the topic, service or action that calls it."""
    found = names.callbacks.get(_short_name(name))
    if found is None:
        return f"'{name}()'"
    kind, topic = found
    if kind is None:
        return phrase("'{name}()' (callback of a timer)", name=name)
    return phrase("'{name}()' (callback of {kind} '{topic}')", name=name, kind=kind.title, topic=topic)


class _ReportedLines:
    """The other lines that are reported about a source.

    Args:
        changes: the changes that the lines report.
    """

    def __init__(self, changes: Sequence[Change]) -> None:
        self._names = {name for change in changes for name in _QUOTED.findall(str(change.sentence))}
        self._text = "\n".join(str(change.sentence) for change in changes)
        self._functions = {
            str(change.sentence.arguments["name"]) for change in changes if change.sentence.template == _VALUES
        }
        self._lines: Mapping[bool, Collection[int]] = {
            is_old: {change.location.line for change in changes if change.location and change.location.is_old == is_old}
            for is_old in (True, False)
        }

    def names(self, function: str) -> bool:
        """Return whether a line names a function or its class."""
        return any(scope in self._names for scope in _enclosing_scopes(function))

    def renames(self, old: str, new: str) -> bool:
        """Return whether a line reports that the class of a function was renamed."""
        pairs = zip(_enclosing_scopes(old), _enclosing_scopes(new), strict=False)
        patterns = (rf"'{re.escape(a)}'[^'\n]* renamed to '{re.escape(b)}'" for a, b in pairs)
        return any(re.search(pattern, self._text) for pattern in patterns)

    def has_unreported_change(self, old: Sequence[Part], new: Sequence[Part], name: str) -> bool:
        """Return whether the code of a function differs in anything that other lines do not report."""
        if re.search(rf"'{_constructor_class(name)}': .*\(", self._text):
            old, new = old[1:], new[1:]  # a line has the arguments of the constructor
        before, after = _part_texts(old), _part_texts(new)
        if before == after:
            return False
        if len(before) * len(after) > _MAX_COMPARED:
            return True
        has_values = name in self._functions
        matcher = SequenceMatcher(None, before, after, autojunk=False)
        return any(
            not self._reports(old[old_start:old_end], new[new_start:new_end], has_values=has_values)
            for tag, old_start, old_end, new_start, new_end in matcher.get_opcodes()
            if tag != "equal"
        )

    def _reports(self, old: Sequence[Part], new: Sequence[Part], *, has_values: bool) -> bool:
        for parts, is_old in ((old, True), (new, False)):
            if any(part.first <= line <= part.last for part in parts for line in self._lines[is_old]):
                return True
            literals = {text for part in parts for match in _LITERAL.finditer(part.text) for text in match.groups()}
            if not literals.isdisjoint(self._names):
                return True
        return has_values and [_statement_shape(part.text) for part in old] == [
            _statement_shape(part.text) for part in new
        ]


def _constructor_class(name: str) -> str:
    """Return the class of a constructor; for other functions, a text that cannot be a class name."""
    parts = re.split(r"\.|::", name)
    return re.escape(parts[-2]) if len(parts) > 1 and parts[-1] == "__init__" else "-"


@lru_cache(maxsize=4096)
def _statement_shape(text: str) -> str:
    """Return the text of a statement with marks for its literals."""
    return statement_of(cpp_tokens(text)).shape


def _enclosing_scopes(name: str) -> Iterator[str]:
    """Yield a name and the names of the enclosing classes."""
    parts = re.split(r"(\.|::)", name)
    for end in range(len(parts), 0, -2):
        yield "".join(parts[:end])
    yield parts[-1]
