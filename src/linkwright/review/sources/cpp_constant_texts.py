"""Evaluate the expressions of C++ sources that always have the same text."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from pathlib import Path

from linkwright.review.sources.cpp.text_functions import TextFunctions
from linkwright.review.sources.cpp.values import (
    TEXT,
    VARIABLE,
    InitialValues,
    find_assigned_expression,
    find_assigned_text,
    find_constants,
    find_member_expression,
)
from linkwright.review.sources.interface_types import find_cpp_type
from linkwright.review.sources.message_constants import read_message_constants
from linkwright.review.sources.name_patterns import is_sum_of_texts
from linkwright.review.sources.parameter_defaults import split_sum
from linkwright.review.sources.shared_constants import read_header_constants

_MESSAGE_CONSTANT = re.compile(r"\s*(?P<type>(?:::)?(?:\w+::)*[A-Z]\w*)::(?P<name>[A-Z][A-Z0-9_]*)\s*")
"""A constant of a message, such as ``arm_msgs::msg::Topics::STATE``."""
_MAX_DEPTH = 5
_BETWEEN_TEXTS = re.compile(r'(?<=[^\\"])"\s*\+\s*"')
_PART = re.compile(r'"[^"\\]*"|[A-Za-z_]\w*')
_NODE_NAME = r"(?:ros\s*::\s*)?this_node\s*::\s*getName\s*\(\s*\)"
_PRIVATE = re.compile(rf'[\s(]*(?:{_NODE_NAME}|(?P<variable>\w+))\s*\+\s*"/(?P<name>[^"\\]+)"[\s)]*')
"""A name below that of the node in ROS 1, which is a private one."""


class ConstantTexts:
    """The texts, constants, and variables with a certain text in a C++ source.

    Args:
        path: the path of the source.
        text: its text without comments.
        headers: the texts of the included headers of the repository.
        initial_values: the initial values of members and variables.
        read_bases: returns the texts of the headers and sources of base classes.
    """

    def __init__(
        self,
        path: Path,
        text: str,
        headers: Sequence[str],
        initial_values: InitialValues,
        read_bases: Callable[[], Sequence[str]],
    ) -> None:
        self._path = path
        self._text = text
        self._headers = headers
        self._initial_values = initial_values
        self._read_bases = read_bases
        self.own = find_constants(text)
        """The texts of the constants of the source, by name."""

    def evaluate(self, begin: int, end: int) -> str | None:
        """Return the text of the expression between two offsets, or None if it is not certain.

        The expression is a literal, a constant, a sum of these, or the call of a function that only returns a text.
        """
        expression = self._text[begin:end]
        literal = TEXT.fullmatch(expression)
        if literal is not None:
            return literal["text"]
        private = _PRIVATE.fullmatch(expression)
        if private is not None and (private["variable"] is None or self._is_node_name(private["variable"])):
            return f"~{private['name']}"
        parts = split_sum(expression)
        if len(parts) > 1 and all(map(_PART.fullmatch, parts)):
            return self._join(parts, begin)
        message = self._find_in_message(expression)
        if message is not None:
            return message
        variable = VARIABLE.fullmatch(expression)
        if variable is None:
            return self._functions.evaluate(expression)
        return self._find(variable["name"], begin)

    def expand(self, expression: str, position: int, depth: int = 0) -> str:
        """Return an expression with the sums of texts in place of the variables that have them.

        Functions that only return a member are replaced by it. Neighboring texts are joined.

        Args:
            expression: the expression.
            position: its offset.
            depth: the number of sums around it.
        """
        if depth > _MAX_DEPTH:
            return expression
        parts = [self._expand_part(part, position, depth) for part in split_sum(expression)]
        return _BETWEEN_TEXTS.sub("", " + ".join(parts))

    def _expand_part(self, part: str, position: int, depth: int) -> str:
        returned = self._functions.find_returned(part)
        if returned is not None and VARIABLE.fullmatch(returned):
            return returned
        variable = VARIABLE.fullmatch(part)
        if variable is None:
            return part
        assigned = find_assigned_expression(self._text, variable["name"], position)
        found = find_member_expression(self._text, variable["name"]) if assigned is None else (assigned, position)
        if found is None or re.search(rf"\b{variable['name']}\b", found[0]):
            return part  # unknown, or set to a sum with its old value
        expanded = self.expand(*found, depth + 1)
        return expanded if is_sum_of_texts(expanded) else part

    def _is_node_name(self, variable: str) -> bool:
        """Return whether a variable only gets the name of the node, as ``name_ = ros::this_node::getName();`` does."""
        pattern = rf"\b{variable}\s*(?:=(?!=)|[({{])\s*(?P<own>{_NODE_NAME}\s*[)}}]?\s*[;,{{])?"
        assigned = [match["own"] for match in re.finditer(pattern, self._text)]
        return bool(assigned) and None not in assigned

    def _find_in_message(self, expression: str) -> str | None:
        """Return the text of a constant of a message of the repository, or None for other expressions."""
        match = _MESSAGE_CONSTANT.fullmatch(expression)
        full_type = "" if match is None else find_cpp_type(match["type"], [self._text, *self._headers])
        if match is None or not full_type:
            return None
        return read_message_constants(self._path, *full_type.split("/")).get(match["name"])

    def _join(self, parts: Sequence[str], position: int) -> str | None:
        """Return the sum of literals and constants, or None if one of them is unknown."""
        literals = [TEXT.fullmatch(part) for part in parts]
        texts = [
            self._find(part, position) if literal is None else literal["text"]
            for part, literal in zip(parts, literals, strict=True)
        ]
        known = [text for text in texts if text is not None]
        return "".join(known) if len(known) == len(texts) else None

    def _find(self, name: str, position: int) -> str | None:
        """Return the text that a variable has at an offset, or None if it is not certain."""
        if name in self.own:
            return self.own[name]
        constant = self._shared.get(name)
        constant = self._initial_values.find_text(name) if constant is None else constant
        return find_assigned_text(self._text, name, position) if constant is None else constant

    @cached_property
    def _functions(self) -> TextFunctions:
        return TextFunctions([self._text, *self._headers, *self._read_bases()], {**self._shared, **self.own})

    @cached_property
    def _shared(self) -> Mapping[str, str]:
        """The constants of included headers that the source does not define otherwise."""
        constants = read_header_constants(self._headers)
        assigned = set(re.findall(r"\b(\w+)\s*(?:\[[^\]]*\]\s*)?(?:=(?!=)|[{(]\s*\")", self._text))
        return {name: text for name, text in constants.items() if name not in assigned}
