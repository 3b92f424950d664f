"""Plans of processes, which actions create and the engine executes.

`linkwright.hosting.plans.HostedPlan` is the corresponding plan of one of Linkwright's own nodes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from linkwright.launch.model.events import ProcessAction


@dataclass(frozen=True)
class ProcessPlan:
    """The evaluated options of a process to start. See `ExecuteLocal`."""

    action: ProcessAction
    name: str
    command: Sequence[str]
    folder: str | None
    environment: Mapping[str, str]
    shell: bool
    emulate_tty: bool
    destinations: Mapping[int, frozenset[str]]
    output_format: str
    log_command: bool
    respawn: bool
    respawn_delay: float
    respawn_limit: int
    seconds_to_sigterm: float
    seconds_to_sigkill: float
