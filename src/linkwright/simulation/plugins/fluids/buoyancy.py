"""Bodies that float: ``gz-sim-buoyancy-system`` and ``libBuoyancyPlugin.so``.

The weight of the displaced fluid acts upward at the center of the displaced volume (Archimedes). gz's system belongs
to the world and knows uniform fluids, and fluids with layers, whose boundaries cut the collisions. Classic's plugin
belongs to a model that is entirely below the surface.

Source: gz-sim and Gazebo Classic (parameters, defaults, which links float). gz cuts only boxes and spheres at the
boundaries; here all collisions with a volume are cut.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import inf
from typing import Generic, TypeVar

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.fluids.displacement import Solid, Volume
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.water import WaterSurface

P = TypeVar("P")

_WATER_DENSITY = 1000.0
"""The density of water in kg/m3, the default of gz."""


@dataclass(frozen=True, kw_only=True)
class GzBuoyancyParameters:
    """Parameters of ``gz-sim-buoyancy-system``."""

    uniform_fluid_density: float = _WATER_DENSITY
    enable: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class ClassicBuoyancyParameters:
    """Parameters of ``libBuoyancyPlugin.so``."""

    fluid_density: float = 999.1026


@dataclass(frozen=True, slots=True)
class _Layer:
    """A layer of a fluid, in m and kg/m3."""

    bottom: float
    top: float
    density: float


class _Buoyancy(SimulatedPlugin[P], ABC, Generic[P]):
    """A plugin that applies the force of buoyancy to links."""

    @abstractmethod
    def _find_solids(self) -> dict[str, Solid]:
        """Return the solids of the links that float, by the names of the links."""

    @abstractmethod
    def _compute_displaced_volumes(
        self, solid: Solid, rotation: Array, position: Array
    ) -> Iterator[tuple[float, Volume]]:
        """Yield the density and the displaced volume of each fluid, for a pose of the link."""

    def start(self) -> None:
        """Find the links that float."""
        self._revision = -1
        self._floating: dict[str, Solid] = {}
        self.every(0.0, self._apply_buoyancy)
        self._apply_buoyancy()

    def _apply_buoyancy(self) -> None:
        simulation = self.simulation
        simulation.refresh()
        if self._revision != simulation.revision:
            self._revision, self._floating = simulation.revision, self._find_solids()
        gravity, data = simulation.model.opt.gravity, simulation.data
        for link, solid in self._floating.items():
            body = simulation.body(link)
            displaced_mass, moment = 0.0, np.zeros(3)
            for density, volume in self._compute_displaced_volumes(
                solid, data.xmat[body].reshape(3, 3), data.xpos[body]
            ):
                displaced_mass += density * volume.size
                moment += density * volume.size * volume.center
            center = moment / displaced_mass if displaced_mass else None
            self.push(link, -displaced_mass * gravity, at=center)


class GzBuoyancy(_Buoyancy[GzBuoyancyParameters]):
    """The substitute for ``gz-sim-buoyancy-system``."""

    PARAMETERS = GzBuoyancyParameters
    IGNORED = ("graded_buoyancy",)  # read by _read_layers

    def start(self) -> None:
        """Read the layers of the fluid, and find the links that float.

        Raises:
            LinkwrightError: SIM160, a layer has no valid density or height.
        """
        self._layers = self._read_layers()
        super().start()

    @property
    def water(self) -> WaterSurface | None:
        """The surface of the uppermost layer that has a lighter one above, or None."""
        pairs = list(pairwise(self._layers))
        levels = [upper.bottom for lower, upper in pairs if lower.density > upper.density]
        return WaterSurface(levels[-1]) if levels else None

    def _read_layers(self) -> list[_Layer]:
        graded = None if self.context.element is None else self.context.element.first("graded_buoyancy")
        if graded is None:
            return [_Layer(-inf, inf, self.parameters.uniform_fluid_density)]
        densities = [self.number_in(graded, "default_density", _WATER_DENSITY)]
        heights = [-inf]
        for change in graded.elements("density_change"):
            densities.append(self.number_in(change, "density"))
            heights.append(self.number_in(change, "above_depth"))
        layers = sorted(zip(heights, densities, strict=True))
        tops = [bottom for bottom, _ in layers[1:]] + [inf]
        return [_Layer(bottom, top, density) for (bottom, density), top in zip(layers, tops, strict=True)]

    def _find_solids(self) -> dict[str, Solid]:
        simulation = self.simulation
        solids = {}
        for link in simulation.scene.bodies:
            is_fixed = simulation.model.body_weldid[simulation.body(link)] == 0
            solid = None if is_fixed or not self._is_enabled(link) else Solid.from_link(simulation, link)
            if solid is not None:
                solids[link] = solid
        return solids

    def _is_enabled(self, link: str) -> bool:
        names = self.parameters.enable
        return not names or any(link == name or link.startswith(name + SEPARATOR) for name in names)

    def _compute_displaced_volumes(
        self, solid: Solid, rotation: Array, position: Array
    ) -> Iterator[tuple[float, Volume]]:
        lower = Volume(0.0, np.zeros(3))
        for layer in self._layers:
            upper = solid.volume_below(layer.top, rotation, position)
            size = upper.size - lower.size
            if size > 0.0:
                yield layer.density, Volume(size, (upper.size * upper.center - lower.size * lower.center) / size)
            lower = upper


class ClassicBuoyancy(_Buoyancy[ClassicBuoyancyParameters]):
    """The substitute for ``libBuoyancyPlugin.so``.

    A ``<link>`` of the plugin states the volume of a link and its center. Other links have those of their collisions.
    """

    PARAMETERS = ClassicBuoyancyParameters
    IGNORED = ("link",)  # read by _read_volumes

    def start(self) -> None:
        """Read the volumes of links, and find the links that float.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a volume or its center is not valid.
        """
        self._stated_volumes = dict(self._read_volumes())
        super().start()

    def _read_volumes(self) -> Iterator[tuple[str, Volume]]:
        element = self.context.element
        for child in () if element is None else element.elements("link"):
            link, center = self.link(child.attributes.get("name", "")), child.first("center_of_volume")
            coordinates = [] if center is None else [float(word) for word in center.text().split()]
            if len(coordinates) != 3:
                message = phrase(
                    "plugin '{plugin}': <link> needs three numbers in <center_of_volume>", plugin=self.context.name
                )
                raise self.parameter_error(message)
            yield link, Volume(self.number_in(child, "volume"), np.array(coordinates))

    def _find_solids(self) -> dict[str, Solid]:
        simulation, prefix = self.simulation, self.context.path + SEPARATOR
        solids = {link: Solid(np.empty((0, 3, 3)), volume, 0.0) for link, volume in self._stated_volumes.items()}
        for link in simulation.scene.bodies:
            solid = Solid.from_link(simulation, link) if link.startswith(prefix) and link not in solids else None
            if solid is not None:
                solids[link] = solid
        return solids

    def _compute_displaced_volumes(
        self, solid: Solid, rotation: Array, position: Array
    ) -> Iterator[tuple[float, Volume]]:
        yield self.parameters.fluid_density, solid.volume_below(inf, rotation, position)
