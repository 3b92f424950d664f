"""Compare the rates of loops and the periods of timers in sources."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.diagnostics import Phrase, Span, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.sources.names import SourceNames

_UNIT_NAMES = re.compile(
    r"\b(?:ros|rospy|rclcpp|rclpy|std|chrono|(?:nano|micro|milli)?seconds|duration|Duration|from_sec|to_sec|n?secs|"
    r"[num]?s|Hz|from_seconds|float|int)\b"
)


def compare_rates(old: SourceNames, new: SourceNames, *, is_new: bool) -> Iterator[tuple[Phrase, Span]]:
    """Yield the changed rates and periods, and all rates of a new node, each with its location.

    Rates are compared only if both versions have the same number.

    Args:
        old: the names in the old source.
        new: the names in the new source.
        is_new: whether only the new version has the source.
    """
    if is_new and new.rates and new.makes_node:
        texts = joined_first(dict.fromkeys(text for text, _ in new.rates), MAX_NAMES)
        yield phrase("rates and periods: {texts}", texts=texts), new.rates[0][1]
    if len(old.rates) != len(new.rates):
        return
    for (old_text, _), (new_text, span) in zip(old.rates, new.rates, strict=True):
        is_same_call = old_text.partition("(")[0] == new_text.partition("(")[0]
        if is_same_call and old_text != new_text and (_is_number(old_text) or _is_number(new_text)):
            yield phrase("rate or period: {old} -> {new}", old=old_text, new=new_text), span


def _is_number(rate: str) -> bool:
    """Return whether the argument of a rate has no names except units."""
    argument = rate.partition("(")[2]
    return re.search(r"[A-Za-z_]{2,}", _UNIT_NAMES.sub("", re.sub(r"(\d)[a-z]+", r"\1", argument))) is None
