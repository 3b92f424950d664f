"""Graphs for tests of nodes.

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
    from linkwright.testing.simulated import AsyncSteppedSimulation, SteppedSimulation

__all__ = ["AsyncSteppedGraph", "AsyncSteppedSimulation", "Recording", "SteppedGraph", "SteppedSimulation"]


__getattr__ = deferred(__name__, {"simulated": ("AsyncSteppedSimulation", "SteppedSimulation")})
"""Imports the names that need the simulation on first use, because that import is slow."""
