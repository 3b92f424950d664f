"""The functions of a source whose code changes, also if no name that others use does."""

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
"""The number of pairs of statements up to which the statements of a function are compared."""


class CodeChange(NamedTuple):
    """The functions of a source whose code changes.

    Attributes:
        text: the functions.
        line: the line of the first one.
        is_old: whether this is a line of the old version.
    """

    text: Phrase
    line: int
    is_old: bool


def code_change(
    old: Code,
    new: Code,
    told: Sequence[Change],
    has_moved: Callable[[str, Code], bool],
    names: SourceNames,
) -> CodeChange | None:
    """Return the functions of a source that change, and are not named by other lines; None if there are none.

    If there are none, and no other lines, they are the classes whose code changes outside of functions, or the imports.

    Args:
        old: the old code.
        new: the new code.
        told: the other lines about the source.
        has_moved: whether another source has a function of one of these versions, with the same code.
        names: the names in the new version.
    """
    lines = _Told(told)
    removed = [name for name in old.functions if name not in new.functions and not has_moved(name, old)]
    added = [name for name in new.functions if name not in old.functions and not has_moved(name, new)]
    pairs = [(name, name) for name in new.functions if name in old.functions]
    renamed = []
    for old_name, new_name in _renamed(old, new, removed, added, lines):
        removed.remove(old_name)
        added.remove(new_name)
        is_same_name = _short(old_name) == _short(new_name)
        pairs += [(old_name, new_name)] if is_same_name else []
        renamed += [] if is_same_name else [(old_name, new_name)]
    changed = [pair for pair in pairs if lines.leaves(old.functions[pair[0]], new.functions[pair[1]], pair[1])]
    removed, added = ([name for name in items if not lines.names(name)] for items in (removed, added))
    texts = []
    if changed:
        texts.append(phrase("code changed in {names}", names=_listed(_with_topic(name, names) for _, name in changed)))
    if added:
        texts.append(phrase("code added: {names}", names=_listed(_with_topic(name, names) for name in added)))
    if removed:
        texts.append(phrase("code removed: {names}", names=_listed(f"'{name}()'" for name in removed)))
    if renamed:
        texts.append(phrase("code renamed: {names}", names=_listed(f"'{a}()' -> '{b}()'" for a, b in renamed)))
    if texts:
        new_names = [*(name for _, name in changed), *added, *(name for _, name in renamed)]
        sides = (new, old) if new_names else (old, new)
        name = new_names[0] if new_names else removed[0]
        line = _first_line(sides[0].functions[name], sides[1].functions.get(name, ()))
        return CodeChange(joined(texts, "; "), line, is_old=not new_names)
    return None if told else _other_change(old, new)


def _other_change(old: Code, new: Code) -> CodeChange | None:
    """Return the classes, or else the source, whose code changes outside of functions, or None."""
    sides = ((phrase("code changed in {names}", names=""), new, old.others.keys() & new.others.keys()),
             (phrase("code added: {names}", names=""), new, new.others.keys() - old.others.keys()),
             (phrase("code removed: {names}", names=""), old, old.others.keys() - new.others.keys()))  # fmt: skip
    texts = []
    lines = []
    for text, code, names in sides:
        changed = [
            name
            for name in code.others
            if name in names and name and _texts(old.others.get(name, ())) != _texts(new.others.get(name, ()))
        ]
        if changed:
            texts.append(text.with_arguments(names=_listed(f"'{name}'" for name in changed)))
            other = old if code is new else new
            lines.append((_first_line(code.others[changed[0]], other.others.get(changed[0], ())), code is old))
    if texts:
        return CodeChange(joined(texts, "; "), *lines[0])
    parts = new.others.get("", ())
    if parts and _texts(old.others.get("", ())) != _texts(parts):
        line = _first_line(parts, old.others.get("", ()))
        return CodeChange(phrase("code changed outside of functions"), line, is_old=False)
    return _import_change(old.imports, new.imports)


def _import_change(old: Sequence[Part], new: Sequence[Part]) -> CodeChange | None:
    """Return the imports that only one version of a source has, or None if both have the same."""
    before, after = set(_texts(old)), set(_texts(new))
    removed = [part for part in old if part.text not in after]
    added = [part for part in new if part.text not in before]
    texts = []
    if added:
        texts.append(phrase("imports added: {imports}", imports=_listed(f"'{part.text}'" for part in added)))
    if removed:
        texts.append(phrase("imports removed: {imports}", imports=_listed(f"'{part.text}'" for part in removed)))
    return CodeChange(joined(texts, "; "), (added or removed)[0].first, is_old=not added) if texts else None


def _first_line(parts: Sequence[Part], others: Sequence[Part]) -> int:
    """Return the line of the first statement that differs from that of the other version."""
    pairs = zip_longest(parts, others)
    return next(
        (part.first for part, other in pairs if part and (not other or part.text != other.text)), parts[-1].last
    )


