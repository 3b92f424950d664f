"""Find functions whose code changes, even if no shared name changes."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from itertools import zip_longest
from typing import NamedTuple

from linkwright.diagnostics import Phrase, joined, joined_first, phrase
from linkwright.review.caching import cached_in_review
from linkwright.review.changes import MAX_NAMES, Change
from linkwright.review.sources.names import SourceNames
from linkwright.review.sources.statements.class_members import format_changed_class
from linkwright.review.sources.statements.code import Code, Part
from linkwright.review.sources.statements.literals import normalize_number, parse_statement
from linkwright.review.sources.statements.operator_changes import differ_by_operator
from linkwright.review.sources.statements.tokens import tokenize_cpp

_QUOTED = re.compile(r"'([^']+)'")
_LITERAL = re.compile("\"((?:\\\\.|[^\"\\\\])*)\"|'((?:\\\\.|[^'\\\\])*)'")
_CALL = re.compile(r"(\w+)\s*\(")
_NUMBER_PAIR = re.compile(r"(?<![\w.])(-?\.?\d[\w.]*) -> (-?\.?\d[\w.]*)(?![\w.])")
_SPACE = re.compile(r"[^\S\n]")
_ASSIGNMENT = re.compile(r"(\w+)\s*=\s*([^=;].*?)\s*;?\s*\Z", re.DOTALL)
_PLAIN_CODE = re.compile(r"[\W\d]*\w+ = [^(]*|[\W\d]*(?:if|try|with|else)\b.*", re.DOTALL)
"""Assignments of literals, and the heads of statements other than loops."""
_VALUES = "values in {name}: {values}"
_MODULE_VALUES = "values: {values}"
_STATEMENTS = "in {function}: {changes}"
_MAX_COMPARED_PAIRS = 4_000_000
"""The maximum number of pairs of statements of a compared function."""
_MIN_STATEMENTS = 2
"""The minimum number of statements outside of functions of an added program that a line reports."""
_MAX_NAMESPACES = 8
"""The maximum number of words of a name whose parts are compared with the texts of statements."""


class CodeChange(NamedTuple):
    """A change of the code of a source.

    Attributes:
        text: the names of functions, or one of them with its changed statements or attributes.
        line: the first changed line.
        is_old: whether the line is in the old version.
    """

    text: Phrase
    line: int
    is_old: bool


def find_code_change(
    old: Code,
    new: Code,
    reported: Sequence[Change],
    has_moved: Callable[[str, Code], bool],
    names: SourceNames,
    renamed_classes: Mapping[str, str],
    describe_outside: Callable[[], Phrase | None],
) -> CodeChange | None:
    """Return the changed functions that no other line names, or None.

    If nothing else is reported, the change names classes whose code outside of functions changes, or imports. Beside
    changed functions, it tells whether the code outside of functions changes in more than other lines report. So it
    does if values in that code, or statements of functions, are reported.

    Args:
        old: the code of the old version. Renamed classes have their new names.
        new: the code of the new version.
        reported: the other lines about the source.
        has_moved: whether a different source has a function with the same name and code.
        names: the names in the new version.
        renamed_classes: the new names of the renamed classes, by their old names.
        describe_outside: returns the few statements outside of functions that differ, or None.
    """
    lines = ReportedLines(reported)
    removed = [name for name in old.functions if name not in new.functions and not has_moved(name, old)]
    added = [name for name in new.functions if name not in old.functions and not has_moved(name, new)]
    pairs = [(name, name) for name in new.functions if name in old.functions]
    renamed = []
    for old_name, new_name in _find_renamed(old, new, removed, added, lines):
        removed.remove(old_name)
        added.remove(new_name)
        is_same_name = _get_short_name(old_name) == _get_short_name(new_name)
        pairs += [(old_name, new_name)] if is_same_name else []
        renamed += [] if is_same_name else [(old_name, new_name)]
    changed = [
        pair
        for pair in pairs
        if str(format_function(pair[1], names)) not in lines.shown_functions
        and lines.has_unreported_change(old.functions[pair[0]], new.functions[pair[1]], pair[1])
    ]
    removed, added = ([name for name in items if not lines.mentions(name)] for items in (removed, added))
    classes = {name: other for name, other in renamed_classes.items() if not lines.renames(name, other)}
    texts = _format_functions(changed, added, removed, _list_renamed(classes, renamed), names)
    if texts:
        if _has_other_changes(old, new, lines):
            texts.append(_format_outside(describe_outside))
        new_names = [*(name for _, name in changed), *added, *(name for _, name in renamed)]
        if not new_names and classes:
            return CodeChange(joined(texts, "; "), _find_class_line(new, next(iter(classes.values()))), is_old=False)
        sides = (new, old) if new_names else (old, new)
        name = new_names[0] if new_names else removed[0]
        line = _find_first_line(sides[0].functions[name], sides[1].functions.get(name, ()))
        return CodeChange(joined(texts, "; "), line, is_old=not new_names)
    if reported:
        parts = old.outside.get("", ()), new.outside.get("", ())
        is_unreported = lines.has_module_values and lines.has_unreported_change(*parts, "")
        is_unreported |= bool(lines.shown_functions and _has_other_changes(old, new, lines))
        return _find_module_change(*parts, describe_outside) if is_unreported else None
    return _find_outside_change(old, new, describe_outside)


def find_added_code(
    new: Code, reported: Sequence[Change], has_moved: Callable[[str, Code], bool], names: SourceNames
) -> CodeChange | None:
    """Return the functions of an added program that no other line names, or None.

    The change also tells whether a program in Python has code outside of functions that does more than call them. A
    function ``main`` alone is not worth a line beside others.

    Args:
        new: the code of the program.
        reported: the other lines about the source.
        has_moved: whether a different source had a function with the same name and code.
        names: the names in the program.
    """
    lines = ReportedLines(reported)
    added = [name for name in new.functions if not lines.mentions(name) and not has_moved(name, new)]
    texts = _format_functions([], added, [], [], names)
    own_names = {_get_short_name(name) for name in (*new.functions, *new.outside)}
    statements = [
        part for part in _without_calls(new.outside.get("", ()), own_names) if not _PLAIN_CODE.fullmatch(part.text)
    ]
    unreported = [part for part in statements if lines.has_unreported_change((), [part], "")]
    if new.imports and len(unreported) >= _MIN_STATEMENTS:
        texts.append(phrase("code added outside of functions"))
    if not texts or (reported and added == ["main"] and len(texts) == 1):
        return None
    first = new.functions[added[0]] if added else unreported
    return CodeChange(joined(texts, "; "), first[0].first_line, is_old=False)


def _format_functions(
    changed: Sequence[tuple[str, str]],
    added: Sequence[str],
    removed: Sequence[str],
    renamed: Sequence[tuple[str, str]],
    names: SourceNames,
) -> list[Phrase]:
    """Return a text for each kind of change to functions.

    Changed functions, and renamed classes and functions, are pairs of names.
    """
    texts = []
    if changed:
        texts.append(
            phrase("code changed in {names}", names=_join_names(format_function(name, names) for _, name in changed))
        )
    if added:
        texts.append(phrase("code added: {names}", names=_join_names(format_function(name, names) for name in added)))
    if removed:
        texts.append(phrase("code removed: {names}", names=_join_names(f"'{name}()'" for name in removed)))
    if renamed:
        texts.append(phrase("code renamed: {names}", names=_join_names(f"'{old}' -> '{new}'" for old, new in renamed)))
    return texts


def _list_renamed(classes: Mapping[str, str], functions: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return the old and new names of classes, and of functions with parentheses."""
    return [*classes.items(), *((f"{old}()", f"{new}()") for old, new in functions)]


