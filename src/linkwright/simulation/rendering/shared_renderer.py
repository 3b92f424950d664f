"""Share one renderer among all cameras of a simulation."""

from __future__ import annotations

import threading
from collections.abc import Callable
from weakref import WeakKeyDictionary

from linkwright.diagnostics import Phrase
from linkwright.geometry.single import Transform
from linkwright.sdf.optics import Optics
from linkwright.simulation.rendering.factory import make_renderer
from linkwright.simulation.rendering.renderer import Channels, RenderedImage, Renderer
from linkwright.simulation.simulation import Simulation

_renderers: WeakKeyDictionary[Simulation, SharedRenderer] = WeakKeyDictionary()


class SharedRenderer:
    """A renderer that all cameras of a simulation share.

    It is created in the thread that renders the first image, and again if another thread renders an image.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._renderer: Renderer | None = None
        self._thread = 0
        self._camera_count = 0
        self._has_reported = False

    def render(
        self, optics: Optics, pose: Transform, channels: Channels, report: Callable[[Phrase], object]
    ) -> RenderedImage:
        """Render the current view of a camera.

        The first call passes the method of rendering to `report`.
        """
        if self._renderer is None or self._thread != threading.get_ident():
            self._renderer, self._thread = make_renderer(self._simulation), threading.get_ident()
        if not self._has_reported:
            self._has_reported = True
            report(self._renderer.method)
        return self._renderer.render(optics, pose, channels)

    def release(self) -> None:
        """Unregister a camera, and close the renderer after the last one."""
        self._camera_count -= 1
        if self._camera_count == 0:
            if self._renderer is not None:
                self._renderer.close()
            self._renderer = None
            _renderers.pop(self._simulation, None)

    def register(self) -> SharedRenderer:
        """Register a camera, and return this object.

        The camera must call `release` when it stops.
        """
        self._camera_count += 1
        return self


def share_renderer(simulation: Simulation) -> SharedRenderer:
    """Register a camera, and return the shared renderer of its simulation."""
    if simulation not in _renderers:
        _renderers[simulation] = SharedRenderer(simulation)
    return _renderers[simulation].register()
