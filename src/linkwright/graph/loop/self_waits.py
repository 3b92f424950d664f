"""Callbacks that block until an event which only their own callback group could let in.

In rclpy the response to a request is taken in the callback group of its client. While a callback of a mutually
exclusive group runs, nothing else of that group does: a callback that blocks until the response arrives blocks for
ever. Here responses run no code of the user's and are let in all the same. The mistake is logged as an error before the
program runs on a robot; where the parameter `STRICT` of the node is set, the callback hangs as in rclpy.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, FrameType
from typing import Any, Protocol

from linkwright.graph.loop.node_handle import MutuallyExclusiveCallbackGroup

STRICT = "strict_callback_groups"
"""The parameter by which a node has responses wait for the callback group of their client, as in rclpy."""

RUNNER = "callback_of"
"""The name of the local variable by which a function that runs callbacks holds the entity that it runs one of."""

_OURS = str(Path(__file__).parents[2]) + os.sep
_reported: set[tuple[CodeType, str]] = set()


class Waited(Protocol):
    """A future, as it is looked at here.

    Attributes:
        source: the client whose server it waits for; None for any other future.
    """

    source: Any

    def ended(self) -> bool:
        """Whether there is nothing more to wait for."""


def report_self_wait(future: Waited) -> None:
    """Log an error where the calling thread is in a callback that would wait for ever on a robot; once for each place.

    Args:
        future: the future to wait for.
    """
    client = future.source
    if client is None or future.ended():
        return
    group = client.callback_group
    if not isinstance(group, MutuallyExclusiveCallbackGroup) or group.can_execute(client):
        return  # nothing of the group runs
    frames = list(_frames(sys._getframe(1)))
    running = next((frame for frame in frames if _entity_of(frame) is not None), None)
    if running is None or _entity_of(running).callback_group is not group:
        return
    own = [frame for frame in frames[: frames.index(running)] if not frame.f_code.co_filename.startswith(_OURS)]
    if not own:
        return
    call, callback = own[0], own[-1].f_code
    place = f"{call.f_code.co_filename}:{call.f_lineno}"
    if (callback, place) in _reported:
        return
    _reported.add((callback, place))
    client.node.logger.error(
        f"callback '{callback.co_name}' ({callback.co_filename}:{callback.co_firstlineno}) waits at {place} for the "
        f"{client.what}, which is in the same mutually exclusive callback group: on a robot it waits for ever. Give "
        "the client a callback group of its own and use a MultiThreadedExecutor, or continue in a done callback of "
        "call_async()"
    )


def _entity_of(frame: FrameType) -> Any:
    """The entity whose callback a frame of an executor runs; None for any other frame."""
    return frame.f_locals.get(RUNNER) if RUNNER in frame.f_code.co_varnames else None


def _frames(frame: FrameType | None) -> Iterator[FrameType]:
    while frame is not None:
        yield frame
        frame = frame.f_back