def _format_outside(describe_outside: Callable[[], Phrase | None]) -> Phrase:
    """Return the text for changed code outside of functions."""
    return describe_outside() or phrase("code changed outside of functions")


def _has_other_changes(old: Code, new: Code, lines: ReportedLines) -> bool:
    """Return whether the code outside of functions changes in more than other lines report."""
    names = old.functions.keys() | new.functions.keys()
    changed = {
        name
        for name in names
        if _get_texts(old.functions.get(name, ())[:1]) != _get_texts(new.functions.get(name, ())[:1])
    }
    short_names = {_get_short_name(name) for name in changed}
    before, after = (_without_calls(code.outside.get("", ()), short_names) for code in (old, new))
    return lines.has_unreported_change(before, after, "")


def _without_calls(parts: Sequence[Part], functions: set[str]) -> list[Part]:
    """Return the statements that neither call nor declare one of the functions."""
    return [part for part in parts if functions.isdisjoint(_CALL.findall(part.text))]


def _find_outside_change(old: Code, new: Code, describe_outside: Callable[[], Phrase | None]) -> CodeChange | None:
    """Return the classes whose code changes outside of functions, or None.

    If no class changes, the result tells whether the source changes outside of classes.
    """
    sides = ((phrase("code changed in {names}", names=""), new, old.outside.keys() & new.outside.keys()),
             (phrase("code added: {names}", names=""), new, new.outside.keys() - old.outside.keys()),
             (phrase("code removed: {names}", names=""), old, old.outside.keys() - new.outside.keys()))  # fmt: skip
    texts = []
    lines = []
    for text, code, names in sides:
        changed = [
            name
            for name in code.outside
            if name in names and name and _get_texts(old.outside.get(name, ())) != _get_texts(new.outside.get(name, ()))
        ]
        if changed:
            formatted = [
                format_changed_class(name, *(_get_texts(side.outside.get(name, ())) for side in (old, new)))
                if name in old.outside.keys() & new.outside.keys()
                else f"'{name}'"
                for name in changed
            ]
            texts.append(text.with_arguments(names=joined_first(formatted, MAX_NAMES)))
            other = old if code is new else new
            lines.append(
                (
                    _find_first_line(code.outside[changed[0]], other.outside.get(changed[0], ())),
                    code is old,
                )
            )
    if texts:
        return CodeChange(joined(texts, "; "), *lines[0])
    module_change = _find_module_change(old.outside.get("", ()), new.outside.get("", ()), describe_outside)
    return module_change or _compare_imports(old.imports, new.imports)


