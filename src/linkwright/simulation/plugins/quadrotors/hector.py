"""Quadrotors of hector: ``libhector_gazebo_quadrotor_simple_controller.so``.

Source: hector_quadrotor (parameters, defaults, topics, services, formulas). The true motion replaces the topics
``imuTopic`` and ``stateTopic``, and the controllers run at each step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.messages import Vector3, from_values, get_message
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.quadrotors.control import (
    LOOPS,
    TWIST_TYPE,
    Quadrotor,
    QuadrotorParameters,
    gain_names,
)


@dataclass(frozen=True, kw_only=True)
class HectorControllerParameters(QuadrotorParameters):
    """Parameters of ``libhector_gazebo_quadrotor_simple_controller.so``."""

    topic_name: str = parameter("cmd_vel", aliases=("topicName",))
    wrench_topic: str = parameter("wrench_out", aliases=("wrenchTopic",))
    auto_engage: bool = parameter(default=True, aliases=("autoEngage",))


_ENGAGE_SPEED, _REST_SPEED, _LANDED_INTEGRAL = 0.1, 0.1, -1.0
"""The vertical speeds in m/s, and the integral of their error in m, that start and stop the motors."""


class HectorController(Quadrotor[HectorControllerParameters]):
    """The substitute for ``libhector_gazebo_quadrotor_simple_controller.so``.

    The motors start with a command to climb, and stop when the model cannot sink further. The services ``engage`` and
    ``shutdown`` start and stop them, too.
    """

    PARAMETERS = HectorControllerParameters
    IGNORED = (*gain_names(LOOPS), "imuTopic", "stateTopic", "updateRate", "controlPeriod", "controlRate")
    CARRIED = ("command", "loops", "_is_running")

    def start(self) -> None:
        """Find the body, and create topics and services.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a gain is not a number.
        """
        super().start()
        node, parameters = self.node, self.parameters
        self._is_running = False
        guard = node.command_guard(self.stop_motion)
        node.subscribe(
            TWIST_TYPE,
            parameters.topic_name,
            self.set_command,
            1,
            command_guard=guard,
            stop_motion=self.stop_motion,
        )
        self._output = node.publisher("geometry_msgs/msg/Wrench", parameters.wrench_topic)
        node.service("std_srvs/srv/Empty", "engage", lambda _, response: self._switch(response, is_on=True))
        node.service("std_srvs/srv/Empty", "shutdown", lambda _, response: self._switch(response, is_on=False))
        self.every(0.0, self._control)

    def reset(self) -> None:
        """Stop the motors, and drop the command."""
        super().reset()
        self._is_running = False

    def _switch(self, response: Any, *, is_on: bool) -> Any:
        self._is_running = is_on
        return response

    def _control(self) -> None:
        motion, (linear, angular) = self.sense(), self.command
        if self.parameters.auto_engage:
            self._engage(float(linear[2]), float(motion.velocity[2]))
        if self._is_running:
            torque = self.compute_velocity_torque(motion, linear) + self.compute_yaw_torque(motion, angular[2])
            force = self.compute_force(motion, linear[2])
        else:
            self.reset_loops()
            force = torque = np.zeros(3)
        self.push(self.body, motion.rotation @ force, motion.rotation @ torque, at=motion.position)
        if self._output.is_wanted:
            wrench = get_message("geometry_msgs/msg/Wrench")()
            wrench.force, wrench.torque = from_values(Vector3, force.tolist()), from_values(Vector3, torque.tolist())
            self._output.publish(wrench)

    def _engage(self, climb: float, velocity: float) -> None:
        """Start the motors for a command to climb, and stop them when the model cannot sink further."""
        if climb > _ENGAGE_SPEED:
            self._is_running = True
        elif climb < -_ENGAGE_SPEED and abs(velocity) < _REST_SPEED:
            self._is_running &= self.loops["velocityZ"].integral >= _LANDED_INTEGRAL
