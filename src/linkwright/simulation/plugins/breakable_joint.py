"""A joint that breaks under a force: ``libBreakableJointPlugin.so``.

Source: Gazebo Classic (the parameter and its default; the joint breaks when the length of the force that its
force-torque sensor measures is greater than the parameter, and stays broken).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.scene.breaking import Breaking


@dataclass(frozen=True, kw_only=True)
class BreakableJointParameters:
    """Parameters of the plugin."""

    breaking_force_N: float = 1.0  # noqa: N815  # Gazebo's name


class BreakableJoint(SimulatedPlugin[BreakableJointParameters]):
    """The substitute for ``libBreakableJointPlugin.so``, in a sensor of the joint."""

    PARAMETERS = BreakableJointParameters
    CARRIED = ("_is_broken",)

    def start(self) -> None:
        """Find the constraints of the joint, and check its force at the rate of the sensor.

        Raises:
            LinkwrightError: SIM160, the plugin is not in a sensor of a joint, or the type of the joint cannot break.
        """
        joint = self.sensor.joint
        self._is_broken, self._breaking = False, Breaking(self.simulation.scene.spec, joint)
        if not joint or not self._breaking.links:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}' must be in a force-torque sensor of a joint that can break: fixed, revolute or "
                    "ball, or with equal limits",
                    plugin=self.context.name,
                )
            )
        self._name = joint.rpartition(SEPARATOR)[2]
        for link in self._breaking.links:
            self.simulation.keep_awake(link)
        self.every(self.sensor.sensor.update_rate, self._break_if_loaded)

    def reset(self) -> None:
        """Connect the links again, because simulated time restarts."""
        self._set_broken(is_broken=False)

    def resume(self, previous: SimulatedPlugin[BreakableJointParameters]) -> None:
        """Break the joint if the previous instance had broken it."""
        super().resume(previous)
        self._set_broken(is_broken=self._is_broken)

    def _break_if_loaded(self) -> None:
        if self._is_broken:
            return
        force = float(np.linalg.norm(self._breaking.compute_force(self.simulation.model, self.simulation.data)))
        if force > self.parameters.breaking_force_N:
            self._set_broken(is_broken=True)
            message = phrase(
                "joint '{joint}' breaks under a force of {force} N", joint=self._name, force=f"{force:.4g}"
            )
            self.node.logger.info(message)

    def _set_broken(self, *, is_broken: bool) -> None:
        self._is_broken = is_broken
        self.simulation.refresh()
        self._breaking.set_broken(self.simulation.model, self.simulation.data, is_broken=is_broken)