def _listed(names: Iterable[str]) -> Phrase:
    return joined_first(names, MAX_NAMES)


def _texts(parts: Sequence[Part]) -> list[str]:
    return [part.text for part in parts]


def _short(name: str) -> str:
    return re.split(r"\.|::", name)[-1]


def _renamed(old: Code, new: Code, removed: Sequence[str], added: Sequence[str], lines: _Told) -> list[tuple[str, str]]:
    """Return the functions with the same code and another name, and those of a class with another name."""
    pairs = []
    rest = list(added)
    for name in removed:
        scope, short = name[: -len(_short(name))], _short(name)
        same = [each for each in rest if old.body(name) and old.body(name) == new.body(each)]
        is_class_gone = bool(scope) and not any(each.startswith(scope) for each in new.functions)
        moved = [
            each
            for each in rest
            if is_class_gone
            and _short(each) == short
            and (not lines.names(each) or lines.renames(name, each))
            and not any(other.startswith(each[: -len(short)] or each) for other in old.functions)
        ]
        best = next((each for each in [*same, *moved] if _short(each) == short), None) or next(iter(same), None)
        if best is not None:
            pairs.append((name, best))
            rest.remove(best)
    return pairs


def _with_topic(name: str, names: SourceNames) -> str:
    """Return the name of a function, with the topic, service or action that calls it."""
    found = names.callbacks.get(_short(name))
    if found is None:
        return f"'{name}()'"
    kind, topic = found
    if kind is None:
        return phrase("'{name}()' (callback of a timer)", name=name)
    return phrase("'{name}()' (callback of {kind} '{topic}')", name=name, kind=kind.title, topic=topic)


class _Told:
    """The other lines about a source.

    Args:
        changes: the lines.
    """

    def __init__(self, changes: Sequence[Change]) -> None:
        self._names = {name for change in changes for name in _QUOTED.findall(str(change.sentence))}
        self._text = "\n".join(str(change.sentence) for change in changes)
        self._functions = {
            str(change.sentence.arguments["name"]) for change in changes if change.sentence.template == _VALUES
        }
        self._lines: Mapping[bool, Collection[int]] = {
            is_old: {each.location.line for each in changes if each.location and each.location.is_old == is_old}
            for is_old in (True, False)
        }

    def names(self, function: str) -> bool:
        """Return whether a line names a function, or its class."""
        return any(each in self._names for each in _scopes(function))

    def renames(self, old: str, new: str) -> bool:
        """Return whether a line tells that the class of a function has another name."""
        pairs = zip(_scopes(old), _scopes(new), strict=False)
        patterns = (rf"'{re.escape(a)}'[^'\n]* renamed to '{re.escape(b)}'" for a, b in pairs)
        return any(re.search(pattern, self._text) for pattern in patterns)

    def leaves(self, old: Sequence[Part], new: Sequence[Part], name: str) -> bool:
        """Return whether the code of a function differs, and not only in what other lines tell."""
        if re.search(rf"'{_class(name)}': .*\(", self._text):
            old, new = old[1:], new[1:]  # a line has the arguments of the constructor
        before, after = _texts(old), _texts(new)
        if before == after:
            return False
        if len(before) * len(after) > _MAX_COMPARED:
            return True
        has_values = name in self._functions
        matcher = SequenceMatcher(None, before, after, autojunk=False)
        return any(
            not self._tells(old[old_start:old_end], new[new_start:new_end], has_values=has_values)
            for tag, old_start, old_end, new_start, new_end in matcher.get_opcodes()
            if tag != "equal"
        )

    def _tells(self, old: Sequence[Part], new: Sequence[Part], *, has_values: bool) -> bool:
        for parts, is_old in ((old, True), (new, False)):
            if any(part.first <= line <= part.last for part in parts for line in self._lines[is_old]):
                return True
            literals = {text for part in parts for match in _LITERAL.finditer(part.text) for text in match.groups()}
            if not literals.isdisjoint(self._names):
                return True
        return has_values and [_shape(part.text) for part in old] == [_shape(part.text) for part in new]


def _class(name: str) -> str:
    """Return the class of a constructor, or a text that no class is for another function."""
    parts = re.split(r"\.|::", name)
    return re.escape(parts[-2]) if len(parts) > 1 and parts[-1] == "__init__" else "-"


@lru_cache(maxsize=4096)
def _shape(text: str) -> str:
    """Return the text of a statement with marks for its literals."""
    return statement_of(cpp_tokens(text)).shape


def _scopes(name: str) -> Iterator[str]:
    """Yield a name, and those of the classes that it is in."""
    parts = re.split(r"(\.|::)", name)
    for end in range(len(parts), 0, -2):
        yield "".join(parts[:end])
    yield parts[-1]