def _find_module_change(
    old: Sequence[Part], new: Sequence[Part], describe_outside: Callable[[], Phrase | None]
) -> CodeChange | None:
    """Return the change in the statements outside of functions and classes, or None if they are equal."""
    if _get_texts(old) == _get_texts(new):
        return None
    line = _find_first_line(new, old) if new else _find_first_line(old, new)
    return CodeChange(_format_outside(describe_outside), line, is_old=not new)


def _compare_imports(old: Sequence[Part], new: Sequence[Part]) -> CodeChange | None:
    """Return the imports that only one version has, or None if the imports are equal."""
    before, after = set(_get_texts(old)), set(_get_texts(new))
    removed = [part for part in old if part.text not in after]
    added = [part for part in new if part.text not in before]
    texts = []
    if added:
        texts.append(phrase("imports added: {imports}", imports=_join_imports(added)))
    if removed:
        texts.append(phrase("imports removed: {imports}", imports=_join_imports(removed)))
    return CodeChange(joined(texts, "; "), (added or removed)[0].first_line, is_old=not added) if texts else None


def _join_imports(parts: Sequence[Part]) -> Phrase:
    """Return imports of single names, in which the names of one module are one import."""
    groups: dict[str, list[str]] = {}
    for part in parts:
        module, _, name = part.text.rpartition(" import ")
        groups.setdefault(module or part.text, []).append(name)
    return _join_names(
        f"'{module} import {', '.join(names)}'" if module.startswith("from ") else f"'{module}'"
        for module, names in groups.items()
    )


def _find_class_line(code: Code, name: str) -> int:
    """Return the first line of a class, or of its methods if another file defines it."""
    functions = [parts for key, parts in code.functions.items() if key.startswith((f"{name}::", f"{name}."))]
    lines = [parts[0].first_line for parts in (*functions, code.outside.get(name, ())) if parts]
    return min(lines, default=1)


def _find_first_line(parts: Sequence[Part], others: Sequence[Part]) -> int:
    """Return the line of the first statement that differs from the other version."""
    pairs = zip_longest(parts, others)
    return next(
        (part.first_line for part, other in pairs if part and (not other or part.text != other.text)),
        parts[-1].last_line,
    )


def _join_names(names: Iterable[str]) -> Phrase:
    return joined_first(names, MAX_NAMES)


def _get_texts(parts: Sequence[Part]) -> list[str]:
    return [part.text for part in parts]


