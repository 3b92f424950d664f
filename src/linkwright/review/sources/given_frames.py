"""Find names that parameters give: frames that a literal named before, and names of added publishers and the like."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.review.sources.details import format_name
from linkwright.review.sources.names import DefaultName, Detail, NameKind, SourceName, SourceNames

_KINDS = (NameKind.FRAME, NameKind.MESSAGE_FRAME, NameKind.FRAME_LOOKUP)
_ASSIGNED = re.compile(r"(?P<target>[\w.\[\]>-]*\bframe_id_?)\s*=(?!=)\s*(?P<literal>[\"'](?P<text>[^\"'\n]*)[\"'])?")


class GivenFrame(NamedTuple):
    """The parameter that gives a frame now.

    Attributes:
        default: the parameter and the frame by default.
        span: the place where the new source reads the parameter.
    """

    default: DefaultName
    span: Span


def find_given_frame(
    removed: Sequence[SourceName], old: SourceNames, new: SourceNames, texts: tuple[str, str]
) -> GivenFrame | None:
    """Return the parameter that gives the only removed frame now, or None if it is not certain.

    Args:
        removed: the names of a kind that the new source no longer has.
        old: the names in the old source.
        new: the names in the new source.
        texts: the texts of the old and the new source.
    """
    if len(removed) != 1 or removed[0].kind not in _KINDS:
        return None
    known = {item.parameter for item in old.default_names}
    given = [item for item in new.default_names if item.kind is removed[0].kind and item.parameter not in known]
    if len(given) != 1 or not _has_target(removed[0].name, *texts):
        return None
    reads = (item for item in new.of_kind(NameKind.PARAMETER) if item.name.lstrip("~/.") == given[0].parameter)
    read = next(reads, None)
    return None if read is None else GivenFrame(given[0], read.span)


def _has_target(frame: str, old_text: str, new_text: str) -> bool:
    """Return whether a message that got a literal frame gets another expression now; True if no message got it."""
    targets = {match["target"] for match in _ASSIGNED.finditer(old_text) if match["text"] == frame}
    computed = {match["target"] for match in _ASSIGNED.finditer(new_text) if match["literal"] is None}
    return not targets or not targets.isdisjoint(computed)


def format_given(item: SourceName, default: DefaultName) -> Phrase:
    """Return the sentence about a name that a parameter gives now."""
    return phrase(
        "{kind} {name} comes from parameter '{parameter}' now ('{default}' by default)",
        kind=item.kind.title,
        name=format_name(item),
        parameter=default.parameter,
        default=default.name,
    )


def take_given(expressions: list[SourceName], names: SourceNames) -> list[SourceName]:
    """Return the names that expressions have by default, each with its parameter among its details.

    These expressions are removed from the list.
    """
    given = []
    for item in list(expressions):
        default = names.find_default(item)
        if default is not None and default.name:
            expressions.remove(item)
            details = (*item.details, (Detail.GIVEN_BY, default.parameter))
            given.append(replace(item, name=default.name, details=details))
    return given
