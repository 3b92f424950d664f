"""One renderer for all cameras of a simulation."""

from __future__ import annotations

import threading
from collections.abc import Callable
from weakref import WeakKeyDictionary

from linkwright.diagnostics import Phrase
from linkwright.geometry.single import Transform
from linkwright.simulation.rendering.choice import make_renderer
from linkwright.simulation.rendering.optics import Optics
from linkwright.simulation.rendering.renderer import Picture, Renderer, Wanted
from linkwright.simulation.simulation import Simulation

_shared: WeakKeyDictionary[Simulation, SharedRenderer] = WeakKeyDictionary()


class SharedRenderer:
    """What all cameras of a simulation make pictures with; it is made with the first picture, in the thread of that."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._renderer: Renderer | None = None
        self._thread = 0
        self._users = 0
        self._told = False

    def render(self, optics: Optics, pose: Transform, wanted: Wanted, tell: Callable[[Phrase], object]) -> Picture:
        """What a camera sees now; before the first picture `tell` is called with the way that they are made."""
        if self._renderer is None or self._thread != threading.get_ident():
            self._renderer, self._thread = make_renderer(self._simulation), threading.get_ident()
        if not self._told:
            self._told = True
            tell(self._renderer.way)
        return self._renderer.render(optics, pose, wanted)

    def release(self) -> None:
        """One camera fewer; the last one frees what the renderer has of the system."""
        self._users -= 1
        if self._users == 0:
            if self._renderer is not None:
                self._renderer.close()
            self._renderer = None
            _shared.pop(self._simulation, None)

    def use(self) -> SharedRenderer:
        """One camera more, which is to call `release` in the end."""
        self._users += 1
        return self


def shared_renderer(simulation: Simulation) -> SharedRenderer:
    """The renderer of a simulation for one camera more."""
    if simulation not in _shared:
        _shared[simulation] = SharedRenderer(simulation)
    return _shared[simulation].use()