def _get_short_name(name: str) -> str:
    return re.split(r"\.|::", name)[-1]


def _find_renamed(
    old: Code, new: Code, removed: Sequence[str], added: Sequence[str], lines: ReportedLines
) -> list[tuple[str, str]]:
    """Return the old and new names of renamed functions.

    Their code is equal, or their class was renamed.
    """
    pairs = []
    remaining = list(added)
    for name in removed:
        scope, short = name[: -len(_get_short_name(name))], _get_short_name(name)
        equal_code = [
            candidate for candidate in remaining if old.get_body(name) and old.get_body(name) == new.get_body(candidate)
        ]
        is_class_removed = bool(scope) and not any(candidate.startswith(scope) for candidate in new.functions)
        in_renamed_class = [
            candidate
            for candidate in remaining
            if is_class_removed
            and _get_short_name(candidate) == short
            and (not lines.mentions(candidate) or lines.renames(name, candidate))
            and not any(other.startswith(candidate[: -len(short)] or candidate) for other in old.functions)
        ]
        best = next(
            (candidate for candidate in [*equal_code, *in_renamed_class] if _get_short_name(candidate) == short), None
        ) or next(iter(equal_code), None)
        if best is not None:
            pairs.append((name, best))
            remaining.remove(best)
    return pairs


def format_function(name: str, names: SourceNames) -> str:
    """Return the name of a function with the topic, service or action that calls it."""
    callback = names.find_callback(name)
    if callback is None:
        return f"'{name}()'"
    kind, topic = callback
    if kind is None:
        return phrase("'{name}()' (callback of a timer)", name=name)
    return phrase("'{name}()' (callback of {kind} '{topic}')", name=name, kind=kind.title, topic=topic)


