"""Find published messages that no longer get a frame."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from linkwright.diagnostics import phrase, quoted_names
from linkwright.review.sources.statements.code import Code, Part
from linkwright.review.sources.statements.frame_changes import FrameChange, join_operators

_FRAMED = re.compile(r"(?<![\w.>])(?P<name>[A-Za-z_]\w*)(?:\.|->)header(?:\.|->)frame_id =(?!=)")
_SENT = re.compile(r"(?:\bpublish\w*|\bsend\w*)\(", re.IGNORECASE)
_TYPE = r"(?:const )?[A-Za-z_][\w:]*(?: ?<.*>)?(?:::\w+)*[ *&]+"


@dataclass
class _Message:
    """A message of a function: a variable from one declaration to the next.

    Attributes:
        line: the line of the declaration, or of the first use.
        has_frame: whether the function sets its frame, or may do so.
        is_sent: whether the function publishes it.
    """

    line: int
    has_frame: bool = False
    is_sent: bool = False


def find_lost_message_frames(old: Code, new: Code) -> Iterator[FrameChange]:
    """Yield the published messages of each function whose frame only the old version sets."""
    for name, parts in new.functions.items():
        old_parts = old.functions.get(name, [])
        variables = {match["name"] for part in old_parts for match in _FRAMED.finditer(join_operators(part.text))}
        lost: dict[str, int] = {}
        for variable in sorted(variables):
            before, after = ([each for each in _read(side, variable) if each.is_sent] for side in (old_parts, parts))
            without = [[each for each in side if not each.has_frame] for side in (before, after)]
            if len(after) <= len(before) and len(without[1]) > len(without[0]):
                lost[variable] = without[1][0].line
        if lost:
            sentence = phrase("frame_id of {names} is no longer set", names=quoted_names(lost))
            reason = phrase("programs that transform the messages do not find an empty frame")
            yield FrameChange(sentence, min(lost.values()), reason)


def _read(parts: Sequence[Part], variable: str) -> list[_Message]:
    """Return the messages that a variable is in a function, in their order."""
    word = re.compile(rf"(?<![\w.>]){variable}(?!\w)")
    typed = rf"\A{_TYPE}{variable}(?= = |;?\Z|[({{])"
    declaration = re.compile(rf"{typed}|\A{variable} = (?!.*\b{variable}\b)")
    whole = re.compile(rf"(?<![\w.>]){variable}(?:(?:\.|->)header)?(?:(?:\.|->)frame_id)? =(?!=)")
    passed = re.compile(rf"[(,] ?[&*]?(?:\w+::move\()?{variable} ?[,)]")
    messages: list[_Message] = []
    for part in parts:
        text = join_operators(part.text)
        if word.search(text) is None:
            continue
        if declaration.match(text) is not None:
            messages.append(_Message(part.first_line, has_frame="header" in text or "frame" in text))
            continue
        if not messages:
            messages.append(_Message(part.first_line))
        if _SENT.search(text) is not None:
            messages[-1].is_sent = True
        elif whole.search(text) is not None or passed.search(text) is not None:
            messages[-1].has_frame = True
    return messages
