"""Find what sources do with their parameters, to tell renamed parameters from others."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

_ASSIGNMENT = r"(?P<variable>[A-Za-z_][\w.]*)\s*(?::[^=\n]+)?=(?!=)(?:[^=;\n]|(?<=[(,?])\n)*[\"']~?{name}[\"']"
_OUTPUT = (
    r"\b(?:get_parameter|get_parameter_or|getParam|getParamCached|param)\s*(?:<[^<>()]*>)?"
    r"\(\s*\"~?{name}\"\s*,\s*(?P<variable>[A-Za-z_][\w.]*)\s*[,)]"
)
_DECLARATION = re.compile(r"\bdeclare_parameters?\b")
_PREFIX = re.compile(r"^(?:self|this)(?:\.|->)")
_BEGUN_ASSIGNMENT = re.compile(r"\?=(?!=).*[(,?]\Z")
"""An assignment to a variable of a parameter whose value is in the next line."""
_WORD = re.compile(r"\w+")
_COMMENT = re.compile(r"(?:^|\s)(?:#(?!\s*(?:include|define|if|endif))|//).*")


class ParameterUses:
    """The uses of the parameters of both versions of a source.

    Args:
        old_text: the text of the old version.
        new_text: the text of the new version.
        old_names: the names of the parameters that only the old version has.
        new_names: the names of the parameters that only the new version has.
    """

    def __init__(self, old_text: str, new_text: str, old_names: Iterable[str], new_names: Iterable[str]) -> None:
        self._old = _read_uses(old_text, old_names)
        self._new = _read_uses(new_text, new_names)

    def differ(self, old_name: str, new_name: str) -> bool:
        """Return whether two parameters are certainly used for different things.

        They are assigned to different variables, and no line uses both in the same way.
        """
        old_variables, old_lines = self._old[old_name]
        new_variables, new_lines = self._new[new_name]
        if old_variables & new_variables or not old_lines or not new_lines:
            return False
        return old_lines.isdisjoint(new_lines)


class _Lines:
    """The lines of a source without comments, found by the words in them."""

    def __init__(self, text: str) -> None:
        self.lines = [line for line in (_COMMENT.sub("", line).strip() for line in text.splitlines()) if line]
        self._numbers: dict[str, list[int]] = {}
        for number, line in enumerate(self.lines):
            for word in set(_WORD.findall(line)):
                self._numbers.setdefault(word, []).append(number)

    def find(self, name: str) -> Sequence[int]:
        """Return the numbers of the lines that may contain a name."""
        word = _WORD.search(name)
        return range(len(self.lines)) if word is None else self._numbers.get(word[0], [])

    def get_statement(self, number: int) -> str:
        """Return a line with those around it, over which a statement may extend."""
        return "\n".join(self.lines[max(0, number - 1) : number + 2])


def _read_uses(text: str, names: Iterable[str]) -> dict[str, tuple[set[str], set[str]]]:
    """Return the variables of each parameter, and the lines that use them with marks for the variables and names."""
    lines = _Lines(text)
    variables = {name: set(_find_variables(lines, name.lstrip("~"))) for name in names}
    words = sorted({word for found in variables.values() for word in found}, key=len, reverse=True)
    own = (
        re.compile(rf"(?<![\w.])(?:(?:self|this)(?:\.|->))?(?:{'|'.join(map(re.escape, words))})\b") if words else None
    )
    return {name: (found, set(_list_uses(lines, name, found, own))) for name, found in variables.items()}


def _find_variables(lines: _Lines, name: str) -> Iterator[str]:
    """Yield the variables that get the value of a parameter."""
    patterns = [re.compile(pattern.format(name=re.escape(name))) for pattern in (_ASSIGNMENT, _OUTPUT)]
    for number in lines.find(name):
        statement = lines.get_statement(number)
        for pattern in patterns:
            yield from (_PREFIX.sub("", match["variable"]) for match in pattern.finditer(statement))


def _list_uses(lines: _Lines, name: str, variables: set[str], own: re.Pattern[str] | None) -> Iterator[str]:
    """Yield the lines that use a parameter, without its declaration and the assignments of its value."""
    literal = re.compile(rf"[\"']~?{re.escape(name.lstrip('~'))}[\"']")
    own_words = [rf"(?:(?:self|this)(?:\.|->))?{re.escape(word)}" for word in variables]
    used = re.compile(rf"(?<![\w.])(?:{'|'.join(own_words)})\b") if own_words else literal
    for number in sorted({number for word in variables or [name] for number in lines.find(word)}):
        line = lines.lines[number]
        is_definition = literal.search(line) is not None and (bool(variables) or _DECLARATION.search(line) is not None)
        if used.search(line) and not is_definition:
            text = literal.sub("?", line)
            use = "".join((text if own is None else own.sub("?", text)).split())
            if _BEGUN_ASSIGNMENT.match(use) is None:
                yield use
