"""Round hulls on waves: ``libSurface.so``.

The hull is a horizontal cylinder. Each of its points carries the same share of its length, and is lifted by
the water that this share displaces: the segment of a circle up to the height of the waves there.

Source: VRX (parameters, defaults, formulas). In VRX, the forces act at the points moved by the center of mass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.simulation.plugins.boats.wave_plugin import WAVEFIELD, WavePlugin
from linkwright.simulation.plugins.parameters import parameter


@dataclass(frozen=True, kw_only=True)
class SurfaceParameters:
    """Parameters of ``libSurface.so``."""

    link_name: str = parameter()
    hull_length: float = 4.9
    hull_radius: float = 0.213
    fluid_level: float = 0.0
    fluid_density: float = 997.7735


class Surface(WavePlugin[SurfaceParameters]):
    """The substitute for ``libSurface.so``."""

    PARAMETERS = SurfaceParameters
    IGNORED = ("points", WAVEFIELD)

    def start(self) -> None:
        """Find the link, and read the points and the waves.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a point or a parameter of the waves is not valid.
        """
        self._link = self.link(self.parameters.link_name)
        self._points = self._read_points()
        self.simulation.keep_awake(self._link)
        self.start_waves()
        self.every(0.0, self._apply_forces)
        self._apply_forces()

    @property
    def fluid_level(self) -> float:
        """The height of calm water in the world, in m."""
        return self.parameters.fluid_level

    def _read_points(self) -> Array:
        """Return the points in the frame of the link, shape (n, 3)."""
        element = self.context.element
        parent = None if element is None else element.first("points")
        points = []
        for child in () if parent is None else parent.elements("point"):
            try:
                x, y, z = (float(word) for word in child.text().split())
            except ValueError as error:
                message = phrase("plugin '{plugin}': <point> needs three numbers", plugin=self.context.name)
                raise self.parameter_error(message, child) from error
            points.append((x, y, z))
        if not points or self.parameters.hull_radius <= 0.0:
            message = phrase(
                "plugin '{plugin}': the hull needs a <point> in <points>, and a <hull_radius> greater than 0",
                plugin=self.context.name,
            )
            raise self.parameter_error(message)
        return np.array(points)

    def _apply_forces(self) -> None:
        self.simulation.refresh()
        simulation, parameters = self.simulation, self.parameters
        body, data = simulation.body(self._link), simulation.data
        offsets = self._points @ data.xmat[body].reshape(3, 3).T
        points = offsets + data.xpos[body]
        depths = parameters.fluid_level + self.wave_heights(points[:, :2]) - points[:, 2]
        areas = _compute_segments(parameters.hull_radius, np.clip(depths, 0.0, parameters.hull_radius))
        weight = -simulation.model.opt.gravity[2] * parameters.fluid_density
        forces = np.zeros((len(points), 3))
        forces[:, 2] = areas * parameters.hull_length / len(points) * weight
        arms = offsets if self.gazebo_mistakes else points - data.xipos[body]
        self.push(self._link, forces.sum(axis=0), np.cross(arms, forces).sum(axis=0))


def _compute_segments(radius: float, depths: Array) -> Array:
    """Return the areas of the segments of a circle in m2, for depths up to its radius in m."""
    below_center = radius - depths
    half_widths = np.sqrt(np.maximum(2.0 * radius * depths - depths**2, 0.0))
    areas: Array = radius**2 * np.arccos(below_center / radius) - below_center * half_widths
    return areas
