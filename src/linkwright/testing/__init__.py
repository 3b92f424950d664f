"""Graphs and simulated worlds for tests of nodes.

Time passes only when the test advances it. An hour of such time takes milliseconds. With `SteppedSimulation`, a
simulated world advances together with the graph.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.loading.deferred import deferred
from linkwright.testing.recording import Recording
from linkwright.testing.stepped import AsyncSteppedGraph
from linkwright.testing.stepped_sync import SteppedGraph

if TYPE_CHECKING:
    from linkwright.testing.programs.program import Program
    from linkwright.testing.programs.threads import BudgetExceededError
    from linkwright.testing.simulated import AsyncSteppedSimulation, SteppedSimulation

__all__ = [
    "AsyncSteppedGraph",
    "AsyncSteppedSimulation",
    "BudgetExceededError",
    "Program",
    "Recording",
    "SteppedGraph",
    "SteppedSimulation",
]


__getattr__ = deferred(
    __name__,
    {
        "programs.program": ("Program",),
        "programs.threads": ("BudgetExceededError",),
        "simulated": ("AsyncSteppedSimulation", "SteppedSimulation"),
    },
)
"""Imports the names that need the simulation or rclpy on first use, because these imports are slow."""
