"""Compare the literals in two versions of a statement."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.review.sources.statements.tokens import Token, TokenKind, join_tokens, match_brackets
from linkwright.review.texts.excerpts import differing_excerpts
from linkwright.review.texts.list_changes import change_text

_LITERAL_MARK = "\0"
"""The mark for a literal in the shape of a statement. Sources do not contain this character."""
_LITERAL_WORDS = frozenset({"True", "False", "true", "false", "None", "nullptr"})
_BOOLEAN_NUMBERS = {"True": "1", "true": "1", "False": "0", "false": "0"}
_CONSTANT = re.compile(r"_?[A-Z][A-Z0-9_]+")
_JOINERS = frozenset({".", "::", "->"})
_ASSIGNMENTS = frozenset({"=", "+=", "-=", "*=", "/=", "%=", "|=", "&=", "//=", "**=", ":="})
_DELIMITERS = frozenset({",", ";", ":", "?", *_ASSIGNMENTS})
_KEYWORDS = frozenset(
    {
        *("return", "yield", "case", "in", "is", "and", "or", "not", "if", "else", "elif", "while", "for", "assert"),
        *("lambda", "switch", "throw", "raise", "co_return", "del", "await"),
    }
)
_COMPARISONS = frozenset({"==", "!=", "<", ">", "<=", ">="})
_SIGNS = frozenset({"-", "+"})
_CONSTANT_OPERATORS = frozenset({"+", "-", "*", "/", "(", ")", "[", "]", "{", "}", ",", ".", "::"})
_CONSTANT_WORDS = frozenset({"math", "np", "numpy", "pi", "std", "numbers"})
"""The operators and names of an expression whose value depends on no variable."""
_MIN_PROSE_WORDS = 3
"""The minimum number of words of a sentence for human readers."""
_HASH = re.compile(r'"[0-9a-fA-F]{32,}"')
TEXTS_FOR_READERS = frozenset({"help", "description", "epilog", "doc", "metavar", "usage"})
"""The keyword arguments whose strings are for human readers."""
_MAX_TEMPLATE_TOKENS = 40
"""The maximum number of tokens in the arguments of a template."""
_MAX_FIRST_ARGUMENT_CHARACTERS = 30
"""The maximum number of characters of the shown first argument of a call, which often names the thing."""
_MAX_EXPRESSION_CHARACTERS = 60
"""The maximum number of characters of the shown expression around a literal."""


_MATHEMATICAL = {"M_PI": math.pi, "M_PI_2": math.pi / 2, "M_PI_4": math.pi / 4, "M_E": math.e}
"""The values of constants of mathematics in C and C++."""
_ROUNDING = 1e-3
"""The relative difference of a rounded constant of mathematics."""


class Literal(NamedTuple):
    """A literal in a statement.

    Attributes:
        value: the text by which versions are compared, such as a string without quotation marks.
        first: the index of its first token.
        last: the index of its last token.
        constant: the text before the last name of a constant, such as ``Mode.``; a dot if there is none;
            empty for other literals.
    """

    value: str
    first: int
    last: int
    constant: str = ""

    @property
    def is_text(self) -> bool:
        """Whether the literal is a string."""
        return self.value.startswith('"')

    def differs_from(self, other: Literal) -> bool:
        """Return whether two literals have different values of the same kind.

        A constant may have any value, except for those of mathematics.
        """
        numbers = [_MATHEMATICAL.get(item.value) or _parse_number(item.value) for item in (self, other)]
        if self.constant != other.constant and None not in numbers:
            first, second = (number or 0.0 for number in numbers)
            return abs(first - second) > _ROUNDING * max(abs(first), abs(second))
        return self.value != other.value and self.constant == other.constant


class Difference(NamedTuple):
    """A literal or an argument that differs between two versions of a statement.

    Attributes:
        text: the difference with the code around it, such as ``self.rate 10 -> 20``.
        old: the old literal or argument; empty if an argument was added.
        new: the new literal or argument; empty if an argument was removed.
        token: the first token of the new literal, or of the arguments.
    """

    text: str
    old: str
    new: str
    token: Token


class Statement(NamedTuple):
    """A statement of a source.

    Attributes:
        tokens: the tokens of the statement.
        literals: the literals that are compared.
        shape: the text of the statement with a mark for each of these literals.
    """

    tokens: tuple[Token, ...]
    literals: tuple[Literal, ...]
    shape: str

    @property
    def key(self) -> tuple[str, ...]:
        """The texts by which equal statements are found."""
        return (self.shape, *(literal.value for literal in self.literals))

    def get_text(self, first: int, last: int) -> str:
        """Return the text of the tokens from a first to a last index, both included."""
        return join_tokens(self.tokens[first : last + 1])


def _parse_number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def parse_statement(tokens: Sequence[Token]) -> Statement:
    """Return the statement that the tokens form."""
    literals = tuple(_find_literals(tokens))
    parts: list[str] = []
    index = 0
    starts = {literal.first: literal for literal in literals}
    while index < len(tokens):
        literal = starts.get(index)
        if literal is not None:
            parts.append(_LITERAL_MARK)
            index = literal.last + 1
            continue
        is_last_comma = tokens[index].text == "," and tokens[index + 1 : index + 2] and tokens[index + 1].text in ")]}"
        if not is_last_comma:
            parts.append(tokens[index].text)
        index += 1
    return Statement(tuple(tokens), literals, " ".join(parts))


def _find_literals(tokens: Sequence[Token]) -> Iterator[Literal]:
    """Yield the literals of a statement, except keys and assigned names."""
    index = start = _find_assignment_end(tokens)
    pairs = match_brackets(tokens)
    while index < len(tokens):
        last = _find_list_end(tokens, index, pairs)
        if last is None:
            last = _find_literal_end(tokens, index)
        if last is not None and not _is_key(tokens, last) and not _is_for_readers(tokens, index, last, start):
            # the kind of a number decides how it is divided
            is_divided = "/" in (
                tokens[index - 1].text if index else "",
                *(token.text for token in tokens[last + 1 : last + 2]),
            )
            is_constant = tokens[index].kind is TokenKind.WORD and tokens[index].text not in _LITERAL_WORDS
            constant = join_tokens(tokens[index:last]) or "." if is_constant else ""
            yield Literal(_normalize_literal(tokens[index : last + 1], is_divided=is_divided), index, last, constant)
        index = index + 1 if last is None else last + 1


def _find_assignment_end(tokens: Sequence[Token]) -> int:
    """Return the index of the first token after the last assignment outside of brackets, or 0."""
    depth = end = 0
    for index, token in enumerate(tokens):
        if token.kind is TokenKind.OPERATOR:
            depth += (token.text in "([{") - (token.text in ")]}")
            if depth == 0 and token.text in _ASSIGNMENTS:
                end = index + 1
    return end


def _find_list_end(tokens: Sequence[Token], index: int, pairs: dict[int, int]) -> int | None:
    """Return the index of the bracket that closes a list of literals, or None."""
    end = pairs.get(index, -1)
    if tokens[index].text not in ("[", "(", "{") or end < index + 2:
        return None
    if index and (tokens[index - 1].kind is TokenKind.WORD or tokens[index - 1].text in (")", "]", ">")):
        is_after_keyword = tokens[index - 1].text in _KEYWORDS
        if not is_after_keyword:
            return None  # arguments, or the index of an item
    position, count = index + 1, 0
    while position < end:
        last = _find_list_end(tokens, position, pairs)
        if last is None and tokens[position].kind is not TokenKind.WORD:
            last = _find_literal_end(tokens, position)
        elif last is None and tokens[position].text in _LITERAL_WORDS:
            last = position
        if last is None or tokens[last + 1].text not in (",", *")]}"):
            return None
        count += 1
        position = last + (2 if tokens[last + 1].text == "," else 1)
    is_grouped = tokens[index].text == "(" and count == 1
    return None if is_grouped else end


def _find_literal_end(tokens: Sequence[Token], index: int) -> int | None:
    """Return the index of the last token of a literal, or None if none begins here."""
    token = tokens[index]
    if token.kind is TokenKind.NUMBER or token.text in _LITERAL_WORDS:
        return index
    if token.kind is TokenKind.TEXT:
        if "f" in token.text[: token.text.find(token.text[-1])].lower():
            return None
        while index + 1 < len(tokens) and tokens[index + 1].kind is TokenKind.TEXT:
            index += 1
        return index
    if token.text in _SIGNS and index + 1 < len(tokens) and tokens[index + 1].kind is TokenKind.NUMBER:
        previous = tokens[index - 1] if index else None
        is_sign = (
            previous is None
            or (previous.kind is TokenKind.OPERATOR and previous.text not in (")", "]"))
            or previous.text in _KEYWORDS
        )
        return index + 1 if is_sign else None
    return _find_constant_end(tokens, index)


def _find_constant_end(tokens: Sequence[Token], index: int) -> int | None:
    """Return the index of the last token of a constant such as ``Mode.FAST``, or None."""
    if tokens[index].kind is not TokenKind.WORD or tokens[index].text in _KEYWORDS:
        return None
    previous = tokens[index - 1] if index else None
    is_type = previous is not None and previous.kind is TokenKind.WORD and previous.text not in _KEYWORDS
    if previous is None or previous.text in _JOINERS or previous.text in ("<", "@", "#", "*", "&") or is_type:
        return None
    last = index
    while last + 2 < len(tokens) and tokens[last + 1].text in _JOINERS and tokens[last + 2].kind is TokenKind.WORD:
        last += 2
        if tokens[last - 1].text == "->":
            return None
    following = tokens[last + 1].text if last + 1 < len(tokens) else ""
    is_name = following in ("(", "[", "{", "<", *_JOINERS, *_ASSIGNMENTS)
    is_type = last + 1 < len(tokens) and tokens[last + 1].kind is TokenKind.WORD and following not in _KEYWORDS
    return last if _CONSTANT.fullmatch(tokens[last].text) and not is_name and not is_type else None


def _is_key(tokens: Sequence[Token], last: int) -> bool:
    """Return whether a literal is the key of an entry: ``'angle': 1.57``."""
    is_text = tokens[last].kind is TokenKind.TEXT
    return is_text and last + 2 < len(tokens) and tokens[last + 1].text == ":"


def _is_for_readers(tokens: Sequence[Token], first: int, last: int, start: int) -> bool:
    """Return whether a literal is a string for human readers.

    A sentence that is assigned to a member, such as the field of a message, is a value.

    Args:
        tokens: the tokens of the statement.
        first: the index of the first token of the literal.
        last: the index of the last token of the literal.
        start: the index of the first token after the last assignment, or 0.
    """
    if any(token.kind is not TokenKind.TEXT for token in tokens[first : last + 1]):
        return False
    is_named = first > 1 and tokens[first - 1].text == "=" and tokens[first - 2].text.lower() in TEXTS_FOR_READERS
    is_formatted = last + 1 < len(tokens) and tokens[last + 1].text in ("%", ".")
    value = _normalize_literal(tokens[first : last + 1])
    is_member = 2 < start == first and tokens[start - 3].text in _JOINERS
    is_assigned = is_member and all(token.text == ";" for token in tokens[last + 1 :])
    is_sentence = len(value.split(None, _MIN_PROSE_WORDS)) >= _MIN_PROSE_WORDS
    is_of_several_lines = "\n" in value or "\\n" in value
    return (
        is_named
        or is_formatted
        or (is_sentence and (not is_assigned or is_of_several_lines))
        or _HASH.fullmatch(value) is not None
    )


def _normalize_literal(tokens: Sequence[Token], *, is_divided: bool = False) -> str:
    """Return a literal without spaces, kind of quotation marks and trailing comma."""
    parts: list[str] = []
    for index, token in enumerate(tokens):
        if token.kind is TokenKind.TEXT:
            quote = token.text[-1]
            content = token.text[token.text.find(quote) :]
            length = 3 if content.startswith(quote * 3) and len(content) >= 6 else 1
            parts.append(f'"{content[length:-length]}"')
        elif token.text == "," and tokens[index + 1].text in ")]}":
            continue
        else:
            text = _BOOLEAN_NUMBERS.get(token.text, token.text)
            parts.append(normalize_number(text, is_divided=is_divided) if token.kind is TokenKind.NUMBER else text)
    return "".join(parts).replace('""', "") or '""'


def normalize_number(text: str, *, is_divided: bool) -> str:
    """Return a number in normalized form.

    ``0.20`` becomes ``.2``, and ``1.0`` becomes ``1`` unless it is divided.
    """
    match = re.fullmatch(r"(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)[fFlLuU]*", text.replace("'", ""))
    if match is None:
        return text.lower()
    is_real = is_divided and not match["number"].isdigit()
    return f"{float(match['number']):.12g}{'.' if is_real else ''}"


# --- reports --------------------------------------------------------------------------------------------------------


def find_literal_differences(old: Statement, new: Statement) -> Iterator[Difference]:
    """Yield the literals that differ between two statements of the same shape."""
    pairs = list(zip(old.literals, new.literals, strict=True))
    brackets = match_brackets(new.tokens)
    changed = [pair for pair in pairs if pair[0].differs_from(pair[1])]
    index = 0
    while index < len(changed):
        (old_literal, new_literal) = changed[index]
        start, end = find_expression(new.tokens, new_literal, brackets)
        group = [pair for pair in changed[index:] if pair[1].last <= end]
        index += len(group)
        texts = (old.get_text(old_literal.first, old_literal.last), new.get_text(new_literal.first, new_literal.last))
        token = new.tokens[new_literal.first]
        is_compared = start == new_literal.first or new.tokens[new_literal.first - 1].text in _COMPARISONS
        if len(group) == 1 and end == new_literal.last and is_compared:
            before = new.get_text(start, new_literal.first - 1)
            expression = f"{before}{' ' if before and token.has_space else ''}{texts[0]} -> {texts[1]}"
        else:
            first, last = old_literal.first - (new_literal.first - start), group[-1][0].last + end - group[-1][1].last
            expression = " -> ".join(differing_excerpts(old.get_text(first, last), new.get_text(start, end)))
        if len(expression) > 2 * _MAX_EXPRESSION_CHARACTERS and len(group) == 1:
            expression = " -> ".join(differing_excerpts(*texts))
        if (
            len(expression) > 2 * _MAX_EXPRESSION_CHARACTERS
            and new_literal.last > new_literal.first
            and len(group) == 1
        ):
            label = add_context(new, start, end, "[...]", brackets)
            yield Difference(change_text(label, *map(_format_list, texts)), *texts, token)
            continue
        yield Difference(add_context(new, start, end, expression, brackets), *texts, token)


def find_expression_difference(old: Statement, new: Statement) -> Iterator[Difference]:
    """Yield the expression of numbers and constants that an assignment has in place of another one."""
    starts = _find_assignment_end(old.tokens), _find_assignment_end(new.tokens)
    if not all(starts) or old.get_text(0, starts[0] - 1) != new.get_text(0, starts[1] - 1):
        return
    values = [
        [token for token in statement.tokens[start:] if token.text != ";"]
        for statement, start in zip((old, new), starts, strict=True)
    ]
    if not all(_is_constant_expression(tokens) for tokens in values):
        return
    texts = join_tokens(values[0]), join_tokens(values[1])
    shown = texts if sum(map(len, texts)) <= 2 * _MAX_EXPRESSION_CHARACTERS else differing_excerpts(*texts)
    name = _find_name_before(new.tokens, starts[1] - 2, match_brackets(new.tokens))
    yield Difference(f"{name} {shown[0]} -> {shown[1]}".strip(), *texts, values[1][0])


def _is_constant_expression(tokens: Sequence[Token]) -> bool:
    """Return whether tokens are one expression, not several with commas between them, as in an enumeration."""
    depth = 0
    for token in tokens:
        depth += (token.text in "([{") - (token.text in ")]}")
        if not _is_of_constant_expression(token) or (token.text == "," and depth == 0):
            return False
    return bool(tokens)


def _is_of_constant_expression(token: Token) -> bool:
    if token.kind is TokenKind.OPERATOR:
        return token.text in _CONSTANT_OPERATORS
    is_constant = _CONSTANT.fullmatch(token.text) is not None or token.text in _CONSTANT_WORDS
    return token.kind is TokenKind.NUMBER or (token.kind is TokenKind.WORD and is_constant)


def format_literal(statement: Statement, literal: Literal) -> str:
    """Return a literal with the code around it, such as ``sensor["type"]``, ``name == "left"`` or ``"type" in sensor``.

    The result has the called function only if the literal is an argument.
    """
    tokens = statement.tokens
    brackets = match_brackets(tokens)
    start, end = find_expression(tokens, literal, brackets)
    end -= tokens[end].text == "not"
    if (start, end) != (literal.first, literal.last):
        return statement.get_text(start, end)
    before, after = start - 1, end + 1
    if before > 0 and tokens[before].text == "in":
        before -= tokens[before - 1].text == "not"
        first = brackets.get(before - 1, before - 1)
        start, _ = find_expression(tokens, Literal("", first, before - 1), brackets)
        return statement.get_text(start, end)
    after += after < len(tokens) and tokens[after].text == "not"
    if after + 1 < len(tokens) and tokens[after].text == "in":
        _, end = find_expression(tokens, Literal("", after + 1, brackets.get(after + 1, after + 1)), brackets)
        return statement.get_text(start, end)
    return add_context(statement, start, end, statement.get_text(start, end), brackets)


def _format_list(text: str) -> str:
    return f"[{text.strip()[1:-1].strip().rstrip(',')}]"


def find_expression(tokens: Sequence[Token], literal: Literal, brackets: dict[int, int]) -> tuple[int, int]:
    """Return the first and last token of the expression around a literal.

    The expression ends at the brackets around the literal.
    """
    start, end = literal.first, literal.last
    is_in_template = end + 1 < len(tokens) and tokens[end + 1].text == ">" and start > 0
    if is_in_template and tokens[start - 1].text in ("<", ","):
        return start, end
    while start > 0 and not _ends_expression(tokens[start - 1]):
        if tokens[start - 1].text in ")]}" and tokens[start - 1].kind is TokenKind.OPERATOR:
            if start - 1 not in brackets:
                break
            start = brackets[start - 1]
        else:
            start -= 1
            if tokens[start].text in "([{" and tokens[start].kind is TokenKind.OPERATOR:
                start += 1
                break
    while end + 1 < len(tokens) and not _ends_expression(tokens[end + 1]):
        if tokens[end + 1].kind is TokenKind.OPERATOR and tokens[end + 1].text in ")]}":
            break
        end = brackets.get(end + 1, end + 1)
    return start, end


def _ends_expression(token: Token) -> bool:
    is_keyword = token.kind is TokenKind.WORD and token.text in _KEYWORDS - {"not"}
    return is_keyword or (token.kind is TokenKind.OPERATOR and token.text in (*_DELIMITERS, "&&", "||"))


def add_context(new: Statement, start: int, end: int, expression: str, brackets: dict[int, int]) -> str:
    """Return a changed expression with the assigned name or the called function."""
    tokens = new.tokens
    before = tokens[start - 1] if start else None
    opening = next((index for index in range(start - 1, -1, -1) if brackets.get(index, -1) > end), None)
    if before is not None and before.text == ":" and opening is not None and tokens[opening].text == "{":
        return f"{_find_entry_path(tokens, start - 1, brackets)} {expression}"
    if before is None or before.kind is TokenKind.WORD:
        word = before.text if before is not None and before.text in ("return", "case") else ""
        return f"{word} {expression}".strip()
    if before.text in _ASSIGNMENTS:
        name = _find_name_before(tokens, start - 2, brackets)
        if opening is None or tokens[opening].text != "(":
            sign = "" if before.text in ("=", ":=") else f"{before.text} "
            return f"{name} {sign}{expression}".strip()
        expression = f"{name}={expression}"
        start -= 2
    return expression if opening is None else _format_argument(tokens, opening, (start, end), expression, brackets)


def _format_argument(
    tokens: Sequence[Token], opening: int, changed_range: tuple[int, int], expression: str, brackets: dict[int, int]
) -> str:
    """Return a changed expression with the function or list around it."""
    name = _find_name_before(tokens, opening - 1, brackets)
    if not name or tokens[opening - 1].text in _KEYWORDS:
        return expression
    closing = brackets[opening]
    if tokens[opening].text == "{" and (opening, closing) == (changed_range[0] - 1, changed_range[1] + 1):
        return f"{name} {expression}"
    commas = _find_commas(tokens, opening, changed_range[0], brackets)
    left_text = "..., " if commas else ""
    if commas and tokens[opening].text == "(":
        first = join_tokens(tokens[opening + 1 : commas[0]])
        if len(first) <= _MAX_FIRST_ARGUMENT_CHARACTERS:
            left_text = f"{first}, " if len(commas) == 1 else f"{first}, ..., "
    right_text = "" if closing == changed_range[1] + 1 else ", ..."
    return f"{name}{tokens[opening].text}{left_text}{expression}{right_text}{tokens[closing].text}"


def _find_commas(tokens: Sequence[Token], opening: int, end: int, brackets: dict[int, int]) -> list[int]:
    """Return the indexes of the commas between an opening bracket and an index."""
    commas = []
    index = opening + 1
    while index < end:
        if tokens[index].text == "," and tokens[index].kind is TokenKind.OPERATOR:
            commas.append(index)
        index = max(brackets.get(index, index), index) + 1
    return commas


def _find_entry_path(tokens: Sequence[Token], colon: int, brackets: dict[int, int]) -> str:
    """Return the path of a dictionary entry: the assigned name of the dictionary and the keys."""
    keys: list[str] = []
    while True:
        key = tokens[colon - 1]
        keys.insert(0, key.text.strip("\"'") if key.kind is not TokenKind.OPERATOR else "...")
        opening = next((index for index in range(colon - 1, -1, -1) if brackets.get(index, -1) > colon), None)
        if opening is None or opening < 2 or tokens[opening - 1].text != ":":
            break
        colon = opening - 1
    is_assigned = opening is not None and opening > 1 and tokens[opening - 1].text == "="
    name = _find_name_before(tokens, opening - 2, brackets) if is_assigned and opening is not None else ""
    return f"{name} {'.'.join(keys)}".strip()


def _find_name_before(tokens: Sequence[Token], index: int, brackets: dict[int, int]) -> str:
    """Return the name that ends at an index; empty if there is none.

    Names may be ``self.rate`` or ``items[0]``.
    """
    parts: list[Token] = []
    while index >= 0:
        token = tokens[index]
        if token.kind is TokenKind.OPERATOR and token.text in ("]", ")") and index in brackets:
            parts[:0] = tokens[brackets[index] : index + 1]
            index = brackets[index] - 1
            continue
        if token.text == ">" and not parts:
            index = find_template_start(tokens, index)
            continue
        if token.kind is TokenKind.OPERATOR or token.text in _KEYWORDS:
            break
        parts.insert(0, token)
        index -= 1
        if index < 0 or tokens[index].text not in _JOINERS:
            break
        parts.insert(0, tokens[index])
        index -= 1
    name = join_tokens(parts)
    if index > 0 and tokens[index].text == ":" and tokens[index - 1].kind is TokenKind.WORD:
        name = _find_name_before(tokens, index - 1, brackets)  # the name before an annotation
    return name if len(name) <= _MAX_EXPRESSION_CHARACTERS else ""


def find_template_start(tokens: Sequence[Token], index: int) -> int:
    """Return the index before template arguments that end at an index, or -1."""
    depth = 0
    for start in range(index, max(index - _MAX_TEMPLATE_TOKENS, -1), -1):
        text = tokens[start].text
        depth += (text == ">") - (text == "<")
        if depth <= 0:
            return start - 1
    return -1
