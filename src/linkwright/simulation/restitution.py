"""Time steps of MuJoCo with restitution: colliding bodies bounce off each other within a step.

MuJoCo's contacts are soft and absorb the speed of a hard impact: at usual time steps, no setting lets a ball rise as
high as its coefficient of restitution requires. Therefore bodies that collide receive impulses after the step of the
collision, according to Newton's law of impact with Coulomb friction.

Bodies are also moved to the poses that they would have if they had separated at the moment of contact, and not at the
end of the step, in which they penetrate further. Otherwise a ball with a coefficient of 0.2 rose a fifth too low after
a fall from 1 m.

Source of the figures: drops of balls, boxes, cylinders and capsules from 0.3, 1 and 3 m, with coefficients of 0.2, 0.5
and 0.9.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.sdf.surfaces import USUAL_SURFACE
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.recovery import Recovery
from linkwright.simulation.scene.surfaces import RESTITUTION_DATA

_LEAST = 0.1
"""The least speed in m/s at which bodies bounce, as in DART, gz's engine."""
_ROUNDS = 50
"""The number of iterations over all impulses: a box that lands flat has four."""


class Stepper:
    """Simulates the time steps of a model, with restitution.

    Both shapes in a contact need a coefficient of restitution, and their product applies, as in gz. As in Gazebo
    Classic, a pair bounces only above the lower of the two velocity thresholds, if one is set; gz has no
    thresholds.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data.
    """

    def __init__(self, model: Any, data: Any) -> None:
        self._mujoco, self._model, self._data = load_mujoco(), model, data
        self._coefficients: Array = np.empty(0)
        self._thresholds: Array = np.empty(0)
        if model.nuser_geom >= RESTITUTION_DATA:
            values: Array = np.array(model.geom_user)
            self._coefficients, self._thresholds = values[:, 0], values[:, 1]
        self._bounces = np.count_nonzero(self._coefficients) > 1
        self._recovery = Recovery(model, data)

    def expect_overlaps(self) -> None:
        """Bound the separation speed of bodies that overlap from now on, for as long as they overlap."""
        self._recovery.expect()

    def make_steps(self, count: int) -> None:
        """Simulate a number of time steps."""
        while count and (self._bounces or self._recovery.is_expected):
            if self._recovery.is_expected:
                self._recovery.step()
            else:
                self._mujoco.mj_step(self._model, self._data)
            if self._bounces and self._data.ncon:
                self._apply_restitution()
            count -= 1
        if count:
            self._mujoco.mj_step(self._model, self._data, count)

    def _apply_restitution(self) -> None:
        """Set the velocities with which bodies that have just collided bounce off each other."""
        contacts, speeds = self._data.contact, self._data.efc_vel
        geoms, rows = contacts.geom, contacts.efc_address
        share = self._coefficients[geoms].prod(axis=1)
        thresholds = self._thresholds[geoms].min(axis=1)
        least = np.where(thresholds < USUAL_SURFACE.bounce_threshold, np.maximum(thresholds, _LEAST), _LEAST)
        hits = [
            (index, -share[index] * speeds[rows[index]])
            for index in np.flatnonzero((share > 0) & (rows >= 0) & (geoms >= 0).all(axis=1))
            if speeds[rows[index]] < -least[index]
        ]
        if not hits:
            return
        model, data = self._model, self._data
        ways = np.concatenate([self._contact_jacobian(contacts[index]) for index, _ in hits])
        answers = np.zeros_like(ways)
        self._mujoco.mj_solveM(model, data, answers, ways)
        now = ways @ data.qvel
        impulses = _solve_impulses(
            ways @ answers.T,
            now,
            [(speed, float(contacts[index].friction[0]) if contacts[index].dim > 1 else 0.0) for index, speed in hits],
        )
        gained = impulses @ answers
        data.qvel += gained
        struck = [index for index, _ in hits]
        depths = -contacts.dist[struck] - now[::3] * model.opt.timestep
        since = float(np.clip(depths / -speeds[rows[struck]], 0.0, 2.0 * model.opt.timestep).min())
        self._mujoco.mj_integratePos(model, data.qpos, gained, since)  # as if they had separated on contact

    def _contact_jacobian(self, contact: Any) -> Array:
        """Return the Jacobian of a contact along its normal and tangents, shape (3, degrees of freedom)."""
        model = self._model
        first, second = (np.zeros((3, model.nv)) for _ in range(2))
        for geom, way in zip(contact.geom, (first, second), strict=True):
            self._mujoco.mj_jac(model, self._data, way, None, contact.pos, int(model.geom_bodyid[geom]))
        apart: Array = np.array(contact.frame).reshape(3, 3) @ (second - first)
        return apart


def _solve_impulses(response: Array, speeds: Array, wanted: list[tuple[float, float]]) -> Array:
    """Return the impulses along the normals and both tangents of contacts, shape (3 contacts,).

    Args:
        response: the speed in each direction for a unit impulse in each direction, shape (3 contacts, 3 contacts).
        speeds: the current speeds, shape (3 contacts,).
        wanted: for each contact the speed of separation, and the coefficient of friction.
    """
    impulses, speeds = np.zeros(len(speeds)), speeds.copy()
    for _ in range(_ROUNDS):
        for number, (parting, friction) in enumerate(wanted):
            normal = 3 * number
            more = (parting - speeds[normal]) / response[normal, normal]
            before = impulses[normal : normal + 3].copy()
            impulses[normal] = max(before[0] + more, 0.0)
            speeds += response[:, normal] * (impulses[normal] - before[0])
            if friction <= 0:
                continue
            sides = slice(normal + 1, normal + 3)
            slip = before[1:] - speeds[sides] / response.diagonal()[sides]
            slip *= min(1.0, friction * impulses[normal] / max(float(np.hypot(*slip)), 1e-300))
            speeds += response[:, sides] @ (slip - before[1:])
            impulses[sides] = slip
    return impulses
