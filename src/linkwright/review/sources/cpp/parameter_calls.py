"""Find the parameters that a C++ source requires, and those whose names are in a table."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from linkwright.review.sources.cpp.branches import FAILURE, MAX_CONDITION_CHARACTERS, is_in_branch, read_branch
from linkwright.review.sources.cpp.calls import Call
from linkwright.review.sources.cpp.text import find_closing_bracket
from linkwright.review.sources.cpp.values import VARIABLE, InitialValues, parse_literal

_IF = re.compile(r"\bif\s*(?=\()")
_NEGATED = re.compile(r"!\s*(?:\w+\s*(?:\(\s*\))?\s*(?:\.|->|::)\s*)*\Z")
_FLAG = re.compile(
    r"(?<![\w.>])(?P<flag>\w+)\s*(?:&=|=\s*(?P=flag)\s*&&?|=)\s*(?:\w+\s*(?:\(\s*\))?\s*(?:\.|->|::)\s*)*\Z"
)
"""The beginning of a statement that keeps in a variable whether a call found its parameter."""
_MAIN = re.compile(r"\bint\s+main\s*\(")
_EXIT_CODE = re.compile(r"\breturn\s+[1-9]\d*\s*;")
_READ_ARGUMENTS = 2
"""The number of arguments of ``getParam``: the name and the variable for the value."""
_LITERAL = r"-?[\d.]+(?:e-?\d+)?f?|true|false|\"[^\"\\]*\""
_DEFAULT_INDEX = {"param": 2, "get_parameter_or": 2}
_DESCRIPTOR = re.compile(r"\s*(?:\w+\s*(?:::|\.)\s*)*\w*[dD]escriptor\w*\s*(?:\{.*\}\s*)?\Z", re.DOTALL)
"""An argument of a declaration that describes the parameter, and is not its default."""
_TYPED_CALLS = frozenset({"declare_parameter"})
_LOOP = r"\bfor\s*\(\s*(?:const\s+)?[\w:<>,\s*]*?[&*\s]+(?:{name}|\[\s*{name}\b[^\]]*\])\s*:\s*(?P<table>\w+)\s*\)"
_TABLE = r"\b{table}\s*(?:\[\w*\]\s*)?(?:=\s*)?(?=\{{)"
_ELEMENT = re.compile(r"(?P<name>\w+)\s*(?P<part>(?:\.|->)\s*\w+)?\s*(?:\.c_str\(\))?")
_TEXT = re.compile(r"\"(?P<text>[^\"\\]+)\"")


class TableName(NamedTuple):
    """A name in a table.

    Attributes:
        name: the name.
        start: its offset.
        end: the offset of its end.
    """

    name: str
    start: int
    end: int


class ParameterDefaults:
    """The defaults of parameters in the calls of a C++ source.

    Args:
        text: the source without comments.
        constants: the texts of its constants, by name.
        initial_values: the initial values of members and variables.
    """

    def __init__(self, text: str, constants: Mapping[str, str], initial_values: InitialValues) -> None:
        self._text = text
        self._constants = constants
        self._initial_values = initial_values

    def find(self, call: Call, texts: Sequence[str]) -> str:
        """Return the literal default of a parameter, or the initial value of a member; empty if there is none.

        Functions that return the value have the default as their second argument.

        Args:
            call: the call that reads or declares the parameter.
            texts: the arguments behind the name.
        """
        index = _DEFAULT_INDEX.get(call.function, 1) - 1
        index = index if index < len(texts) else 0
        if index >= len(texts):
            return ""
        value = parse_literal(texts[index])
        if value is not None:
            return value
        variable = VARIABLE.fullmatch(texts[index])
        constant = self._constants.get(variable["name"]) if variable else None
        if constant is not None:
            return f'"{constant}"'
        return self._initial_values.find_default(texts[index], call.start) or ""

    def find_kept(self, call: Call, texts: Sequence[str]) -> str:
        """Return the literal that a variable has if a call does not find its parameter; empty if it is unknown.

        A function of the repository with this name may take the default before the variable.
        """
        if call.function == "getParam" and len(texts) > 1:
            value = parse_literal(texts[0])
            is_kept = value is None and texts[0] == texts[1]
            return value or (is_kept and self._initial_values.find_default(texts[0], call.start)) or ""
        if call.function != "getParam" or len(texts) != 1 or is_required_parameter(self._text, call, texts):
            return ""
        return find_fallback(self._text, call) or self._initial_values.find_default(texts[0], call.start) or ""


def is_required_parameter(text: str, call: Call, arguments: Sequence[str]) -> bool:
    """Return whether the program fails if a parameter is not set.

    A call that declares a type without a default throws an error, and the branch of an ``if`` that a failed call takes
    may throw one or return a failure.

    Args:
        text: the source without comments.
        call: the call that reads or declares the parameter.
        arguments: the arguments behind the name.
    """
    if call.function in _TYPED_CALLS and call.type and all(map(_DESCRIPTOR.match, arguments)):
        return re.search(r"\bcatch\b", text) is None and not is_in_branch(text, call.start)
    branch = _find_branch_of_failure(text, call)
    is_failure = FAILURE.search(branch) or (_EXIT_CODE.search(branch) and _is_in_main(text, call.start))
    return bool(is_failure) and not is_in_branch(text, call.start)


def _is_in_main(text: str, position: int) -> bool:
    """Return whether a place is in the function ``main()``."""
    mains = list(_MAIN.finditer(text, 0, position))
    body = text[mains[-1].end() : position] if mains else ""
    return body.count("{") > body.count("}")


def find_type_of_default(text: str, arguments: Sequence[str]) -> str:
    """Return the type that the literal default of a declared parameter has, such as ``int``; empty if it is unknown.

    Args:
        text: the source without comments.
        arguments: the arguments behind the name.
    """
    value = parse_literal(arguments[0]) if arguments else None
    if value is None or "dynamic_typing" in text:
        return ""
    if value.startswith('"'):
        return "string"
    if value in ("true", "false"):
        return "bool"
    return "double" if re.search(r"[.ef]", value) else "int"


def find_fallback(text: str, call: Call) -> str:
    """Return the literal that a variable gets if a call does not find its parameter; empty if there is none.

    Args:
        text: the source without comments.
        call: the call that reads the parameter into the variable.
    """
    if len(call.arguments) != _READ_ARGUMENTS:
        return ""
    variable = text[slice(*call.arguments[1])].strip()
    pattern = rf"(?<![\w.>]){re.escape(variable)}\s*=\s*(?P<value>{_LITERAL})\s*;"
    match = re.search(pattern, _find_branch_of_failure(text, call))
    return "" if match is None else match["value"]


def _find_branch_of_failure(text: str, call: Call) -> str:
    """Return the code that runs if a call does not find its parameter; empty if that is not certain."""
    if call.function not in ("getParam", "get_parameter"):
        return ""
    flag = _FLAG.search(text, max(0, call.start - MAX_CONDITION_CHARACTERS), call.start)
    if flag is not None:
        return _find_branch_without(text, flag["flag"], call.start)
    begin = max(0, call.start - MAX_CONDITION_CHARACTERS)
    conditions = [match.end() for match in _IF.finditer(text, begin, call.start)]
    if not conditions:
        return ""
    start = conditions[-1]
    end = find_closing_bracket(text, start)
    if not start < call.start < end or "&&" in text[start:end] or not _NEGATED.search(text, start, call.start):
        return ""
    return read_branch(text, end + 1)


def _find_branch_without(text: str, flag: str, position: int) -> str:
    """Return the code that the function runs if a variable is false; empty if it gets another value before."""
    end = text.find("\n}", position)
    pattern = rf"\bif\s*\(\s*!\s*{flag}\s*\)|\b{flag}\s*=(?!=|\s*{flag}\b)"
    match = re.compile(pattern).search(text, position, len(text) if end < 0 else end)
    is_tested = match is not None and match[0].startswith("if") and not is_in_branch(text, match.start())
    return read_branch(text, match.end()) if match is not None and is_tested else ""


def find_table_names(text: str, expression: str, position: int) -> Iterator[TableName]:
    """Yield the names in the table over which the loop around a call runs, if the call takes a name of the table.

    Args:
        text: the source without comments.
        expression: the argument of the call, such as ``entry.first``.
        position: the offset of the call.
    """
    element = _ELEMENT.fullmatch(expression.strip())
    if element is None:
        return
    loops = list(re.finditer(_LOOP.format(name=re.escape(element["name"])), text[:position]))
    if not loops or text[loops[-1].end() : position].count("}") > text[loops[-1].end() : position].count("{"):
        return
    tables = list(re.finditer(_TABLE.format(table=re.escape(loops[-1]["table"])), text[: loops[-1].start()]))
    if not tables:
        return
    start = tables[-1].end()
    end = find_closing_bracket(text, start)
    is_pair = element["part"] is not None or "[" in loops[-1][0]
    for match in _TEXT.finditer(text, start, end):
        before = text[start : match.start()].rstrip()
        is_first = before.endswith("{") if is_pair else before.endswith(("{", ","))
        if is_first and (before.count("{") - before.count("}")) == 1 + is_pair:
            yield TableName(match["text"], match.start(), match.end())