class ReportedLines:
    """The other lines that are reported about a source.

    Args:
        changes: the changes that the lines report.

    Attributes:
        shown_functions: the functions whose changed statements a line shows.
        has_module_values: whether a line reports values in the code outside of functions.
    """

    def __init__(self, changes: Sequence[Change]) -> None:
        names = {name for change in changes for name in _QUOTED.findall(str(change.sentence))}
        self._names = {part for name in names for part in (name, *_list_parts(name))}
        self._text = "\n".join(str(change.sentence) for change in changes)
        self._compact_text = _SPACE.sub("", self._text).replace("'", '"')
        self._number_pairs = {
            (normalize_number(old, is_divided=False), normalize_number(new, is_divided=False))
            for old, new in _NUMBER_PAIR.findall(self._text)
        }
        self._functions = {
            str(change.sentence.arguments["name"]) for change in changes if change.sentence.template == _VALUES
        }
        self.shown_functions = {
            str(change.sentence.arguments["function"]) for change in changes if change.sentence.template == _STATEMENTS
        }
        self.has_module_values = any(change.sentence.template == _MODULE_VALUES for change in changes)
        self._lines: Mapping[bool, Collection[int]] = {
            is_old: {change.location.line for change in changes if change.location and change.location.is_old == is_old}
            for is_old in (True, False)
        }

    def mentions(self, function: str) -> bool:
        """Return whether a line names a function or its class."""
        return any(scope in self._names for scope in _list_scopes(function))

    def renames(self, old: str, new: str) -> bool:
        """Return whether a line reports that the class of a function was renamed."""
        pairs = zip(_list_scopes(old), _list_scopes(new), strict=False)
        patterns = (
            rf"'{re.escape(old_scope)}'[^'\n]* renamed to '{re.escape(new_scope)}'" for old_scope, new_scope in pairs
        )
        return any(re.search(pattern, self._text) for pattern in patterns)

    def has_unreported_change(self, old: Sequence[Part], new: Sequence[Part], name: str) -> bool:
        """Return whether the code of a function differs in anything that other lines do not report."""
        if re.search(rf"'{_get_constructor_class(name)}': .*\(", self._text):
            old, new = old[1:], new[1:]  # a line has the arguments of the constructor
        before, after = _get_texts(old), _get_texts(new)
        if before == after:
            return False
        if len(before) * len(after) > _MAX_COMPARED_PAIRS:
            return True
        has_values = self._has_values(name)
        matcher = SequenceMatcher(None, before, after, autojunk=False)
        return any(
            not self._reports(old_part, new_part, has_values=has_values)
            for tag, old_start, old_end, new_start, new_end in matcher.get_opcodes()
            if tag != "equal"
            for old_part, new_part in zip_longest(old[old_start:old_end], new[new_start:new_end])
        )

    def _has_values(self, name: str) -> bool:
        """Return whether a line reports values of a function, or of the code outside of functions."""
        return name in self._functions if name else self.has_module_values

    def reports(self, part: Part, *, is_old: bool) -> bool:
        """Return whether a line reports a statement that only one version has."""
        return self._reports(part if is_old else None, None if is_old else part, has_values=False)

    def reports_pair(self, name: str, old: Part, new: Part) -> bool:
        """Return whether a line reports the change in a statement of a function, or outside of functions."""
        return self._reports(old, new, has_values=self._has_values(name))

    def _reports(self, old: Part | None, new: Part | None, *, has_values: bool) -> bool:
        """Return whether a line reports the change in a statement, which only one version may have."""
        for part, is_old in ((old, True), (new, False)):
            if part is None:
                continue
            if self._shows_constant(part):
                return True
            if any(part.first_line <= line <= part.last_line for line in self._lines[is_old]):
                return True
            literals = [text for match in _LITERAL.finditer(part.text) for text in match.groups() if text]
            if not self._names.isdisjoint([*literals, *(text.rpartition(":=")[2].strip("/") for text in literals)]):
                return True
        if old is not None and new is not None and (self._shows_values(old, new) or self._shows_literals(old, new)):
            return True
        if not has_values or old is None or new is None:
            return False
        return _get_shape(old.text) == _get_shape(new.text) or differ_by_operator(
            tokenize_cpp(old.text), tokenize_cpp(new.text)
        )

    def _shows_constant(self, part: Part) -> bool:
        """Return whether a line shows an assignment with its value, such as an added constant."""
        assignment = _ASSIGNMENT.search(part.text)
        if assignment is None:
            return False
        shown = _SPACE.sub("", "=".join(assignment.groups())).replace("'", '"')
        return re.search(rf"(?<!\w){re.escape(shown)}(?![\w.])", self._compact_text) is not None

    def _shows_values(self, old: Part, new: Part) -> bool:
        """Return whether a line shows the old and the new value of an assignment, such as the QoS of a topic."""
        values = [_SPACE.sub("", part.text).partition("=")[2].rstrip(";") for part in (old, new)]
        return all(values) and f"{values[0]}->{values[1]}".replace("'", '"') in self._compact_text

    def _shows_literals(self, old: Part, new: Part) -> bool:
        """Return whether lines show the old and new number of all literals that differ, such as of a default."""
        statements = [parse_statement(tokenize_cpp(part.text)) for part in (old, new)]
        if statements[0].shape != statements[1].shape:
            return False
        pairs = zip(*(statement.literals for statement in statements), strict=True)
        changed = {(before.value, after.value) for before, after in pairs if before.differs_from(after)}
        return bool(changed) and changed <= self._number_pairs


def _get_constructor_class(name: str) -> str:
    """Return a pattern for the class of a constructor.

    The pattern for any other function matches no class.
    """
    parts = re.split(r"\.|::", name)
    return re.escape(parts[-2]) if len(parts) > 1 and parts[-1] == "__init__" else "-"


@cached_in_review(maxsize=4096)
def _get_shape(text: str) -> str:
    """Return the text of a statement with marks for its literals."""
    return parse_statement(tokenize_cpp(text)).shape


def _list_parts(name: str) -> Iterator[str]:
    """Yield the parts of a name with namespaces, such as ``arm/left`` and ``state`` of ``/arm/left/state``."""
    words = name.strip("/").split("/")
    if len(words) <= _MAX_NAMESPACES:
        yield from (
            "/".join(words[start:end]) for start in range(len(words)) for end in range(start + 1, len(words) + 1)
        )


def _list_scopes(name: str) -> Iterator[str]:
    """Yield a name and the names of the enclosing classes."""
    parts = re.split(r"(\.|::)", name)
    for end in range(len(parts), 0, -2):
        yield "".join(parts[:end])
    yield parts[-1]
