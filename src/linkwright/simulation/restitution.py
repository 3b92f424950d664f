"""Time steps of MuJoCo with restitution: colliding bodies bounce within a step.

MuJoCo's contacts are soft and absorb the speed of a hard impact: at usual time steps, no setting lets a ball rise as
high as its coefficient of restitution requires. Therefore bodies that collide receive impulses after the step of the
collision, according to Newton's law of impact with Coulomb friction.

Bodies penetrate each other until the end of the step. They are therefore also moved to the poses that they would have
if they had separated at the moment of contact. Without this correction, a ball with a coefficient of 0.2 rises a fifth
too low after a fall from 1 m.

These figures were measured in simulated drops of balls, boxes, cylinders and capsules from 0.3, 1 and 3 m, with
coefficients of 0.2, 0.5 and 0.9.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.sdf.surfaces import DEFAULT_SURFACE
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.recovery import Recovery
from linkwright.simulation.scene.surfaces import RESTITUTION_DATA

_MIN_IMPACT_SPEED = 0.1
"""The minimum impact speed in m/s at which bodies bounce, as in gz's engine DART."""
_ITERATIONS = 50
"""The number of iterations over all impulses. A box that lands flat has four contacts."""


class Stepper:
    """A simulator of a model's time steps, with restitution.

    The restitution of a contact is the product of the coefficients of both shapes, as in gz, so both need one. As in
    Gazebo Classic, a pair bounces only above the lower of its two velocity thresholds, if one is set; gz has no
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
        self._has_restitution = np.count_nonzero(self._coefficients) > 1
        self._recovery = Recovery(model, data)

    def expect_overlaps(self) -> None:
        """Limit the separation speed of bodies that overlap, until bodies no longer overlap."""
        self._recovery.expect()

    def make_steps(self, count: int) -> None:
        """Simulate a number of time steps."""
        while count and (self._has_restitution or self._recovery.is_expected):
            if self._recovery.is_expected:
                self._recovery.step()
            else:
                self._mujoco.mj_step(self._model, self._data)
            if self._has_restitution and self._data.ncon:
                self._apply_restitution()
            count -= 1
        if count:
            self._mujoco.mj_step(self._model, self._data, count)

    def _apply_restitution(self) -> None:
        """Let the bodies that collided in the last step bounce off each other.

        Their velocities and poses are changed.
        """
        contacts, speeds = self._data.contact, self._data.efc_vel
        geoms, rows = contacts.geom, contacts.efc_address
        coefficients = self._coefficients[geoms].prod(axis=1)
        thresholds = self._thresholds[geoms].min(axis=1)
        min_speeds = np.where(
            thresholds < DEFAULT_SURFACE.bounce_threshold, np.maximum(thresholds, _MIN_IMPACT_SPEED), _MIN_IMPACT_SPEED
        )
        impacts = [
            (index, -coefficients[index] * speeds[rows[index]])
            for index in np.flatnonzero((coefficients > 0) & (rows >= 0) & (geoms >= 0).all(axis=1))
            if speeds[rows[index]] < -min_speeds[index]
        ]
        if not impacts:
            return
        model, data = self._model, self._data
        jacobian = np.concatenate([self._contact_jacobian(contacts[index]) for index, _ in impacts])
        responses = np.zeros_like(jacobian)
        self._mujoco.mj_solveM(model, data, responses, jacobian)
        normal_speeds = jacobian @ data.qvel
        impulses = _solve_impulses(
            jacobian @ responses.T,
            normal_speeds,
            [
                (speed, float(contacts[index].friction[0]) if contacts[index].dim > 1 else 0.0)
                for index, speed in impacts
            ],
        )
        velocity_change = impulses @ responses
        data.qvel += velocity_change
        impact_contacts = [index for index, _ in impacts]
        depths = -contacts.dist[impact_contacts] - normal_speeds[::3] * model.opt.timestep
        time_since_contact = float(
            np.clip(depths / -speeds[rows[impact_contacts]], 0.0, 2.0 * model.opt.timestep).min()
        )
        self._mujoco.mj_integratePos(
            model, data.qpos, velocity_change, time_since_contact
        )  # as if they had separated on contact

    def _contact_jacobian(self, contact: Any) -> Array:
        """Return the Jacobian of a contact along its normal and its two tangents.

        The shape is (3, degrees of freedom).
        """
        model = self._model
        first_jacobian, second_jacobian = (np.zeros((3, model.nv)) for _ in range(2))
        for geom, jacobian in zip(contact.geom, (first_jacobian, second_jacobian), strict=True):
            self._mujoco.mj_jac(model, self._data, jacobian, None, contact.pos, int(model.geom_bodyid[geom]))
        relative_jacobian: Array = np.array(contact.frame).reshape(3, 3) @ (second_jacobian - first_jacobian)
        return relative_jacobian


def _solve_impulses(response: Array, speeds: Array, targets: list[tuple[float, float]]) -> Array:
    """Return the impulses along the normal and the two tangents of each contact.

    The shape is (3 contacts,).

    Args:
        response: the speed in each direction for a unit impulse in each direction, shape (3 contacts, 3 contacts).
        speeds: the current speeds, shape (3 contacts,).
        targets: for each contact, the required speed of separation in m/s and the coefficient of friction.
    """
    impulses, speeds = np.zeros(len(speeds)), speeds.copy()
    for _ in range(_ITERATIONS):
        for contact, (separation_speed, friction) in enumerate(targets):
            normal = 3 * contact
            correction = (separation_speed - speeds[normal]) / response[normal, normal]
            previous = impulses[normal : normal + 3].copy()
            impulses[normal] = max(previous[0] + correction, 0.0)
            speeds += response[:, normal] * (impulses[normal] - previous[0])
            if friction <= 0:
                continue
            tangents = slice(normal + 1, normal + 3)
            tangential = previous[1:] - speeds[tangents] / response.diagonal()[tangents]
            tangential *= min(1.0, friction * impulses[normal] / max(float(np.hypot(*tangential)), 1e-300))
            speeds += response[:, tangents] @ (tangential - previous[1:])
            impulses[tangents] = tangential
    return impulses
