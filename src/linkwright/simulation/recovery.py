"""Slow separation of bodies that overlap at the start.

MuJoCo's contacts are damped springs: a body that starts 0.3 m inside the ground leaves it at 20 m/s. The same holds for
joints that start beyond their limits, and for couplings and loops that do not fit yet. This module limits
the speed to which such a spring accelerates bodies within a step: a depth that would result in a higher speed is
replaced by the depth that results in exactly this speed. Smaller depths do not change, so bodies at rest still carry
their load.

gz's engine DART also bounds the speed, and ODE does so with ``contact_max_correcting_vel``.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.scene import SERVO_SUFFIX

_MAX_SEPARATION_SPEED = 0.3
"""The maximum speed in m/s at which overlapping bodies separate. At this speed, a body rises by 5 mm."""
_MAX_CORRECTION_SPEED = 1.0
"""The maximum speed in rad/s or m/s at which joints return to their limits, and couplings and loops close."""
_MAX_STEPS_WITHOUT_OVERLAP = 100
"""The number of successive steps without an excessive depth after which depths are no longer checked."""


class Recovery:
    """A limiter of the speed at which overlapping bodies separate.

    Bodies may overlap at the start or after they were moved.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data.
    """

    def __init__(self, model: Any, data: Any) -> None:
        self._mujoco, self._model, self._data = load_mujoco(), model, data
        self._remaining_steps = 0
        servo_equalities = [index for index in range(model.neq) if SERVO_SUFFIX in model.equality(index).name]
        self._is_limited = np.ones(model.neq, dtype=bool)
        self._is_limited[servo_equalities] = False
        self.expect()

    @property
    def is_expected(self) -> bool:
        """Whether overlaps are still possible, so that the caller must simulate with `step`."""
        return self._remaining_steps > 0

    def expect(self) -> None:
        """Check each step for overlaps until 100 successive steps have had none."""
        self._remaining_steps = _MAX_STEPS_WITHOUT_OVERLAP

    def step(self) -> None:
        """Simulate one step with limited separation speeds."""
        mujoco, model, data = self._mujoco, self._model, self._data
        mujoco.mj_step1(model, data)
        self._remaining_steps -= 1
        if data.nefc and self._limit_depths():
            self._remaining_steps = _MAX_STEPS_WITHOUT_OVERLAP
        mujoco.mj_step2(model, data)

    def _limit_depths(self) -> bool:
        """Reduce excessive penetration depths, and return whether any depth was reduced."""
        model, data, constraint_types = self._model, self._data, self._mujoco.mjtConstraint
        types, ids, contacts = data.efc_type, data.efc_id, data.contact
        is_active = contacts.efc_address >= 0
        limits = np.flatnonzero(types == constraint_types.mjCNSTR_LIMIT_JOINT)
        equalities = np.flatnonzero(types == constraint_types.mjCNSTR_EQUALITY)
        equalities = equalities[self._is_limited[ids[equalities]]]
        rows = np.concatenate([contacts.efc_address[is_active], limits, equalities])
        solrefs = (contacts.solref[is_active], model.jnt_solref[ids[limits]], model.eq_solref[ids[equalities]])
        max_speeds = np.full(len(rows), _MAX_CORRECTION_SPEED)
        max_speeds[: np.count_nonzero(is_active)] = _MAX_SEPARATION_SPEED
        margins = data.efc_margin[rows]
        depths = data.efc_pos[rows] - margins
        max_depths = self._compute_max_depths(
            np.concatenate(solrefs), -np.copysign(1.0, depths) * data.efc_vel[rows], max_speeds
        )
        is_too_deep = np.abs(depths) > max_depths
        data.efc_pos[rows[is_too_deep]] = (margins + np.copysign(max_depths, depths))[is_too_deep]
        return bool(is_too_deep.any())

    def _compute_max_depths(self, solref: Array, speeds: Array, max_speeds: Array) -> Array:
        """Return the depths in m or rad at which springs reach their maximum speeds after a step.

        Args:
            solref: rows of a time constant in s and a damping ratio, or of negated stiffness and damping; shape
                (springs, 2).
            speeds: the speeds at which the depths currently decrease, in m/s or rad/s, shape (springs,).
            max_speeds: the maximum speeds in m/s or rad/s, shape (springs,).
        """
        step_s = self._model.opt.timestep
        first, second = solref.T
        time_constants = np.maximum(first, 2.0 * step_s)
        with np.errstate(divide="ignore", invalid="ignore"):
            stiffness = np.where(first > 0.0, 1.0 / (time_constants * second) ** 2, -first)
            damping = np.where(first > 0.0, 2.0 / time_constants, -second)
            max_depths: Array = ((max_speeds - speeds) / step_s + damping * speeds) / stiffness
        return np.maximum(max_depths, 0.0)
