"""Read the statements of a C++ source by function."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

from linkwright.review.caching import cached_in_review
from linkwright.review.sources.cpp.preprocessor import is_guard
from linkwright.review.sources.statements.literals import Statement, find_template_start, parse_statement
from linkwright.review.sources.statements.tokens import Token, TokenKind, match_brackets, tokenize_cpp

_DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n\\]|\\\r?\n|\\.)*", re.MULTILINE)
_DEFINE = re.compile(r"[ \t]*#[ \t]*define[ \t]+(?P<name>\w+)[ \t]+(?=\S)")
_EMPTY_DEFINE = re.compile(r"[ \t]*#[ \t]*(?P<word>define)[ \t]+(?P<name>\w+)\s*(?://.*|/\*.*?\*/\s*)?", re.DOTALL)
_QUALIFIERS = frozenset({"const", "final", "noexcept", "override", "try", "volatile"})
"""The words between the parameters and the body of a function."""
_SCOPES = frozenset({"namespace", "class", "struct", "union", "extern"})
_CONTROLS = frozenset({"if", "else", "for", "while", "do", "switch", "try", "catch", "case", "default", "return"})
_LABELS = frozenset({"case", "default", "public", "private", "protected", "slots", "signals"})
_OUTPUT = re.compile(
    r"(?:ROS|RCLCPP|RCUTILS|RCL|CONSOLE|LOG|NODELET|CARTOGRAPHER|GZ|IGN|SPDLOG|EXPECT|ASSERT)\w*_?\w*|gz(?:err|msg|warn|dbg)|"
    r"c(?:out|err|log)|f?printf|puts|perror|throw|static_assert|assert|spdlog|log\w*|q(?:Debug|Warning|Info|Critical)"
)
"""The first words of statements whose strings are for human readers."""


@dataclass
class _Block:
    """A block between braces.

    Attributes:
        name: the name of its function or class.
        is_function: whether it is in a function.
        pending: the tokens so far of the statement that contains the block.
    """

    name: str
    is_function: bool
    pending: list[Token] = field(default_factory=list)


@cached_in_review(maxsize=8)
def read_cpp_statements(text: str) -> Mapping[str, Sequence[Statement]]:
    """Return the statements of a source by function or class.

    Other statements have an empty name. Statements that print, log or throw are left out. The result is kept, because
    several comparisons in a row read the same two sources.
    """
    reader = _Reader()
    _read_source(text, reader)
    return {
        name: [parse_statement(tokens) for tokens in statements if len(tokens) > 1 and not is_output(tokens)]
        for name, statements in reader.blocks.items()
    }


def read_cpp_blocks(text: str) -> tuple[Mapping[str, Sequence[Sequence[Token]]], Collection[str]]:
    """Return the tokens of the statements by function or class, and the function names.

    Both are empty if the braces do not match, for example because of preprocessor branches.
    """
    reader = _Reader()
    is_balanced = _read_source(text, reader)
    reader.sort_overloads()
    return (reader.blocks, reader.functions) if is_balanced else ({}, ())


def _read_source(text: str, reader: _Reader) -> bool:
    """Read a source, and return whether its braces match."""
    for match in _DIRECTIVE.finditer(text):
        define = _DEFINE.match(match[0])
        if define is not None:
            name = tokenize_cpp(text, match.start() + define.start("name"), match.start() + define.end("name"))
            value = tokenize_cpp(text, match.start() + define.end(), match.end())
            is_function = bool(value) and value[0].start == name[0].end
            if value and not is_function:
                equals_sign = Token(TokenKind.OPERATOR, "=", value[0].start, has_space=True)
                reader.add("", [name[0], equals_sign, *value])
        defined = _EMPTY_DEFINE.fullmatch(match[0])
        if defined is not None and not is_guard(text[: match.start()], defined["name"]):
            reader.add(
                "", tokenize_cpp(text, match.start() + defined.start("word"), match.start() + defined.end("name"))
            )
    code = _DIRECTIVE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    tokens = tokenize_cpp(code)
    reader.read(tokens)
    braces = [token.text for token in tokens if token.kind is TokenKind.OPERATOR]
    return braces.count("{") == braces.count("}")


class _Reader:
    """Reads statements.

    Attributes:
        blocks: the tokens of the statements by the name of their function or class.
        functions: the names of the functions.
    """

    def __init__(self) -> None:
        self.blocks: dict[str, list[list[Token]]] = {}
        self.functions: set[str] = set()
        self._blocks = [_Block("", is_function=False)]
        self._pending: list[Token] = []
        self._starts: dict[str, list[int]] = {}
        """The index of the first statement of each overload, by the name of the function."""

    def sort_overloads(self) -> None:
        """Sort the overloads of each function by their headers, so that their order in the source does not matter."""
        for name, starts in self._starts.items():
            if len(starts) > 1:
                statements = self.blocks[name]
                overloads = [statements[start:end] for start, end in zip(starts, [*starts[1:], None], strict=True)]
                overloads.sort(key=lambda overload: [token.text for token in overload[0]])
                self.blocks[name] = [*statements[: starts[0]], *(part for overload in overloads for part in overload)]

    def add(self, name: str, tokens: Sequence[Token]) -> None:
        """Add a statement."""
        if tokens:
            self.blocks.setdefault(name, []).append(list(tokens))

    def read(self, tokens: Sequence[Token]) -> None:
        """Add the statements of a source without directives of the preprocessor."""
        pairs = match_brackets(tokens)
        value_ends: set[int] = set()  # the braces around values, not around statements
        depths = [0]
        for index, token in enumerate(tokens):
            text = token.text if token.kind is TokenKind.OPERATOR else ""
            if text == "{" and self._is_block(tokens, index, pairs):
                self._open_block()
                depths.append(0)
            elif text == "}" and index not in value_ends and len(self._blocks) > 1:
                self._close_block()
                depths.pop()
            elif (text == ";" and depths[-1] == 0) or (
                text == ":" and depths[-1] == 0 and self._pending and self._pending[0].text in _LABELS
            ):
                self._end_statement()
            else:
                if text == "{" and index in pairs:
                    value_ends.add(pairs[index])
                depths[-1] += (text in ("(", "[", "{")) - (text in (")", "]", "}"))
                self._pending.append(token)
        self._end_statement()

    def _is_block(self, tokens: Sequence[Token], index: int, pairs: dict[int, int]) -> bool:
        """Return whether a brace begins a block of statements rather than values."""
        end = pairs.get(index)
        if end is None:
            return True
        previous = tokens[index - 1].text if index else ""
        if any(token.text in _SCOPES for token in self._pending) and not _has_parenthesis(self._pending):
            return True
        return previous in (")", "else", "do", "try", "const", "override", "noexcept") or any(
            token.text == ";" for token in tokens[index:end]
        )

    def _open_block(self) -> None:
        block = self._blocks[-1]
        header = self._pending
        name, is_function, pending = block.name, block.is_function, header
        if not block.is_function:
            end = _find_macro_end(header)
            if end:
                self.add(name, header[:end])
                header = header[end:]
            scope = _find_scope_name(header)
            words = {token.text for token in header}
            if scope is not None:
                name = "::".join(part for part in (block.name, scope) if part)
            elif not words & _CONTROLS and not _has_assignment(header):
                name = "::".join(part for part in (block.name, _find_function_name(header)) if part)
                is_function = True
                self.functions.add(name)
                self._starts.setdefault(name, []).append(len(self.blocks.get(name, ())))
            self.add(name, header)
            pending = []
        self._blocks.append(_Block(name, is_function, pending))
        self._pending = []

    def _close_block(self) -> None:
        self._end_statement()
        self._pending = self._blocks.pop().pending
        if self._pending and _count_open_brackets(self._pending) == 0 and self._pending[0].text in _CONTROLS:
            self._end_statement()

    def _end_statement(self) -> None:
        self.add(self._blocks[-1].name, self._pending)
        self._pending = []


def _has_assignment(header: Sequence[Token]) -> bool:
    """Return whether a header contains ``=`` outside of parentheses and template parameters.

    Inside of them it is the default of a parameter.
    """
    pairs = match_brackets(header)
    index, depth = 0, 0
    while index < len(header):
        text = header[index].text
        depth = max(0, depth + (text == "<") - (text == ">"))
        if text == "=" and depth == 0 and (not index or header[index - 1].text != "operator"):
            return True
        index = pairs.get(index, index) + 1 if text == "(" else index + 1
    return False


def _find_macro_end(header: Sequence[Token]) -> int:
    """Return the end of the calls of macros without a semicolon before a header; 0 if there are none."""
    pairs, end = match_brackets(header), 0
    while end + 1 < len(header) and header[end].text.isupper() and header[end + 1].text == "(":
        following = pairs.get(end + 1, len(header)) + 1
        if following >= len(header) or header[following].kind is not TokenKind.WORD:
            break
        if header[following].text in _QUALIFIERS:
            break  # the header of a function with the name of a macro
        end = following
    return end


def _find_scope_name(header: Sequence[Token]) -> str | None:
    """Return the name of the class that a header opens.

    The result is empty for a namespace, and None for other blocks.
    """
    words = [token.text for token in header]
    kind = next((word for word in words if word in _SCOPES), None)
    if kind is None or _has_parenthesis(header):
        return None
    if kind in ("namespace", "extern"):
        return ""
    names = words[words.index(kind) + 1 :]
    end = next((index for index, word in enumerate(names) if word in (":", "final", "<")), len(names))
    if end > 1 and names[end - 1].isupper() and not names[end - 2].isupper():
        end -= 1  # a macro follows the name
    return names[end - 1] if end else ""


def _find_function_name(header: Sequence[Token]) -> str:
    """Return the name before the parameters in the header of a function, without template arguments."""
    index = _find_parameters_start(header)
    parts: list[str] = []
    while index > 0 and (
        not parts or parts[0] == "::" or header[index - 1].text == "::" or header[index - 1].text in ("~", "operator")
    ):
        index -= 1
        if header[index].text == ">" and parts and parts[0] == "::":
            index = find_template_start(header, index) + 1
        else:
            parts.insert(0, header[index].text)
    return "".join(parts)


def _find_parameters_start(header: Sequence[Token]) -> int:
    """Return the index of the parenthesis that opens the parameters.

    It is the first parenthesis outside of templates and macros.
    """
    pairs = match_brackets(header)
    depth = 0
    for index, token in enumerate(header):
        previous = header[index - 1].text if index else ""
        if previous != "operator":
            depth = max(0, depth + (token.text == "<") - (token.text == ">"))
        end = pairs.get(index, len(header))
        is_macro = previous.isupper() and end + 1 < len(header) and header[end + 1].kind is TokenKind.WORD
        if token.text == "(" and depth == 0 and index and not is_macro:
            return index
    return 0


def _has_parenthesis(tokens: Sequence[Token]) -> bool:
    return any(token.text == "(" for token in tokens)


def _count_open_brackets(tokens: Sequence[Token]) -> int:
    return sum((token.text in "([{") - (token.text in ")]}") for token in tokens if token.kind is TokenKind.OPERATOR)


def is_output(tokens: Sequence[Token]) -> bool:
    """Return whether a statement prints, logs or throws."""
    words = (token.text for token in tokens[:4] if token.kind is TokenKind.WORD and token.text != "std")
    first = next(words, "")
    return _OUTPUT.fullmatch(first) is not None
