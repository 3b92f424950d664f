"""Read the literals of C++ sources: constants, and the initial values of members and variables."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from linkwright.review.sources.cpp.text import find_closing_bracket

TEXT = re.compile(r'\s*(?:(?:std::)?string\s*\(\s*)?"(?P<text>[^"\\]*)"\s*\)?\s*')
VARIABLE = re.compile(r"\s*(?:\w+::)*(?P<name>\w+)\s*(?:\.c_str\(\))?\s*")
_LITERAL = re.compile(r'\s*(-?[\d.]+(?:e-?\d+)?f?|true|false|"[^"\\]*"|(?:std::)?string\((?P<text>"[^"\\]*")\))\s*')
_WRAPPED = re.compile(r"\s*(?:rclcpp::)?ParameterValue\s*\((?P<value>.*)\)\s*", re.DOTALL)
_CONSTANT = re.compile(
    r"(?:\b(?:string|char|auto|string_view)\b[\s*&const]*\b(?:\w+::)*(?P<name>\w+)\s*(?:\[\s*\])?\s*(?:=|(?P<open>[({]))"
    r'\s*(?P<made>(?:std::)?string\s*\(\s*)?"(?P<text>[^"\\]*)"(?(made)\s*\))(?(open)\s*[)}])\s*;)'
    r'|#\s*define\s+(?P<macro>\w+)[ \t]+\(?"(?P<value>[^"\\]*)"'
)
_ASSIGNED_TEXT = re.compile(
    r'\s*(?:=|(?P<open>[({]))\s*(?P<made>(?:std::)?string\s*\(\s*)?"(?P<text>[^"\\]*)"(?(made)\s*\))(?(open)\s*[)}])\s*;'
)
_ASSIGNED_EXPRESSION = re.compile(r"\s*(?:=(?P<expression>[^;{}]+)|\{(?P<braced>[^;{}]+)\})\s*;")
_MAX_EXPRESSION_CHARACTERS = 80
_TYPE = r"\b(?:double|float|int|bool|auto|size_t|u?int(?:8|16|32|64)_t|unsigned|long|short|string)"
_UNNAMED_VALUE = r"(?:-?(?:\d+\.?\d*|\.\d+)(?:e-?\d+)?f?|true|false|\"[^\"\\]*\")"
_VALUE = rf"(?P<value>{_UNNAMED_VALUE})"
_DECLARED = re.compile(rf"{_TYPE}\s+(?P<names>\w+(?:\s*,\s*\w+)*)\s*(?=[;={{])")
"""A declaration of members or variables, with or without a value."""
_SET = rf"\w+\s*(?:=\s*{_UNNAMED_VALUE}|[({{]\s*{_UNNAMED_VALUE}\s*[)}}])?"
_INITIAL = re.compile(rf"{_TYPE}\s+(?P<list>{_SET}(?:\s*,\s*{_SET})*)\s*;")
"""A declaration of members or variables with literal values."""
_INITIAL_ITEM = re.compile(rf"(?P<name>\w+)\s*(?:=|[({{])\s*{_VALUE}")
_INITIAL_LIST = re.compile(
    rf"\bvector\s*<[^;{{}}=]*>\s*(?P<name>\w+)\s*=?\s*\{{(?P<items>\s*{_UNNAMED_VALUE}(?:\s*,\s*{_UNNAMED_VALUE})*\s*)\}}\s*;"
)
"""A declaration of a list with literal values."""
_MAX_LIST_CHARACTERS = 120
_INITIALIZED = re.compile(rf"(?<=[:,])\s*(?P<name>\w+)\s*(?:\(\s*|\{{\s*){_VALUE}\s*[)}}]\s*(?=[,{{])")
"""An entry of the initializer list of a constructor."""
_MEMBER = re.compile(r"\s*(?:\*?this\s*->\s*)?(?:\w+\s*(?:\.|->)\s*)*(?P<name>[A-Za-z_]\w*)\s*")
_READ = r"\w*[pP]aram\w*\s*(?:<[^<>;()]*>)?\s*\("
_STATEMENT = re.compile(r"(?:this\s*->\s*)?[\w:]*(?:\s*\(\s*\))?\s*(?:\.|->|::)?\s*")
"""The start of a statement that only makes a call, before the name of the function."""
_NUMBER_TYPE = (
    r"(?:(?:unsigned|signed|long|short)\s+)*(?:double|float|int|bool|unsigned|long|short|size_t|u?int(?:8|16|32|64)_t)"
)
_PARAMETERS_CALLBACK = re.compile(r"\([^(){};]*\bParameter\s*>?\s*(?:const\s*)?&?\s*\w+\s*\)[^(){};]*\{")
"""The head of a function or lambda that gets changed parameters of ROS 2."""


def parse_literal(text: str) -> str | None:
    """Return the literal in an argument, such as ``10.0`` or ``"map"`` with its quotation marks; None for others."""
    wrapped = _WRAPPED.fullmatch(text)
    value = _LITERAL.fullmatch(wrapped["value"] if wrapped else text)
    return None if value is None else value["text"] or value[1]


def find_constants(text: str) -> Mapping[str, str]:
    """Return the texts of constants and of variables assigned once, by name."""
    constants: dict[str, str] = {}
    for match in _CONSTANT.finditer(text):
        name = match["name"] or match["macro"]
        assignment_count = len(re.findall(rf"\b{name}\b\s*(?:\[\s*\])?\s*=(?!=)", text))
        declaration = text[max(text.rfind(mark, 0, match.start()) for mark in ";{}\n") + 1 : match.end()]
        is_constant = re.match(r"\s*(?:\w+\s+)*?const(?:expr)?\b", declaration) is not None and "*" not in declaration
        is_read = match["macro"] is None and not is_constant and _is_output(text, name)
        if assignment_count <= 1 and not is_read and name not in constants:
            constants[name] = match["text"] if match["macro"] is None else match["value"]
    return constants


def find_assigned_text(text: str, name: str, position: int) -> str | None:
    """Return the text that a variable has at a place, or None if it is not certain.

    It is the one that the last statement before the place assigns, in the same block or one around it.

    Args:
        text: the source without comments.
        name: the name of the variable.
        position: the offset of the place.
    """
    assigned = _find_last_assignment(text, name, position, _ASSIGNED_TEXT)
    return None if assigned is None else assigned["text"]


def find_assigned_expression(text: str, name: str, position: int) -> str | None:
    """Return the expression that the last statement before a place assigns to a local variable, in one line, or None.

    Args:
        text: the source without comments.
        name: the name of the variable.
        position: the offset of the place.
    """
    assigned = _find_last_assignment(text, name, position, _ASSIGNED_EXPRESSION)
    expression = "" if assigned is None else " ".join((assigned["expression"] or assigned["braced"]).split())
    return expression if 0 < len(expression) <= _MAX_EXPRESSION_CHARACTERS else None


def find_member_expression(text: str, name: str) -> tuple[str, int] | None:
    """Return the only expression that a source assigns to a member, with its offset, or None.

    Args:
        text: the source without comments.
        name: the name of the member, which begins with ``m_`` or ends with an underscore.
    """
    if not name.startswith("m_") and not name.endswith("_"):
        return None
    places = list(re.finditer(rf"(?<!\w){name}\s*\+?=(?!=)|[:,]\s*{name}\s*[({{]", text))
    opening = places[0].end() - 1 if len(places) == 1 else 0
    if not opening or _is_output(text, name):
        return None
    end = text.find(";", opening) if text[opening] == "=" else find_closing_bracket(text, opening)
    return " ".join(text[opening + 1 : end].split()), opening


def _find_last_assignment(text: str, name: str, position: int, form: re.Pattern[str]) -> re.Match[str] | None:
    """Return the last assignment to a variable before a place, in the same block or one around it.

    The result is None if the assignment has another form, or if something else may set the variable after it.
    """
    start = max(0, text.rfind("\n}", 0, position))
    changes = list(
        re.finditer(rf"(?<![\w.>\"]){re.escape(name)}\s*(?:[+]?=(?!=)|>>|\(\s*\"|\{{)", text[start:position])
    )
    if not changes:
        return None
    assigned = form.match(text, start + changes[-1].start() + len(name), position)
    if assigned is None:
        return None
    between = text[assigned.end() : position]
    depth = 0
    for bracket in re.findall(r"[{}]", between):
        depth += 1 if bracket == "{" else -1
        if depth < 0:
            return None  # the block of the assignment ends before the place
    return None if _is_output(between, name) else assigned


def _is_output(text: str, name: str) -> bool:
    """Return whether a call that reads a parameter or another value may write a variable."""
    output = rf"\b(?:\w*[pP]aram\w*|get\w*)\s*(?:<[^<>]*>)?\([^;()]*\b{name}\b(?!\s*\+)"
    return re.search(output, text) is not None


_EMPTY_TEXT = re.compile(r"(?<![\w:<])(?:std::)?string\s+(?P<names>\w+(?:\s*,\s*\w+)*)\s*;")
"""The declaration of texts without a value, which are empty."""


class InitialValues:
    """The literals with which a C++ source initializes members and variables.

    Names with several values are left out. An entry of an initializer list replaces the value of a declaration.

    Args:
        text: the source without comments.
        headers: the texts of the headers that may declare members of its classes.
    """

    def __init__(self, text: str, headers: Sequence[str]) -> None:
        self._text = text
        self._headers = headers
        self._code = _INITIAL_LIST.sub(lambda match: " " * len(match[0]), _blank_callbacks(text))
        declared, initial, listed = set[str](), dict[str, set[str]](), dict[str, set[str]]()
        for source in (*headers, text):
            declared |= {name for match in _DECLARED.finditer(source) for name in re.findall(r"\w+", match["names"])}
            for name, value in _find_initial_values(source):
                initial.setdefault(name, set()).add(value)
            for match in _INITIALIZED.finditer(source):
                listed.setdefault(match["name"], set()).add(match["value"])
        values = initial | {name: found for name, found in listed.items() if name in declared}
        self._values = {name: next(iter(found)) for name, found in values.items() if len(found) == 1}
        empty = (match["names"] for source in (*headers, text) for match in _EMPTY_TEXT.finditer(source))
        texts = {name for names in empty for name in re.findall(r"\w+", names)}
        self._empty_texts = texts - initial.keys() - listed.keys()

    def find_default(self, expression: str, position: int) -> str | None:
        """Return the literal that a member has where a call passes it, or None if it is unknown.

        Args:
            expression: the argument of the call, such as ``rate_`` or ``params.rate``.
            position: the offset of the call.
        """
        match = _MEMBER.fullmatch(expression)
        value = None if match is None else self._values.get(match["name"])
        if match is not None and value is None and self._is_empty_text(match["name"], position):
            return '""'
        if match is None or value is None:
            return None
        start = max(self._text.rfind(mark, 0, position) for mark in ";{}") + 1
        name = re.escape(match["name"])
        assigned = re.compile(rf"(?<!\w){name}\s*(?:[-+*/|&]?=(?!=))(?!\s*{re.escape(value)}\s*[;,])|>>\s*{name}\b")
        if value.startswith("["):
            assigned = re.compile(rf"(?<!\w){name}\s*(?:=(?!=)|\[|\.\s*(?!size|empty|at|data|begin|end)\w+\s*\()")
        read = re.compile(rf"\b{_READ}[^;()]*[,&.>\s]{name}\s*[,)]")
        is_changed = any(pattern.search(self._code, 0, start) for pattern in (assigned, read))
        return None if is_changed else value

    def _is_empty_text(self, name: str, position: int) -> bool:
        """Return whether a member or variable is a text without a value, and nothing uses it before a call."""
        if name not in self._empty_texts:
            return False
        start = max(self._text.rfind(mark, 0, position) for mark in ";{}") + 1
        before = _EMPTY_TEXT.sub("", self._code[:start])
        initialized = re.search(rf"[:,]\s*{re.escape(name)}\s*[({{]", self._text)
        return initialized is None and re.search(rf"\b{re.escape(name)}\b", before) is None

    def is_undefined(self, expression: str, position: int) -> bool:
        """Return whether a number has no value if a call does not set it, whose result nothing checks.

        Args:
            expression: the argument of the call, such as ``rate_``.
            position: the offset of the call.
        """
        match = _MEMBER.fullmatch(expression)
        start = max(self._text.rfind(mark, 0, position) for mark in ";{}") + 1
        if match is None or not _STATEMENT.fullmatch(self._text[start:position].strip()):
            return False
        name = match["name"]
        sources = (*self._headers, self._text)
        declared = re.compile(rf"^[ \t]+{_NUMBER_TYPE}\s+(?:\w+\s*,\s*)*{name}\s*(?:,\s*\w+\s*)*;", re.MULTILINE)
        set_value = re.compile(
            rf"(?<!\w){name}\s*(?:[-+*/|&]?=(?!=)|[({{\[]|\+\+|--)|(?:>>|[&,(]\s*&|\+\+|--)\s*{name}\b"
        )
        if any(map(set_value.search, sources)) or sum(len(declared.findall(source)) for source in sources) != 1:
            return False
        is_used_before = re.search(rf"\b{name}\b", declared.sub("", self._code[:start])) is not None
        return not is_used_before and len(re.findall(rf"{_READ}[^;()]*\b{name}\b", self._text)) == 1

    def find_text(self, name: str) -> str | None:
        """Return the text with which a member is initialized and that nothing else sets; None for others."""
        value = self.find_kept_value(name) or ""
        return value[1:-1] if value.startswith('"') else None

    def find_kept_value(self, name: str) -> str | None:
        """Return the literal with which a member or variable is initialized and that nothing else sets, or None."""
        value = self._values.get(name)
        if value is None or value.startswith("[") or _is_output(self._text, name):
            return None
        is_assigned = re.search(rf"(?<![\w\"]){name}\s*[-+*/]?=(?!=)(?!\s*{re.escape(value)}\s*[;,])", self._text)
        return None if is_assigned else value


def _find_initial_values(text: str) -> Iterator[tuple[str, str]]:
    """Yield the members and variables that declarations initialize with literals, each with its value."""
    for match in _INITIAL.finditer(text):
        yield from ((item["name"], item["value"]) for item in _INITIAL_ITEM.finditer(match["list"]))
    for match in _INITIAL_LIST.finditer(text):
        value = f"[{' '.join(match['items'].split())}]"
        if len(value) <= _MAX_LIST_CHARACTERS:
            yield match["name"], value


def _blank_callbacks(text: str) -> str:
    """Return a source with spaces for the functions that get changed parameters, which run after their declaration."""
    for match in _PARAMETERS_CALLBACK.finditer(text):
        end = find_closing_bracket(text, match.end() - 1)
        text = text[: match.end()] + re.sub(r"[^\n]", " ", text[match.end() : end]) + text[end:]
    return text


def read_initial_values(text: str) -> dict[str, str]:
    """Return the literals, but not lists, with which a header initializes members, if each has one value."""
    values: dict[str, set[str]] = {}
    for name, value in _find_initial_values(text):
        if not value.startswith("["):
            values.setdefault(name, set()).add(value)
    return {name: next(iter(found)) for name, found in values.items() if len(found) == 1}
