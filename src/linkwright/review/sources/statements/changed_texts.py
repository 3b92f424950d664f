"""Compare the texts of several lines in two versions of a source, line by line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from difflib import SequenceMatcher
from pathlib import Path
from typing import NamedTuple

from linkwright.diagnostics import Phrase, joined, joined_first, phrase
from linkwright.review.sources.names import CPP_SUFFIXES
from linkwright.review.sources.reading import try_read_source
from linkwright.review.sources.statements.long_texts import LongText, read_cpp_texts, read_python_texts
from linkwright.review.texts.excerpts import differing_excerpts, shorten_middle

_MAX_LINES = 8
"""The maximum number of lines that a sentence shows of each kind."""
_MAX_LINE_LENGTH = 120
_MIN_SIMILARITY = 0.5
_MIN_COMMON_SHARE = 0.3
"""The minimum share of the words of the shorter version that both versions of a text have."""
_MAX_COMPARED_LINES = 5000


class TextChange(NamedTuple):
    """The changed lines of a text.

    Attributes:
        sentence: the changed lines.
        line: the number of the first one in the source.
        is_old: whether the number counts in the old version.
    """

    sentence: Phrase
    line: int
    is_old: bool


def find_text_changes(old_path: Path, new_path: Path) -> Iterator[TextChange]:
    """Yield the texts of several lines whose lines differ.

    Texts are paired by the function that contains them and the name that gets them.
    """
    sources = try_read_source(old_path), try_read_source(new_path)
    if sources[0] is None or sources[1] is None:
        return
    read = read_cpp_texts if new_path.suffix in CPP_SUFFIXES else read_python_texts
    try:
        old_texts, new_texts = (list(read(source)) for source in sources if source is not None)
    except (ValueError, SyntaxError, RecursionError):
        return
    for key in dict.fromkeys((text.scope, text.name) for text in new_texts):
        before = [text for text in old_texts if (text.scope, text.name) == key]
        after = [text for text in new_texts if (text.scope, text.name) == key]
        common = [text.lines for text in before if any(text.lines == other.lines for other in after)]
        before, after = ([text for text in texts if text.lines not in common] for texts in (before, after))
        if len(before) == len(after):
            yield from (_compare(*pair) for pair in zip(before, after, strict=True) if _are_versions(*pair))


def _are_versions(old: LongText, new: LongText) -> bool:
    """Return whether two texts are probably versions of one text."""
    if max(len(old.lines), len(new.lines)) > _MAX_COMPARED_LINES:
        return False
    old_words, new_words = (" ".join(text.lines).split() for text in (old, new))
    blocks = SequenceMatcher(None, old_words, new_words, autojunk=False).get_matching_blocks()
    return sum(block.size for block in blocks) >= _MIN_COMMON_SHARE * min(len(old_words), len(new_words))


def _compare(old: LongText, new: LongText) -> TextChange:
    """Return the change to a text whose lines differ."""
    replaced: list[Phrase] = []
    added: list[str] = []
    removed: list[str] = []
    first: tuple[int, bool] | None = None
    for kind, a, b, c, d in SequenceMatcher(None, old.lines, new.lines, autojunk=False).get_opcodes():
        if kind == "equal":
            continue
        first = first or ((new.numbers[c], False) if c < d else (old.numbers[a], True))
        rows = old.lines[a:b], new.lines[c:d]
        if len(rows[0]) == len(rows[1]) and all(map(_are_similar, *rows)):
            for pair in zip(*rows, strict=True):
                before, after = differing_excerpts(*pair, _MAX_LINE_LENGTH)
                replaced.append(phrase("{old} -> {new}", old=f"`{before}`", new=f"`{after}`"))
        else:
            removed += rows[0]
            added += rows[1]
    line, is_old = first or (new.numbers[0], False)
    parts = [joined_first(replaced, _MAX_LINES)] if replaced else []
    parts += [phrase("{items} added", items=_join_lines(added))] if added else []
    parts += [phrase("{items} removed", items=_join_lines(removed))] if removed else []
    return TextChange(_format(new, joined(parts, "; ")), line, is_old)


def _format(text: LongText, changes: Phrase) -> Phrase:
    name = f"{text.scope}: {text.name}" if text.scope and text.name else text.name or text.scope
    if not name:
        return phrase("lines of a text: {changes}", changes=changes)
    return phrase("lines of a text in {name}: {changes}", name=name, changes=changes)


def _join_lines(lines: Sequence[str]) -> Phrase:
    return joined_first([f"`{shorten_middle(line, _MAX_LINE_LENGTH)}`" for line in lines], _MAX_LINES)


def _are_similar(old: str, new: str) -> bool:
    return SequenceMatcher(None, old, new, autojunk=False).ratio() >= _MIN_SIMILARITY
