"""Shares one renderer among all cameras of a simulation."""

from __future__ import annotations

import threading
from collections.abc import Callable
from weakref import WeakKeyDictionary

from linkwright.diagnostics import Phrase
from linkwright.geometry.single import Transform
from linkwright.sdf.optics import Optics
from linkwright.simulation.rendering.choice import make_renderer
from linkwright.simulation.rendering.renderer import Channels, RenderedImage, Renderer
from linkwright.simulation.simulation import Simulation

_shared: WeakKeyDictionary[Simulation, SharedRenderer] = WeakKeyDictionary()


class SharedRenderer:
    """The renderer that all cameras of a simulation share.

    It is created in the thread that renders the first image.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._renderer: Renderer | None = None
        self._thread = 0
        self._users = 0
        self._reported = False

    def render(
        self, optics: Optics, pose: Transform, channels: Channels, report: Callable[[Phrase], object]
    ) -> RenderedImage:
        """Render the current view of a camera; the first call passes the kind of renderer to `report`."""
        if self._renderer is None or self._thread != threading.get_ident():
            self._renderer, self._thread = make_renderer(self._simulation), threading.get_ident()
        if not self._reported:
            self._reported = True
            report(self._renderer.way)
        return self._renderer.render(optics, pose, channels)

    def release(self) -> None:
        """Unregister a camera, and close the renderer after the last one."""
        self._users -= 1
        if self._users == 0:
            if self._renderer is not None:
                self._renderer.close()
            self._renderer = None
            _shared.pop(self._simulation, None)

    def use(self) -> SharedRenderer:
        """Register a camera, which has to call `release` when it stops."""
        self._users += 1
        return self


def shared_renderer(simulation: Simulation) -> SharedRenderer:
    """Return the shared renderer of a simulation, with one more camera registered."""
    if simulation not in _shared:
        _shared[simulation] = SharedRenderer(simulation)
    return _shared[simulation].use()
