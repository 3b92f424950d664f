"""Parser for command lines that call xacro."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkwright.loading.deferred import lazy_pattern
from linkwright.packages.readers.xacro_calls.texts import Placeholder, Share, Text, join_texts, make_literal

_PROGRAM = lazy_pattern(r"(^|/)xacro(\.py)?$")
_NAME = lazy_pattern(r"[A-Za-z_][\w.-]*:=")
_COMMAND_END = lazy_pattern(r"^(\d?>.*|[|;]|&&)$")
_OPTIONS_WITH_VALUE = frozenset({"-o", "--output"})


def parse_xacro_command(line: Text) -> tuple[Text, dict[str, Text]] | None:
    """Return the file and the arguments of a command line that calls xacro.

    The result is None for other command lines. Words with unknown contents become an argument without a name.
    """
    words = list(_split_words(line))
    start = next((index for index, word in enumerate(words) if _is_program(word)), None)
    if start is None:
        return None
    path: Text | None = None
    arguments: dict[str, Text] = {}
    word_iterator = iter(words[start + 1 :])
    for word in word_iterator:
        first = word[0] if word and isinstance(word[0], str) else ""
        if _COMMAND_END.match(first):
            break
        if first in _OPTIONS_WITH_VALUE:
            next(word_iterator, None)
        elif _NAME.match(first):
            name, _, value = first.partition(":=")
            arguments[name] = _unquote((*make_literal(value), *word[1:]))
        elif word and not first.startswith("-") and path is None and not _is_program(word):
            path = _unquote(word)
        elif word and not isinstance(word[0], str):
            arguments[""] = (*arguments.get("", ()), *word, " ")
    return None if path is None else (path, arguments)


def _is_program(word: Text) -> bool:
    """Return whether a word is ``xacro`` or a path of this program."""
    return bool(word) and isinstance(word[-1], str) and _PROGRAM.search(word[-1]) is not None and len(word) <= 2


def _split_words(line: Text) -> Iterator[Text]:
    """Yield the words of a command line.

    Quotes protect whitespace, and are preserved in the words.
    """
    word: list[Text] = []
    quote = ""
    for piece in line:
        if not isinstance(piece, str):
            word.append((piece,))
            continue
        start = 0
        for index, letter in enumerate(piece):
            if quote:
                quote = "" if letter == quote else quote
            elif letter in "\"'":
                quote = letter
            elif letter.isspace():
                word.append(make_literal(piece[start:index]))
                start = index + 1
                if any(word):
                    yield _join_pieces(word)
                word = []
        word.append(make_literal(piece[start:]))
    if any(word):
        yield _join_pieces(word)


def _join_pieces(parts: Iterable[Text]) -> Text:
    """Concatenate texts, and merge adjacent strings."""
    pieces: list[str | Share | Placeholder] = []
    for piece in join_texts(parts):
        previous = pieces[-1] if pieces else None
        if isinstance(piece, str) and isinstance(previous, str):
            pieces[-1] = previous + piece
        else:
            pieces.append(piece)
    return tuple(pieces)


def _unquote(word: Text) -> Text:
    """Return a word without the surrounding quotes that a shell would remove."""
    if not word:
        return word
    first, last = word[0], word[-1]
    if isinstance(first, str) and isinstance(last, str) and first[:1] in ("'", '"') and last[-1:] == first[:1]:
        if len(word) == 1:
            return make_literal(first[1:-1])
        return (*make_literal(first[1:]), *word[1:-1], *make_literal(last[:-1]))
    return word
