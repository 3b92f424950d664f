"""Bodies under water: ``libuuv_underwater_object_ros_plugin.so``.

Each ``<link>`` of the plugin has a volume, a center of buoyancy, and the coefficients of Fossen's equations in axes
forward, right, down. The body floats up through the surface at z = 0 within the height of its ``<box>``; a surface
vessel has a plane of the water instead, and righting torques by its metacentric heights.

Source: uuv_simulator (parameters, defaults, formulas); T. I. Fossen, *Handbook of Marine Craft Hydrodynamics and Motion
Control*, 2011, 4.2 and 8.3. Services, and the topics of forces for debugging, are left out. In uuv_simulator, a
body whose center is above the surface has no buoyancy at all.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import rpy_from_quaternion
from linkwright.simulation.plugins.entities import vector_components
from linkwright.simulation.plugins.fluids.body_in_water import BodyInWater
from linkwright.simulation.plugins.fluids.displacement import Solid
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element

_FLIP = np.diag((1.0, -1.0, -1.0, 1.0, -1.0, -1.0))
"""The rotation of velocities and forces between the axes forward, right, down, and forward, left, up."""
_SPHERE_DRAG = 0.5
_AXES = {"i": 0, "j": 1, "k": 2}
_END_DRAG = ((1.0, 0.91), (2.0, 0.85), (4.0, 0.87), (float("inf"), 0.99))
_SIDE_DRAG = ((1.0, 0.63), (2.0, 0.68), (5.0, 0.74), (10.0, 0.82), (float("inf"), 0.98))
"""The drag coefficients of the ends and of the side of cylinders, up to ratios of length to diameter."""


@dataclass(frozen=True, kw_only=True)
class VehicleParameters:
    """Parameters of ``libuuv_underwater_object_ros_plugin.so``."""

    fluid_density: float = 1028.0
    flow_velocity_topic: str = ""
    use_global_current: bool = True


@dataclass(frozen=True, slots=True)
class _Vessel:
    """A surface vessel: the height in m up to which it is in the water at rest, and its metacentric heights in m."""

    submerged_height: float
    width: float
    length: float


@dataclass(frozen=True, slots=True)
class _Buoyancy:
    """The parameters of the buoyancy of a link.

    Attributes:
        volume: the volume of the link in m3.
        center: the center of buoyancy in the frame of the link, in m, shape (3,).
        height: the height in m within which the link emerges.
        vessel: the parameters of a surface vessel; None for other bodies.
    """

    volume: float
    center: Array
    height: float
    vessel: _Vessel | None


class UnderwaterVehicle(SimulatedPlugin[VehicleParameters]):
    """The substitute for ``libuuv_underwater_object_ros_plugin.so``."""

    PARAMETERS = VehicleParameters
    IGNORED = ("link", "debug")
    CARRIED = ("_current",)

    def start(self) -> None:
        """Read the links, and subscribe to the current.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a coefficient is not valid.
        """
        element = self.context.element
        links = () if element is None else element.elements("link")
        self._bodies = [self._read_link(link) for link in links]
        self._current: Array = np.zeros(3)
        topic = self.parameters.flow_velocity_topic.strip("/")
        if topic and self.parameters.use_global_current:
            self.node.subscribe("geometry_msgs/msg/TwistStamped", f"/{topic}", self._on_current)
        self.every(0.0, self._apply_forces)
        self._apply_forces()

    def reset(self) -> None:
        """Restore still water."""
        self._current = np.zeros(3)
        for body, _ in self._bodies:
            body.reset()

    def _on_current(self, message: Any) -> None:
        self._current = np.array(vector_components(message.twist.linear))

    # --- reading ------------------------------------------------------------------------------------------------------

    def _read_link(self, element: Element) -> tuple[BodyInWater, _Buoyancy]:
        simulation = self.simulation
        simulation.refresh()
        link = self.link(element.attributes.get("name", ""))
        body, solid = BodyInWater(simulation, link), Solid.from_link(simulation, link)
        size = np.zeros(3) if solid is None else np.ptp(solid.corners.reshape(-1, 3), axis=0)
        box = element.first("box")
        if box is not None:
            size = np.array([self.number_in(box, tag) for tag in ("width", "length", "height")])
        density = self.parameters.fluid_density
        volume = self.number_in(element, "volume", 0.0)
        if self.text_in(element, "neutrally_buoyant").lower() in ("true", "1"):
            volume = float(simulation.model.body_mass[simulation.body(link)]) / density
        center = self._read_numbers(element, "center_of_buoyancy", (3,))
        vessel = None
        tags = ("submerged_height", "metacentric_width", "metacentric_length")
        if all(element.first(tag) is not None for tag in tags):
            draught = self._read_positive(element, "submerged_height", 0.0)
            vessel = _Vessel(draught, *(self.number_in(element, tag) for tag in tags[1:]))
        model = element.first("hydrodynamic_model")
        if model is not None:
            self._read_fossen(body, model)
            self._add_shape(body, model, size.tolist())
        return body, _Buoyancy(volume, center, float(size[2]), vessel)

    def _read_fossen(self, body: BodyInWater, model: Element) -> None:
        """Set the coefficients of Fossen's equations."""
        linear, forward, quadratic = (
            self._read_matrix(model, tag)
            for tag in ("linear_damping", "linear_damping_forward_speed", "quadratic_damping")
        )
        body.added_mass = _FLIP @ self._read_numbers(model, "added_mass", (36,)).reshape(6, 6) @ _FLIP
        body.linear = -_FLIP @ linear @ _FLIP
        body.quadratic[:, :, 0] = -_FLIP @ forward @ _FLIP
        for index in range(6):
            body.absolute[index, index, index] = -quadratic[index, index]

    def _read_matrix(self, parent: Element, tag: str) -> Array:
        """Return a matrix of 36 numbers, or of the 6 on its diagonal, shape (6, 6)."""
        numbers = self._read_numbers(parent, tag, (6, 36))
        return np.diag(numbers) if len(numbers) == 6 else numbers.reshape(6, 6)

    def _read_numbers(self, parent: Element, tag: str, counts: tuple[int, ...]) -> Array:
        """Return the numbers in a child, by default zeros; there must be one of some counts."""
        text = self.text_in(parent, tag)
        if not text:
            return np.zeros(counts[0])
        try:
            numbers = [float(word) for word in text.split()]
        except ValueError:
            numbers = []
        if len(numbers) not in counts:
            raise self.parameter_error(
                phrase("<{parent}> needs {count} numbers in <{tag}>", parent=parent.tag, count=counts[-1], tag=tag),
                parent,
            )
        return np.array(numbers)

    def _read_positive(self, parent: Element, tag: str, default: float) -> float:
        """Return the number in a child, which must be greater than 0."""
        number = self.number_in(parent, tag, default)
        if not number > 0.0:
            message = phrase("<{parent}> needs a number greater than 0 in <{tag}>", parent=parent.tag, tag=tag)
            raise self.parameter_error(message, parent)
        return number

    def _add_shape(self, body: BodyInWater, model: Element, size: list[float]) -> None:
        """Set the added mass and the drag of a simple shape."""
        kind, density = self.text_in(model, "type"), self.parameters.fluid_density
        if kind == "sphere":
            radius = self._read_positive(model, "radius", min(size))
            for index in range(3):
                body.added_mass[index, index] = 2.0 / 3.0 * density * pi * radius**3
                body.absolute[index, index, index] = 0.5 * density * _SPHERE_DRAG * pi * radius**2
        elif kind == "cylinder":
            self._add_cylinder(body, model, size)
        elif kind == "box":
            length, width, height = (self.number_in(model, tag) for tag in ("length", "width", "height"))
            drag = self.number_in(model, "cd", 1.0)
            for index, area in enumerate((width * height, length * height, width * length)):
                body.absolute[index, index, index] = 0.5 * density * drag * area
        elif kind != "fossen":
            message = phrase(
                "plugin '{plugin}': the <type> of the hydrodynamic model must be fossen, sphere, cylinder or box",
                plugin=self.context.name,
            )
            raise self.parameter_error(message, model)

    def _add_cylinder(self, body: BodyInWater, model: Element, size: list[float]) -> None:
        density = self.parameters.fluid_density
        radius = self._read_positive(model, "radius", min(size))
        length = self._read_positive(model, "length", max(size))
        axis = _AXES.get(self.text_in(model, "axis"), int(np.argmax(size)))
        ratio, section = length / (2.0 * radius), pi * radius**2
        for index in range(3):
            is_axis = index == axis
            body.added_mass[index, index] = density * section * (1.0 if is_axis else length)
            area, table = (section, _END_DRAG) if is_axis else (radius * length, _SIDE_DRAG)
            body.absolute[index, index, index] = 0.5 * density * area * _choose_drag(table, ratio)
            if not is_axis:
                body.added_mass[3 + index, 3 + index] = density * section * length**3 / 12.0

    # --- forces -------------------------------------------------------------------------------------------------------

    def _apply_forces(self) -> None:
        self.simulation.refresh()
        for body, buoyancy in self._bodies:
            force, torque, point = body.compute_forces(self._current)
            lift, righting, arm = self._compute_buoyancy(body.link, buoyancy)
            self.push(body.link, force + lift, torque + righting + np.cross(arm, lift), at=point)

    def _compute_buoyancy(self, link: str, buoyancy: _Buoyancy) -> tuple[Array, Array, Array]:
        """Return the force, the torque, and the arm of the force from the origin of the link, in world axes."""
        simulation = self.simulation
        index, model = simulation.body(link), simulation.model
        rotation, (_, _, z) = simulation.data.xmat[index].reshape(3, 3), simulation.data.xpos[index].tolist()
        gravity, density, height = model.opt.gravity, self.parameters.fluid_density, buoyancy.height
        vessel = buoyancy.vessel
        if vessel is None:
            share = min(max(0.5 - z / height, 0.0), 1.0) if height > 0.0 else float(z < 0.0)
            if self.gazebo_mistakes and z >= 0.0:
                share = 0.0
            return -density * buoyancy.volume * share * gravity, np.zeros(3), rotation @ buoyancy.center
        area = float(model.body_mass[index]) / (density * vessel.submerged_height)
        depth = min(max(height / 2.0 - z, 0.0), height)
        force = -density * area * depth * gravity
        x, y, z, w = simulation.link_pose(link)[3:]
        roll, pitch, _ = rpy_from_quaternion((x, y, z, w))
        righting = np.array((-vessel.width * np.sin(roll), -vessel.length * np.sin(pitch), 0.0))
        center = simulation.data.xipos[index] - simulation.data.xpos[index]
        return force, rotation @ righting * float(np.linalg.norm(force)), center


def _choose_drag(table: tuple[tuple[float, float], ...], ratio: float) -> float:
    return next(drag for limit, drag in table if ratio <= limit)
