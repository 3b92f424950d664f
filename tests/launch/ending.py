"""Functions that wait until a launch continues or ends."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from launch.actions import OpaqueFunction, Shutdown, TimerAction

from launch import LaunchContext
from tests.waiting import TIMEOUT_S

_PAUSE_S = 0.02

Condition = Callable[[LaunchContext], object]


def run_when(condition: Condition, *actions: Any) -> OpaqueFunction:
    """Run actions when a condition holds, or after a minute.

    In the second case the test reports what is missing.
    """
    limit = time.monotonic() + TIMEOUT_S

    def look(context: LaunchContext) -> list[Any]:
        if condition(context) or time.monotonic() > limit:
            return list(actions)
        return [TimerAction(period=_PAUSE_S, actions=[OpaqueFunction(function=look)])]

    return OpaqueFunction(function=look)


def end_when(condition: Condition) -> OpaqueFunction:
    """End the launch when a condition holds."""
    return run_when(condition, Shutdown())


def has_printed(*texts: str, times: int = 1) -> Condition:
    """Return the condition that the launch has printed each of some texts a number of times."""

    def holds(context: LaunchContext) -> bool:
        output = "".join(stream.getvalue() for stream in context.session.log._streams.values())
        return all(output.count(text) >= times for text in texts)

    return holds
