"""Find conditions that do not hold by default, because they depend on a parameter."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from linkwright.review.sources.names import NameKind, SourceNames
from linkwright.review.sources.statements.new_failures import find_read_parameters

_VARIABLE = re.compile(r"(?:self\.|this->)?(?P<name>[A-Za-z_]\w*)(?:\.value|\.(?:as_bool|as_string|as_int)\(\))?")
_READ = re.compile(r".*\bget_parameter\(\s*[\"'](?P<name>[\w./]+)[\"']\s*\)(?:\.\w+(?:\(\))?)*")
"""A call that reads a parameter, such as ``self.get_parameter("debug").value``."""
_NOT = re.compile(r"(?:not\s+|!\s*)(?:\((?P<inner>[^()]*)\)|(?P<word>[^()\s][^&|]*))")
_COMPARISON = re.compile(r"(?P<left>.+?)\s*(?P<operator>==|!=|\bis\s+not\b|\bis\b)\s*(?P<right>[^=<>!]+)")
_ENUMERATION = re.compile(
    r"^class\s+(?P<name>\w+)\s*\([^()]*Enum\b[^()]*\)\s*:(?P<body>(?:\s*\n[ \t]+[^\n]*|\s*\n(?=\s))*)", re.MULTILINE
)
_MEMBER = re.compile(r"^[ \t]+(?P<name>\w+)\s*=\s*(?P<value>[\"'][^\"'\\\n]*[\"']|-?\d+)\s*(?:#.*)?$", re.MULTILINE)
_DECLARED = re.compile(
    r"(?<![\w.])(?P<variable>(?:self\.)?[A-Za-z_]\w*)\s*=\s*self\.declare_parameter\(\s*(?P<constant>[A-Z_][A-Z0-9_]*)\b"
)
"""A parameter whose name is a constant, which a variable keeps."""
_PASSED_ON = re.compile(
    r"(?<![\w.])(?:self\.)?(?P<variable>[A-Za-z_]\w*)\s*=\s*\w+\(\s*(?P<from>(?:self\.)?[A-Za-z_]\w*)\.value\s*\)"
)
"""A member of an enumeration that is made of the value of a parameter."""
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
    members = dict(_list_members(text))
    variables = {
        variable: parameter
        for variable, parameter in {**find_read_parameters(text), **_find_passed_on(text)}.items()
        if len(re.findall(rf"(?<![\w.])(?:self\.|this->)?{variable}\s*=(?!=)", text)) <= 1
    }
    for condition in conditions:
        for term in () if _OR.search(condition) else _TERM_END.split(condition):
            found = _evaluate(_replace_members(term.strip(), members), variables, defaults)
            if found is not None and not found[1]:
                return found[0]
    return None


def _list_members(text: str) -> Iterator[tuple[str, str]]:
    """Yield the members of the enumerations of a Python source, such as ``Mode.FAST``, with their literal values."""
    for enumeration in _ENUMERATION.finditer(text):
        for member in _MEMBER.finditer(enumeration["body"]):
            yield f"{enumeration['name']}.{member['name']}", member["value"]


def _replace_members(term: str, members: Mapping[str, str]) -> str:
    """Return a condition with the values of the members of enumerations."""
    return re.sub(
        r"\b\w+\.\w+\b(?:\.value\b)?", lambda match: members.get(match[0].removesuffix(".value"), match[0]), term
    )


def _find_passed_on(text: str) -> dict[str, str]:
    """Return the parameters whose values a Python source converts, by the variable that gets the result."""
    constants = dict(re.findall(r"^([A-Z_][A-Z0-9_]*)\s*=\s*[\"']([\w./]+)[\"']", text, re.MULTILINE))
    declared = {match["variable"]: constants.get(match["constant"], "") for match in _DECLARED.finditer(text)}
    declared |= find_read_parameters(text)
    passed = ((match["variable"], declared.get(match["from"], "")) for match in _PASSED_ON.finditer(text))
    return {variable: parameter for variable, parameter in passed if parameter}


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
        return parameter, (default == value) == (comparison["operator"] in ("==", "is"))
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
