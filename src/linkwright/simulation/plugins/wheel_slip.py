"""Wheels whose slip grows with the force on them.

The plugins are ``gz-sim-wheel-slip-system``, ``libWheelSlipPlugin.so`` and ``libgazebo_ros_wheel_slip.so``.

Below the limit of friction, the slip ratio of a wheel is its compliance times the ratio of the tangential force to the
normal force. The contact point therefore moves against the force at ``c w r / N`` per newton, with the compliance c,
the speed w and the radius r of the wheel, and the normal force N of the parameters.

Here the surface of the wheel moves at this velocity. It follows the force of the last step with a delay that keeps the
contact stable.

Source: gz-sim, Gazebo Classic and gazebo_ros_pkgs for ROS 2 (parameters, topic, formulas).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2
from typing import Generic, TypeVar

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.messages import get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element

P = TypeVar("P")
_STABLE_GAIN = 0.5
"""The share of the greatest gain with which the surface follows the force without oscillation."""
_PARAMETER_RATE_HZ = 10.0
"""The rate at which ROS parameters are read, in Hz of simulated time."""
_COMPLIANCE_PARAMETER = "slip_compliance_unitless"
_SLIP_TYPE = "gazebo_msgs/msg/WheelSlip"


@dataclass(slots=True)
class _Wheel:
    """A wheel.

    Attributes:
        link, joint: the link and the joint that turns it, with their full names.
        name: the name of the link in the parameters.
        lateral, longitudinal: the compliances, the ratio of the slip ratio to the force ratio.
        normal_force: the normal force in N.
        radius: the radius in m.
        slip: the velocity of the contact point against the forces in m/s, in world axes.
        directions: the lateral and the longitudinal direction in the last contact, in world axes.
    """

    link: str
    joint: str
    name: str
    lateral: float
    longitudinal: float
    normal_force: float
    radius: float
    slip: Array = field(default_factory=lambda: np.zeros(3))
    directions: Array = field(default_factory=lambda: np.zeros((2, 3)))


class _WheelSlip(SimulatedPlugin[P], Generic[P]):
    """A plugin that lets wheels slip."""

    IGNORED = ("wheel",)  # read by start

    def start(self) -> None:
        """Find the wheels.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, there is no wheel, or it is not valid.
        """
        element = self.context.element
        self.wheels = [self._read_wheel(child) for child in (() if element is None else element.elements("wheel"))]
        if not self.wheels:
            message = phrase("plugin '{plugin}': <{tag}> is missing", plugin=self.context.name, tag="wheel")
            raise self.parameter_error(message)
        self._revision = -1
        self._geoms: dict[str, list[int]] = {}
        self.every(0.0, self._apply_slip)

    def reset(self) -> None:
        """Let the wheels stick again."""
        for wheel in self.wheels:
            wheel.slip = np.zeros(3)

    def stop(self) -> None:
        """Stop the surfaces of the wheels."""
        for geoms in self._geoms.values():
            self.simulation.model.geom_surfacevel[geoms] = 0.0

    def _read_wheel(self, element: Element) -> _Wheel:
        name, simulation = element.attributes.get("link_name", ""), self.simulation
        link = self.link(name)
        joints = [joint for joint, placed_joint in simulation.scene.joints.items() if placed_joint.child == link]
        radius = self.number_in(element, "wheel_radius", simulation.wheel_radius(link) or 0.0)
        normal_force = self.number_in(element, "wheel_normal_force", 0.0)
        if len(joints) != 1 or min(radius, normal_force) <= 0.0:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': the wheel '{link}' needs a joint, and a <wheel_radius> and a "
                    "<wheel_normal_force> greater than 0",
                    plugin=self.context.name,
                    link=name,
                )
            )
        simulation.keep_awake(link)
        return _Wheel(
            link,
            joints[0],
            name,
            max(self.number_in(element, "slip_compliance_lateral", 0.0), 0.0),
            max(self.number_in(element, "slip_compliance_longitudinal", 0.0), 0.0),
            normal_force,
            radius,
        )

    def _find_geoms(self) -> None:
        """Find the geoms of the wheels, if the model was rebuilt."""
        simulation = self.simulation
        simulation.refresh()
        if self._revision == simulation.revision:
            return
        self._revision, model = simulation.revision, simulation.model
        names = [model.geom(geom).name for geom in range(model.ngeom)]
        self._geoms = {
            wheel.link: [
                geom
                for geom, name in enumerate(names)
                if name.startswith(f"{wheel.link}{SEPARATOR}") and "#collision" in name
            ]
            for wheel in self.wheels
        }

    def _apply_slip(self) -> None:
        self._find_geoms()
        simulation = self.simulation
        model, seconds = simulation.model, simulation.step / NANOSECONDS_PER_SECOND
        mass = simulation.mass_of(self.context.path.partition(SEPARATOR)[0]) / len(self.wheels)
        for wheel in self.wheels:
            speed = abs(simulation.joint_state(wheel.joint)[1]) * wheel.radius
            force = self._measure_force(wheel)
            target = np.zeros(3)
            for compliance, direction in zip((wheel.lateral, wheel.longitudinal), wheel.directions, strict=True):
                slip_per_force = compliance * speed / wheel.normal_force
                gain = min(_STABLE_GAIN * seconds / max(slip_per_force * mass, 1e-12), 1.0)
                old_slip = float(wheel.slip @ direction)
                target += (old_slip + gain * (slip_per_force * float(force @ direction) - old_slip)) * direction
            wheel.slip = target
            for geom in self._geoms[wheel.link]:
                model.geom_surfacevel[geom, :3] = target @ simulation.data.geom_xmat[geom].reshape(3, 3)
            if target.any():
                model.flg_surfacevel = True

    def _measure_force(self, wheel: _Wheel) -> Array:
        """Return the force of the ground on a wheel in N, in world axes.

        The directions of the wheel's slip are updated.
        """
        simulation, mujoco = self.simulation, load_mujoco()
        model, data, wrench, total = simulation.model, simulation.data, np.zeros(6), np.zeros(3)
        pairs = data.contact.geom[: data.ncon]
        is_second = np.isin(pairs[:, 1], self._geoms[wheel.link])
        for index in np.nonzero(is_second | np.isin(pairs[:, 0], self._geoms[wheel.link]))[0]:
            mujoco.mj_contactForce(model, data, int(index), wrench)
            sign = 1.0 if is_second[index] else -1.0  # frame and force point from the first geom to the second
            frame = data.contact.frame[index].reshape(3, 3) * sign
            total += wrench[:3] @ frame
            lateral = np.array(data.joint(wheel.joint).xaxis)
            lateral -= (lateral @ frame[0]) * frame[0]
            lateral /= max(float(np.linalg.norm(lateral)), 1e-9)
            wheel.directions = np.array((lateral, np.cross(lateral, frame[0])))
        return total


class GzWheelSlip(_WheelSlip[NoParameters]):
    """The substitute for ``gz-sim-wheel-slip-system`` and ``libWheelSlipPlugin.so``."""


@dataclass(frozen=True, kw_only=True)
class WheelSlipParameters:
    """Parameters of ``libgazebo_ros_wheel_slip.so``."""

    publisher_update_rate: float = 100.0
    wheel_spin_tolerance: float = 1e-3


class ClassicWheelSlip(_WheelSlip[WheelSlipParameters]):
    """The substitute for ``libgazebo_ros_wheel_slip.so``.

    ROS parameters change the compliances: ``slip_compliance_unitless_lateral`` and ``..._longitudinal`` for all wheels,
    and with ``/LINK`` for one.
    """

    PARAMETERS = WheelSlipParameters

    def start(self) -> None:
        """Find the wheels, declare the parameters, and create the topic of the slips.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, there is no wheel, or it is not valid.
        """
        super().start()
        self._values: dict[tuple[str, str], float] = {}
        self._set_compliances()
        self._output = self.node.publisher(_SLIP_TYPE, "wheel_slip")
        self.every(_PARAMETER_RATE_HZ, self._set_compliances)
        self.every(self.parameters.publisher_update_rate, self._publish)

    def _set_compliances(self) -> None:
        """Adopt the ROS parameters that have changed."""
        for side in ("lateral", "longitudinal"):
            name = f"{_COMPLIANCE_PARAMETER}_{side}"
            shared_value = float(self.node.parameter(name, -1.0))
            for wheel in self.wheels:
                own_default = shared_value if shared_value >= 0.0 else getattr(wheel, side)
                own_value = float(self.node.parameter(f"{name}/{wheel.name}", own_default))
                for key, value in (((name, wheel.name), shared_value), ((f"{name}/", wheel.name), own_value)):
                    if value >= 0.0 and value != self._values.get(key):
                        setattr(wheel, side, value)
                    self._values[key] = value

    def _publish(self) -> None:
        """Publish the slips of the wheels.

        The lateral slip is an angle in rad, and the longitudinal slip a fraction of the wheel's speed.
        """
        if not self._output.is_wanted:
            return
        message = get_message(_SLIP_TYPE)()
        for wheel in self.wheels:
            velocity, _ = self.simulation.link_velocity(wheel.link)
            lateral, longitudinal = (float(velocity @ direction) for direction in wheel.directions)
            spin = self.simulation.joint_state(wheel.joint)[1] * wheel.radius
            is_spinning = abs(spin) >= self.parameters.wheel_spin_tolerance
            message.name.append(wheel.name)
            message.lateral_slip.append(atan2(lateral, longitudinal) if is_spinning else 0.0)
            message.longitudinal_slip.append((spin - longitudinal) / spin if is_spinning else 0.0)
        self._output.publish(message)
