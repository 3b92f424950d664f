"""Find conditions that do not hold by default, because they depend on a parameter."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from linkwright.review.sources.names import NameKind, SourceNames
from linkwright.review.sources.new_failures import find_read_parameters

_VARIABLE = re.compile(r"(?:self\.|this->)?(?P<name>[A-Za-z_]\w*)(?:\.value|\.(?:as_bool|as_string|as_int)\(\))?")
_READ = re.compile(r".*\bget_parameter\(\s*[\"'](?P<name>[\w./]+)[\"']\s*\)(?:\.\w+(?:\(\))?)*")
"""A call that reads a parameter, such as ``self.get_parameter("debug").value``."""
_NOT = re.compile(r"(?:not\s+|!\s*)(?:\((?P<inner>[^()]*)\)|(?P<word>[^()\s][^&|]*))")
_COMPARISON = re.compile(r"(?P<left>.+?)\s*(?P<operator>==|!=)\s*(?P<right>[^=<>!]+)")
_TERM_END = re.compile(r"\s+and\s+|\s*&&\s*")
_OR = re.compile(r"\s+or\s+|\|\|")
_LITERAL = re.compile(r"[\"'][^\"'\\]*[\"']|-?\d+(?:\.\d+)?|true|false", re.IGNORECASE)
_BOOLEANS = {"true": True, "false": False}


def find_unmet_parameter(conditions: Sequence[str], names: SourceNames, text: str) -> str | None:
    """Return the parameter whose default makes one of several conditions false, or None if there is none.

    Args:
        conditions: the conditions as code.
        names: the names in the source, with the defaults of its parameters.
        text: the text of the source.
    """
    defaults = {item.name.lstrip("~/"): item.type for item in names.of_kind(NameKind.PARAMETER)}
    variables = {
        variable: parameter
        for variable, parameter in find_read_parameters(text).items()
        if len(re.findall(rf"(?<![\w.])(?:self\.|this->)?{variable}\s*=(?!=)", text)) <= 1
    }
    for condition in conditions:
        for term in () if _OR.search(condition) else _TERM_END.split(condition):
            found = _evaluate(term.strip(), variables, defaults)
            if found is not None and not found[1]:
                return found[0]
    return None


def _evaluate(term: str, variables: Mapping[str, str], defaults: Mapping[str, str]) -> tuple[str, bool] | None:
    """Return the parameter in a term and whether the term holds by default, or None if that is unknown."""
    negated = _NOT.fullmatch(term)
    if negated is not None:
        inner = _evaluate((negated["inner"] or negated["word"]).strip(), variables, defaults)
        return None if inner is None else (inner[0], not inner[1])
    comparison = _COMPARISON.fullmatch(term)
    if comparison is not None:
        parameter = _find_parameter(comparison["left"].strip(), variables)
        default = _normalize(defaults.get(parameter or "", ""))
        value = _normalize(comparison["right"].strip())
        if parameter is None or default is None or value is None:
            return None
        return parameter, (default == value) == (comparison["operator"] == "==")
    parameter = _find_parameter(term, variables)
    holds = _BOOLEANS.get(defaults.get(parameter or "", "").lower())
    return None if parameter is None or holds is None else (parameter, holds)


def _find_parameter(expression: str, variables: Mapping[str, str]) -> str | None:
    """Return the parameter that an expression reads, or None for other expressions."""
    read, variable = _READ.fullmatch(expression), _VARIABLE.fullmatch(expression)
    if read is not None:
        return read["name"]
    return None if variable is None else variables.get(variable["name"])


def _normalize(literal: str) -> str | None:
    """Return a literal in one notation, or None for other expressions."""
    return literal.strip("\"'").lower() if _LITERAL.fullmatch(literal) else None
