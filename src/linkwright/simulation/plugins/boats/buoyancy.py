"""Bodies that float on waves: ``libPolyhedraBuoyancyDrag.so``.

Each ``<buoyancy>`` is a box, cylinder or sphere that is fixed to a link. The water level is that of the waves at the
center of the shape. The part of the shape below it is lifted by the weight of the water that it displaces, and
resisted in proportion to its share of the link's mass:

    F = rho V g + linear_drag m V/V0 (v_water - v),    T = -angular_drag m V/V0 L^2 w

with the mean length L of the shape. The force never pulls the body down.

Source: VRX (parameters, defaults, formulas). VRX adds ``<fluid_level>`` twice without waves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.diagnostics import LinkwrightError, Severity, phrase
from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.shapes import Box, Cylinder, Sphere
from linkwright.geometry.single import cross
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.frames import transform_of
from linkwright.sdf.poses import AT_ORIGIN, POSE
from linkwright.sdf.reader import read_element
from linkwright.sdf.report import SdfReport
from linkwright.sdf.shapes import GEOMETRY, Shape
from linkwright.simulation.plugins.boats.wave_plugin import WAVEFIELD, WavePlugin
from linkwright.simulation.plugins.fluids.displacement import Solid, create_shape_triangles
from linkwright.xmltree import Element

_MIN_VOLUME_M3 = 1e-6


@dataclass(frozen=True, kw_only=True)
class BuoyancyParameters:
    """Parameters of ``libPolyhedraBuoyancyDrag.so``."""

    fluid_density: float = 997.0
    fluid_level: float = 0.0
    linear_drag: float = 0.0
    angular_drag: float = 0.0


@dataclass(slots=True)
class _Float:
    """A shape that floats.

    Attributes:
        link: the full name of the link.
        solid: the shape in the frame of the link.
        center: the center of the shape in the frame of the link, in m, shape (3,).
        mean_length: the mean length of the shape in m, which determines its resistance to rotation.
        wave_height: the height of the waves at the last step, in m; None before the first step.
    """

    link: str
    solid: Solid
    center: Array
    mean_length: float
    wave_height: float | None = None


class PolyhedraBuoyancyDrag(WavePlugin[BuoyancyParameters]):
    """The substitute for ``libPolyhedraBuoyancyDrag.so``."""

    PARAMETERS = BuoyancyParameters
    IGNORED = ("buoyancy", WAVEFIELD)

    def start(self) -> None:
        """Read the shapes and the waves.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a shape or a parameter of the waves is not valid; or
                an error of SDF.
        """
        element = self.context.element
        self._floats = [self._read_float(child) for child in (() if element is None else element.elements("buoyancy"))]
        for item in self._floats:
            self.simulation.keep_awake(item.link)
        self.start_waves()
        self.every(0.0, self._apply_forces)
        self._apply_forces()

    def reset(self) -> None:
        """Restore the waves of the description."""
        super().reset()
        for item in self._floats:
            item.wave_height = None

    @property
    def fluid_level(self) -> float:
        """The height of calm water in the world, in m."""
        level = self.parameters.fluid_level
        return 2.0 * level if self.gazebo_mistakes and not self.has_waves else level

    def _read_float(self, element: Element) -> _Float:
        link, report = self.link(self.text_in(element, "link_name")), SdfReport()
        geometry, pose_element = element.first("geometry"), element.first("pose")
        shape = None if geometry is None else read_element(geometry, GEOMETRY, report)
        raw_pose = AT_ORIGIN if pose_element is None else read_element(pose_element, POSE, report)
        errors = [finding for finding in report.in_order() if finding.severity is Severity.ERROR]
        if errors:
            raise LinkwrightError(*errors)
        x, y, z, *quaternion = transform_of(raw_pose.pose)
        center, mean_length = np.array((x, y, z)), _compute_mean_length(shape)
        triangles = None if shape is None or mean_length is None else create_shape_triangles(shape)
        solid = None
        if triangles is not None:
            solid = Solid.from_triangles(triangles @ rotation_matrix(quaternion).T + center)
        if solid is None or mean_length is None:
            message = phrase(
                "plugin '{plugin}': <buoyancy> needs a box, a cylinder or a sphere in <geometry>",
                plugin=self.context.name,
            )
            raise self.parameter_error(message, element)
        return _Float(link, solid, center, mean_length)

    def _apply_forces(self) -> None:
        self.simulation.refresh()
        wrenches: dict[str, Array] = {}
        for item in self._floats:
            wrench = self._compute_wrench(item)
            wrenches[item.link] = wrenches[item.link] + wrench if item.link in wrenches else wrench
        for link, wrench in wrenches.items():
            self.push(link, wrench[:3], wrench[3:])

    def _compute_wrench(self, item: _Float) -> Array:
        """Return the force and the torque of the water about the link's center of mass, shape (6,)."""
        simulation, parameters = self.simulation, self.parameters
        body, data, model = simulation.body(item.link), simulation.data, simulation.model
        rotation, position = data.xmat[body].reshape(3, 3), data.xpos[body]
        height, water_speed = self._measure_waves(item, rotation @ item.center + position)
        volume = item.solid.volume_below(height + self.fluid_level, rotation, position)
        if volume.size <= _MIN_VOLUME_M3:
            return np.zeros(6)
        linear, angular = simulation.link_velocity(item.link)
        wet_mass = float(model.body_mass[body]) * volume.size / item.solid.total.size
        force = -parameters.fluid_density * volume.size * model.opt.gravity
        force = force + parameters.linear_drag * wet_mass * (np.array((0.0, 0.0, water_speed)) - linear)
        force[2] = max(force[2], 0.0)
        (x, y, z), (fx, fy, fz) = (volume.center - data.xipos[body]).tolist(), force.tolist()
        torque = np.array(cross((x, y, z), (fx, fy, fz)))
        torque -= parameters.angular_drag * wet_mass * item.mean_length**2 * angular
        return np.concatenate([force, torque])

    def _measure_waves(self, item: _Float, center: Array) -> tuple[float, float]:
        """Return the height of the waves at the center of a shape, and the speed at which it grows, in m and m/s."""
        if not self.has_waves:
            item.wave_height = None
            return 0.0, 0.0
        (height,) = self.wave_heights(center[np.newaxis, :2]).tolist()
        previous_height = height if item.wave_height is None else item.wave_height
        item.wave_height = height
        return height, (height - previous_height) * NANOSECONDS_PER_SECOND / self.simulation.step


def _compute_mean_length(shape: Shape | None) -> float | None:
    """Return the mean length of a shape in m, or None for a shape that cannot float."""
    if isinstance(shape, Box):
        return sum(shape.size) / 3.0
    if isinstance(shape, Cylinder):
        return (2.0 * shape.radius + shape.length) / 2.0
    return 2.0 * shape.radius if isinstance(shape, Sphere) else None
