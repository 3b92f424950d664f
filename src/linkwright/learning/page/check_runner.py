"""A runner of a step's checks, in one process at a time."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

from linkwright.learning.checks.check_process import CheckProcess, create_check_server
from linkwright.learning.checks.results import StepResult
from linkwright.learning.course import Step

_NICENESS = 5
"""The niceness of checks. The page, and a world that the learner watches beside it, get the processor first."""


class CheckRunner:
    """A runner of checks on the event loop.

    A request cancels the running checks, because the learner's files have changed.

    Args:
        workspace: the learner's workspace.
        on_result: called with each step and its results.
    """

    def __init__(self, workspace: Path, on_result: Callable[[Step, StepResult], object]) -> None:
        self._workspace = workspace
        self._on_result = on_result
        self._server = create_check_server()
        self._process: CheckProcess | None = None
        self._task: asyncio.Task[None] | None = None
        self._requested: tuple[Step, str | None] | None = None

    @property
    def is_running(self) -> bool:
        """Whether checks run or are about to run."""
        return self._task is not None

    def request(self, step: Step, answer: str | None) -> None:
        """Run the checks of a step as soon as possible."""
        self._requested = step, answer
        if self._process is not None:
            self._process.cancel()
        if self._task is None:
            self._task = asyncio.get_running_loop().create_task(self._work())

    def close(self) -> None:
        """Cancel the running checks."""
        self._requested = None
        if self._process is not None:
            self._process.cancel()
        if self._task is not None:
            self._task.cancel()
        self._server.close()

    async def _work(self) -> None:
        while self._requested is not None:
            step, answer = self._requested
            self._requested = None
            server = self._server if self._server.is_ready else None
            self._process = CheckProcess(step, self._workspace, answer=answer, server=server, niceness=_NICENESS)
            result = await asyncio.to_thread(self._process.run)
            self._process = None
            self._server.prepare()  # for the next checks; beside the first one, it would delay that
            if self._requested is None:
                self._task = None
                self._on_result(step, result)
                return
