"""Jobs of which only the newest matters, such as the inverse kinematics of a dragged handle."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

Job = Callable[[], Awaitable[None]]


class LatestJob:
    """Runs one job at a time; of the jobs that are requested in the meantime, only the newest runs next.

    Args:
        on_idle: called when the last job has ended.
    """

    def __init__(self, on_idle: Callable[[], None] | None = None) -> None:
        self._on_idle = on_idle
        self._next: Job | None = None
        self._task: asyncio.Task[None] | None = None

    @property
    def is_running(self) -> bool:
        """Whether a job is running or waiting."""
        return self._task is not None

    def request(self, job: Job) -> None:
        """Run a job, now or after the current one."""
        self._next = job
        if self._task is None:
            self._task = asyncio.get_running_loop().create_task(self._run())

    def cancel(self) -> None:
        """Cancel the current job, and discard the next one."""
        self._next = None
        if self._task is not None:
            self._task.cancel()
            self._task = None

    async def _run(self) -> None:
        task = asyncio.current_task()
        try:
            while self._next is not None:
                job, self._next = self._next, None
                await job()
        finally:
            if self._task is task:
                self._task = None
        if self._on_idle is not None:
            self._on_idle()
