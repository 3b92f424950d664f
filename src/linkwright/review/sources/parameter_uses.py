"""Find what sources do with their parameters, to tell renamed parameters from others."""

from __future__ import annotations

import re
from collections.abc import Iterable

_ASSIGNMENT = r"(?P<variable>[A-Za-z_][\w.]*)\s*(?::[^=\n]+)?=(?!=)[^=;\n]*[\"']~?{name}[\"']"
_OUTPUT = (
    r"\b(?:get_parameter|get_parameter_or|getParam|getParamCached|param)\s*(?:<[^<>()]*>)?"
    r"\(\s*\"~?{name}\"\s*,\s*(?P<variable>[A-Za-z_][\w.]*)\s*[,)]"
)
_DECLARATION = re.compile(r"\bdeclare_parameters?\b")
_PREFIX = re.compile(r"^(?:self|this)(?:\.|->)")
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


def _read_uses(text: str, names: Iterable[str]) -> dict[str, tuple[set[str], set[str]]]:
    """Return the variables of each parameter, and the lines that use them with marks for the variables and names."""
    lines = [line for line in (_COMMENT.sub("", line).strip() for line in text.splitlines()) if line]
    code = "\n".join(lines)
    variables = {
        name: {
            _PREFIX.sub("", match["variable"])
            for pattern in (_ASSIGNMENT, _OUTPUT)
            for match in re.finditer(pattern.format(name=re.escape(name.lstrip("~"))), code)
        }
        for name in names
    }
    words = sorted({word for found in variables.values() for word in found}, key=len, reverse=True)
    own = (
        re.compile(rf"(?<![\w.])(?:(?:self|this)(?:\.|->))?(?:{'|'.join(map(re.escape, words))})\b") if words else None
    )
    return {name: (found, set(_list_uses(lines, name, found, own))) for name, found in variables.items()}


def _list_uses(lines: Iterable[str], name: str, variables: set[str], own: re.Pattern[str] | None) -> Iterable[str]:
    """Yield the lines that use a parameter, without its declaration and the assignments of its value."""
    literal = re.compile(rf"[\"']~?{re.escape(name.lstrip('~'))}[\"']")
    own_words = [rf"(?:(?:self|this)(?:\.|->))?{re.escape(word)}" for word in variables]
    used = re.compile(rf"(?<![\w.])(?:{'|'.join(own_words)})\b") if own_words else literal
    for line in lines:
        is_definition = literal.search(line) is not None and (bool(variables) or _DECLARATION.search(line) is not None)
        if used.search(line) and not is_definition:
            text = literal.sub("?", line)
            yield "".join((text if own is None else own.sub("?", text)).split())
