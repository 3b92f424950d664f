"""A runner of long computations in steps, between which a node's other callbacks run."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.graph import Node
from linkwright.navigation.slam.steps import Steps


class StepRunner:
    """A runner of one computation at a time.

    Args:
        node: the node whose callbacks run between the steps.
    """

    def __init__(self, node: Node) -> None:
        self._work: Steps[Any] | None = None
        self._on_done: Callable[[Any], None] = lambda _: None
        self._guard = node.create_guard_condition(self._step)

    @property
    def is_busy(self) -> bool:
        """Whether a computation is running."""
        return self._work is not None

    def start(self, work: Steps[Any], on_done: Callable[[Any], None]) -> None:
        """Start a computation, which may not be running already.

        Args:
            work: the computation.
            on_done: called with its result. It may start the next computation.
        """
        self._work, self._on_done = work, on_done
        self._guard.trigger()

    def drop(self) -> None:
        """End the running computation without a result."""
        if self._work is not None:
            self._work.close()
            self._work = None

    def close(self) -> None:
        """End the running computation, and remove the guard condition."""
        self.drop()
        self._guard.destroy()

    def _step(self) -> None:
        if self._work is None:
            return
        try:
            next(self._work)
        except StopIteration as done:
            self._work = None
            self._on_done(done.value)
            return
        self._guard.trigger()
