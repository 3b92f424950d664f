"""Find the rates of loops and the timers in C++ sources."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.review.sources.cpp.text import find_arguments
from linkwright.review.sources.names import TimerClock

_RATE = re.compile(
    r"\b(?P<name>(?:ros::|rclcpp::)(?:Rate|WallRate)(?:\s+\w+)?|create_(?:wall_)?timer|"
    r"create(?:Wall|Steady)?Timer)\s*\("
)
_PERIOD = re.compile(r"\d|\bDuration\b|seconds\b")
_NODE_CLOCK = re.compile(r"(?:this|\w+(?:\(\))?)\s*(?:->|\.)\s*get_clock\s*\(\s*\)|get_clock\s*\(\s*\)")
_CLOCK = re.compile(r"[cC]lock")
_CLOCKS = {"create_wall_timer": TimerClock.WALL, "createWallTimer": TimerClock.WALL, "createTimer": TimerClock.ROS}


class FoundRate(NamedTuple):
    """The rate of a loop, or the period of a timer.

    Attributes:
        text: the call with the rate or period.
        begin: the offset of the rate or period.
        end: its end.
        is_timer: whether it is of a timer.
        arguments: the texts of all arguments.
        clock: the clock of the timer; None if it is unknown.
    """

    text: str
    begin: int
    end: int
    is_timer: bool
    arguments: list[str]
    clock: TimerClock | None


def find_rates(text: str) -> Iterator[FoundRate]:
    """Yield the rates and timers of a C++ source without comments."""
    for match in _RATE.finditer(text):
        offsets = list(find_arguments(text, match.end() - 1))
        arguments = [" ".join(text[begin:end].split()) for begin, end in offsets]
        name = match["name"].split()[0]
        index = _find_period(arguments) if name == "create_timer" else 0
        if index < len(arguments):
            clock = _find_clock(arguments, index) if name == "create_timer" else _CLOCKS.get(name)
            yield FoundRate(f"{name}({arguments[index]})", *offsets[index], "imer" in name, arguments, clock)


def _find_period(arguments: Sequence[str]) -> int:
    """Return the index of the period of ``create_timer``, which the node and its clock may precede."""
    index = next((place for place, text in enumerate(arguments[:3]) if _PERIOD.search(text)), None)
    if index is None:
        index = 2 if len(arguments) > 2 and _CLOCK.search(arguments[1]) else min(1, max(0, len(arguments) - 1))
    return index


def _find_clock(arguments: Sequence[str], index: int) -> TimerClock | None:
    """Return the clock of ``create_timer``: that of the node unless it gets another one."""
    clocks = [text for text in arguments[:index] if _CLOCK.search(text)]
    if all(_NODE_CLOCK.fullmatch(text) for text in clocks):
        return TimerClock.ROS
    return None
