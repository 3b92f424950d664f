"""``ur_controllers/ScaledJointTrajectoryController``: trajectories at a scaled speed.

Source: ur_controllers of the driver for Universal Robots (the parameter; the factor scales the time of a trajectory).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from linkwright.control.controllers.action import Goal
from linkwright.control.controllers.controller import InterfaceNames
from linkwright.control.controllers.joint_trajectory_controller import JointTrajectoryController
from linkwright.control.controllers.joint_trajectory_parameters import Parameters
from linkwright.control.hardware.interfaces import Interfaces, StateInterface
from linkwright.control.motion.splines import MotionState
from linkwright.control.motion.trajectory import Trajectory
from linkwright.nodes.parameter_tables import parameter
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND


@dataclass(frozen=True, kw_only=True)
class ScaledParameters(Parameters):
    """The parameters of a scaled_joint_trajectory_controller."""

    speed_scaling_interface_name: str = parameter(
        "speed_scaling/speed_scaling_factor",
        read_only=True,
        description="the state interface of the speed factor, 1 for the planned speed; empty for none",
    )


class ScaledJointTrajectoryController(JointTrajectoryController):
    """A controller that scales the time of trajectories by a factor from the hardware.

    On robots of Universal Robots, the speed slider sets the factor.
    """

    PARAMETERS = ScaledParameters

    @property
    def _factor_name(self) -> str:
        parameters = self.parameters
        assert isinstance(parameters, ScaledParameters)
        return parameters.speed_scaling_interface_name

    def state_interfaces(self) -> InterfaceNames:
        """Return the state interfaces of the joints, followed by the scaling factor if it is named."""
        names, factor_name = super().state_interfaces(), self._factor_name
        assert not isinstance(names, Interfaces), "the joints are named"
        return [*names, factor_name] if factor_name else names

    def on_activate(self) -> None:
        """Hold the joints at their current positions."""
        self._factor: StateInterface | None = None
        if self._factor_name:
            *self.states, self._factor = self.states
        self._delay_ns = 0
        super().on_activate()

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the trajectory at the scaled time.

        Each new trajectory resets the scaled time.
        """
        if self._factor is not None and isfinite(self._factor.value):
            self._delay_ns += round((1.0 - max(self._factor.value, 0.0)) * period_s * NANOSECONDS_PER_SECOND)
        super().update(time_ns - self._delay_ns, period_s)

    def _follow(self, trajectory: Trajectory) -> None:
        self._delay_ns = 0
        super()._follow(trajectory)

    def _publish_feedback(self, goal: Goal, time_ns: int, desired: MotionState) -> None:
        super()._publish_feedback(goal, time_ns + self._delay_ns, desired)

    def _publish_state(self, time_ns: int, desired: MotionState) -> None:
        super()._publish_state(time_ns + self._delay_ns, desired)
