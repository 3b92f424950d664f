"""Sudden losses of kinetic energy: ``gz-sim-kinetic-energy-monitor-system``.

Source: gz-sim (parameters, defaults, topic). gz publishes the loss within a step if it exceeds the threshold. Contacts
are softer here and stop a body within many steps, so the plugin publishes the loss of a whole decrease.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.messages import get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_FLOAT_TYPE = "std_msgs/msg/Float64"
_MAX_IMPACT_NS = NANOSECONDS_PER_SECOND // 20
"""The time after which a decrease is divided, in nanoseconds; impacts are shorter."""


@dataclass(frozen=True, kw_only=True)
class KineticEnergyParameters:
    """Parameters of ``gz-sim-kinetic-energy-monitor-system``."""

    link_name: str = parameter()
    kinetic_energy_threshold: float = 7.0
    topic: str = ""


class GzKineticEnergy(SimulatedPlugin[KineticEnergyParameters]):
    """The substitute for ``gz-sim-kinetic-energy-monitor-system``."""

    PARAMETERS = KineticEnergyParameters
    CARRIED = ("_energy", "_peak", "_peak_time")

    def start(self) -> None:
        """Find the link, and create the topic.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        self._link = self.link(self.parameters.link_name)
        self.reset()
        self._output = self.node.publisher(
            _FLOAT_TYPE, self.parameters.topic or f"/model/{self.context.path}/kinetic_energy"
        )
        self.every(0.0, self._detect_loss)

    def reset(self) -> None:
        """Discard the energy of the previous steps."""
        self._energy = self._peak = 0.0
        self._peak_time = 0

    def _detect_loss(self) -> None:
        """Publish the loss of a decrease that has just ended."""
        old_energy, self._energy, now = self._energy, self._compute_kinetic_energy(), self.simulation.time
        is_decreasing = self._energy < old_energy
        if is_decreasing and now - self._peak_time < _MAX_IMPACT_NS:
            return
        loss = self._peak - (self._energy if is_decreasing else old_energy)
        self._peak, self._peak_time = self._energy, now
        if loss > self.parameters.kinetic_energy_threshold:
            self._output.publish(get_message(_FLOAT_TYPE)(data=loss))

    def _compute_kinetic_energy(self) -> float:
        """Return the kinetic energy of the link in J, of its translation and its rotation."""
        simulation, mujoco, velocity = self.simulation, load_mujoco(), np.zeros(6)
        body = simulation.body(self._link)
        in_body_axes = 1
        mujoco.mj_objectVelocity(
            simulation.model, simulation.data, mujoco.mjtObj.mjOBJ_BODY, body, velocity, in_body_axes
        )
        squares = velocity * velocity
        inertia, mass = simulation.model.body_inertia[body], simulation.model.body_mass[body]
        return 0.5 * float(inertia @ squares[:3] + mass * squares[3:].sum())
