"""Compare the rates of loops and the timers of two versions of a source."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Span, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.sources.names import SourceNames, Timer, TimerClock
from linkwright.review.sources.namespaces import HeaderChange

_UNIT_NAMES = re.compile(
    r"\b(?:ros|rospy|rclcpp|rclpy|std|chrono|(?:nano|micro|milli)?seconds|duration|Duration|from_sec|to_sec|n?secs|"
    r"[num]?s|Hz|from_seconds|float|int|WallDuration|SteadyDuration)\b"
)
_LOOP = re.compile(r"(?:\w+(?:::|\.))*(?:Rate|WallRate|create_rate)\(.*", re.DOTALL)
_TIMERS = frozenset({"create_wall_timer", "create_timer"})


def compare_rates(old: SourceNames, new: SourceNames, *, is_added: bool) -> Iterator[HeaderChange]:
    """Yield the changed rates and periods, and all rates of a new node.

    Rates are compared if both versions have the same number, and otherwise those of timers with the same callback.

    Args:
        old: the names in the old version.
        new: the names in the new version.
        is_added: whether the source is new.
    """
    if is_added and new.rates and new.makes_node:
        texts = joined_first(dict.fromkeys(text for text, _ in new.rates), MAX_NAMES)
        yield HeaderChange(phrase("rates and periods: {texts}", texts=texts), new.rates[0][1])
    pairs = list(zip(old.rates, new.rates, strict=False))
    if len(old.rates) != len(new.rates):
        timers = {timer.callback: timer for timer in old.timers if timer.callback}
        pairs = [
            ((timers[timer.callback].text, timer.span), (timer.text, timer.span))
            for timer in new.timers
            if timer.callback in timers
        ]
    for (old_text, _), (new_text, span) in pairs:
        old_call, new_call = old_text.split("(", 1), new_text.split("(", 1)
        is_same_call = old_call[0] == new_call[0] or {old_call[0], new_call[0]} <= _TIMERS
        if is_same_call and old_call[1:] != new_call[1:] and (_is_number(old_text) or _is_number(new_text)):
            yield HeaderChange(phrase("rate or period: {old} -> {new}", old=old_text, new=new_text), span)


def compare_loops(
    old: SourceNames, new: SourceNames, others: tuple[Sequence[SourceNames], Sequence[SourceNames]]
) -> Iterator[HeaderChange]:
    """Yield the rates of loops if only one version of a source has any.

    Args:
        old: the names in the old version.
        new: the names in the new version.
        others: the names in the other changed sources of both versions, to which a loop may move.
    """
    loops = _find_loops(old), _find_loops(new)
    moved = [{text for names in side for text in _find_loops(names)} for side in others]
    if loops[0] and not loops[1] and moved[1] <= moved[0]:
        for text, span in loops[0].items():
            yield HeaderChange(phrase("rate removed: {rate}", rate=text), span, is_old=True)
    if loops[1] and not loops[0] and moved[0] <= moved[1]:
        for text, span in loops[1].items():
            yield HeaderChange(phrase("rate added: {rate}", rate=text), span)


def _find_loops(names: SourceNames) -> dict[str, Span]:
    """Return the rates of the loops of a source, each with its first location."""
    return {text: span for text, span in reversed(names.rates) if _LOOP.fullmatch(text)}


def compare_timers(old: SourceNames, new: SourceNames, other: Sequence[Timer]) -> Iterator[HeaderChange]:
    """Yield the timers that a version of a source has more than the other one.

    Args:
        old: the names in the old version.
        new: the names in the new version.
        other: the timers in the other changed sources of both versions, to which timers move.
    """
    for timer in _find_lost(old.timers, new.timers, other):
        text = phrase("timer removed: {timer}", timer=timer.text)
        if timer.callback:
            text = phrase("timer of '{name}' removed: {timer}", name=timer.callback, timer=timer.text)
        yield HeaderChange(text, timer.span, is_old=True)
    for timer in _find_lost(new.timers, old.timers, other) if old.names or old.timers else ():
        text = phrase("timer added: {timer}", timer=timer.text)
        if timer.callback:
            text = phrase("timer of '{name}' added: {timer}", name=timer.callback, timer=timer.text)
        yield HeaderChange(text, timer.span)
    yield from _compare_clocks(old.timers, new.timers)


def _compare_clocks(old: Sequence[Timer], new: Sequence[Timer]) -> Iterator[HeaderChange]:
    """Yield the callbacks of timers that run by another clock. Callbacks with timers of several clocks are left out."""
    old_clocks, new_clocks = (_find_clocks(timers) for timers in (old, new))
    for timer in new:
        old_clock, clock = old_clocks.get(timer.callback), new_clocks.get(timer.callback)
        if old_clock is None or clock is None or clock is old_clock:
            continue
        values = {"name": timer.callback, "old": old_clock.value, "new": clock.value}
        text = phrase("timer of '{name}': {old} -> {new}, which is simulated time if use_sim_time is set", **values)
        if clock is TimerClock.WALL:
            text = phrase("timer of '{name}': {old} -> {new}, also if use_sim_time is set", **values)
        yield HeaderChange(text, timer.span)


def _find_clocks(timers: Sequence[Timer]) -> dict[str, TimerClock | None]:
    """Return the clock of the timers of each callback; None if it is unknown or not the same for all."""
    clocks: dict[str, set[TimerClock | None]] = {}
    for timer in timers:
        if timer.callback:
            clocks.setdefault(timer.callback, set()).add(timer.clock)
    return {callback: next(iter(found)) if len(found) == 1 else None for callback, found in clocks.items()}


def _find_lost(own: Sequence[Timer], others: Sequence[Timer], moved: Sequence[Timer]) -> list[Timer]:
    """Return the timers that only one version has, if it has more timers."""
    count = len(own) - len(others)
    callbacks = {timer.callback for timer in (*others, *moved)}
    texts = {timer.text for timer in (*others, *moved)}
    lost = [
        timer for timer in own if timer.callback not in callbacks or (not timer.callback and timer.text not in texts)
    ]
    return lost if 0 < len(lost) <= count else []


def _is_number(rate: str) -> bool:
    """Return whether the argument of a rate has no names except units."""
    argument = rate.partition("(")[2]
    return re.search(r"[A-Za-z_]{2,}", _UNIT_NAMES.sub("", re.sub(r"(\d)[a-z]+", r"\1", argument))) is None
