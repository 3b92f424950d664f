"""Fins of vehicles under water: ``libuuv_fin_ros_plugin.so``.

A command turns the fin about its joint, through the dynamics of its drive. The water lifts and slows the fin according
to the velocity v of the link past the water in the plane x, y of the link, with the angle a = atan(vy / vx):

    Quadratic:  lift = c a v^2,  drag = d a^2 v^2
    TwoLines:   lift = cl(a + a0) q A,  drag = cd(a + a0) q A,  q = rho v^2 / 2

where cl and cd rise with one slope up to the angle of stall, and with another one beyond it. The lift acts across v in
that plane, and the drag against v, at the center of mass.

Source: uuv_simulator (parameters, topics, formulas). There, drag at a negative angle of TwoLines pushes forward, and
the lift beyond the negative angle of stall has the slope of the drag.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import atan2, copysign, isnan, pi
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.messages import Header, get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.sensors.base import vector_to_message
from linkwright.simulation.plugins.underwater.dynamics import create_step, require_child, unknown_type_error
from linkwright.xmltree import Element

_FLOAT_TYPE, _WRENCH_TYPE = "uuv_gazebo_ros_plugins_msgs/msg/FloatStamped", "geometry_msgs/msg/WrenchStamped"
_RATE_HZ = 20.0

Coefficients = Callable[[float], tuple[float, float]]
"""Returns lift and drag in N s2/m2, as multiples of the squared speed, for an angle in rad."""


@dataclass(frozen=True, kw_only=True)
class FinParameters:
    """Parameters of ``libuuv_fin_ros_plugin.so``."""

    fin_id: int
    link_name: str
    joint_name: str
    current_velocity_topic: str = ""
    output_topic: str = ""
    wrench_topic: str = ""


class UuvFin(SimulatedPlugin[FinParameters]):
    """The substitute for ``libuuv_fin_ros_plugin.so``.

    The angle in rad is commanded on ``/MODEL/fins/ID/input``, and published on ``/MODEL/fins/ID/output``.
    """

    PARAMETERS = FinParameters
    IGNORED = ("dynamics", "liftdrag", "input_topic")
    CARRIED = ("_command", "_angle")

    def start(self) -> None:
        """Find the fin, and create the topics.

        Raises:
            LinkwrightError: SIM133, SIM134, there is no such link or joint; SIM160, a formula is not valid.
        """
        parameters, simulation = self.parameters, self.simulation
        self._link, joint = self.link(parameters.link_name), self.joint(parameters.joint_name)
        self._advance = create_step(self, require_child(self, "dynamics"))
        self._compute_coefficients = self._read_coefficients(require_child(self, "liftdrag"))
        limit = simulation.scene.joints[joint].axes[0][0].limit
        self._limits = limit.lower, limit.upper
        self._servo = simulation.add_servo(joint, 1000.0)
        simulation.keep_awake(self._link)
        self._current = np.zeros(3)
        self.reset()
        prefix = f"/{self.context.path.replace(SEPARATOR, '/')}/fins/{parameters.fin_id}"
        self.node.subscribe(_FLOAT_TYPE, f"{prefix}/input", self._on_command)
        if topic := parameters.current_velocity_topic.strip("/"):
            self.node.subscribe("geometry_msgs/msg/TwistStamped", f"/{topic}", self._on_current)
        self._angle_output = self.node.publisher(_FLOAT_TYPE, parameters.output_topic or f"{prefix}/output")
        self._force_output = self.node.publisher(_WRENCH_TYPE, parameters.wrench_topic or f"{prefix}/wrench_topic")
        self.every(0.0, self._move)
        self.every(_RATE_HZ, self._publish)

    def reset(self) -> None:
        """Turn the fin to the angle 0."""
        self._command = self._angle = 0.0
        self._force: Array = np.zeros(3)

    def _read_coefficients(self, element: Element) -> Coefficients:
        kind = self.text_in(element, "type")
        if kind == "Quadratic":
            lift, drag = (self.number_in(element, f"{name}_constant") for name in ("lift", "drag"))
            return lambda angle: (lift * angle, drag * angle**2)
        if kind == "TwoLines":
            return self._read_two_lines(element)
        raise unknown_type_error(self, element, "Quadratic, TwoLines")

    def _read_two_lines(self, element: Element) -> Coefficients:
        area, density, offset, stall = (
            self.number_in(element, tag) for tag in ("area", "fluid_density", "a0", "alpha_stall")
        )
        lift, lift_stall, drag, drag_stall = (
            self.number_in(element, tag) for tag in ("cla", "cla_stall", "cda", "cda_stall")
        )
        scale, repeats_mistakes = 0.5 * density * area, self.gazebo_mistakes

        def compute(angle: float) -> tuple[float, float]:
            attack = (angle + offset + pi / 2) % pi - pi / 2
            inside = copysign(min(abs(attack), stall), attack)
            beyond = attack - inside
            lift_slope = drag_stall if repeats_mistakes and attack < -stall else lift_stall
            resistance = drag * inside + drag_stall * beyond
            if not repeats_mistakes:
                resistance = drag * abs(inside) + drag_stall * abs(beyond)
            return scale * (lift * inside + lift_slope * beyond), scale * resistance

        return compute

    def _on_command(self, message: Any) -> None:
        if not isnan(message.data):
            self._command = float(message.data)

    def _on_current(self, message: Any) -> None:
        linear = message.twist.linear
        self._current = np.array((linear.x, linear.y, linear.z))

    def _move(self) -> None:
        simulation = self.simulation
        simulation.refresh()
        lower, upper = self._limits
        seconds = simulation.step / NANOSECONDS_PER_SECOND
        self._command = min(max(self._command, lower), upper)
        self._angle = self._advance(self._angle, self._command, seconds)
        self._servo.move(self._angle, seconds)
        axes = simulation.data.xmat[simulation.body(self._link)].reshape(3, 3)
        x, y, _ = ((simulation.link_velocity(self._link)[0] - self._current) @ axes).tolist()
        self._force = self._compute_force(x, y)
        self.push(self._link, axes @ self._force)

    def _compute_force(self, x: float, y: float) -> Array:
        """Return the force in N for the velocity in m/s past the water, in the axes of the link."""
        square = x * x + y * y
        if not square:
            return np.zeros(3)
        angle = (atan2(y, x) + pi / 2) % pi - pi / 2
        lift, drag = self._compute_coefficients(angle)
        forward = np.array((x, y, 0.0)) / square**0.5
        force: Array = square * (lift * np.array((forward[1], -forward[0], 0.0)) - drag * forward)
        return force

    def _publish(self) -> None:
        header = Header(stamp=self.stamp(), frame_id=self._link.rpartition(SEPARATOR)[2])
        self._angle_output.publish(get_message(_FLOAT_TYPE)(header=header, data=self._angle))
        wrench = get_message("geometry_msgs/msg/Wrench")(force=vector_to_message(self._force))
        self._force_output.publish(get_message(_WRENCH_TYPE)(header=header, wrench=wrench))
