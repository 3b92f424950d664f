"""Files that a process of the launch writes and that a node in the launcher's process reads.

Launch files start a program that writes a file, such as a world, together with the node that reads the file. They rely
on the time that programs take to start, but nodes in the launcher's process start at once.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.hosting.plans import HostedPlan
    from linkwright.launch.engine.process_table import ProcessTable

_POLL_PERIOD_S = 0.05
_SETTLING_S = 1.0
"""The seconds after which a new file counts as complete even if its process has not ended."""
_LIMIT_S = 20.0
"""The seconds after which the node starts without the file."""


def find_unwritten_file(plan: HostedPlan, processes: ProcessTable) -> str | None:
    """Return a missing file of a node that a process of the launch may be writing, or None.

    Such a file is named in the node's parameters or arguments, and in the command of a process that has not ended.
    """
    return next((path for path in _iterate_missing_files(plan) if processes.is_named(path)), None)


async def wait_until_written(path: str, processes: ProcessTable) -> None:
    """Wait until a file is complete, or the processes whose commands name the file have ended.

    The wait is limited, because the processes may not write the file.
    """
    deadline_s = time.monotonic() + _LIMIT_S
    while processes.is_named(path) and time.monotonic() < deadline_s:
        if _exists(path):
            deadline_s = min(deadline_s, time.monotonic() + _SETTLING_S)
        await asyncio.sleep(_POLL_PERIOD_S)


def _iterate_missing_files(plan: HostedPlan) -> Iterator[str]:
    values: Iterable[object] = (*plan.parameters.values(), *plan.arguments)
    for value in values:
        if isinstance(value, str) and value.startswith("/") and "\n" not in value and not _exists(value):
            yield value


def _exists(path: str) -> bool:
    return Path(path).exists()
