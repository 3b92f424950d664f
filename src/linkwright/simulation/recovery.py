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
        self._step_s = float(model.opt.timestep)
        self._remaining_steps = 0
        servo_equalities = [index for index in range(model.neq) if SERVO_SUFFIX in model.equality(index).name]
        self._is_limited = np.ones(model.neq, dtype=bool)
        self._is_limited[servo_equalities] = False
        types = self._mujoco.mjtConstraint
        self._limit_type, self._equality_type = int(types.mjCNSTR_LIMIT_JOINT), int(types.mjCNSTR_EQUALITY)
        self._springs_key: tuple[int, bytes] | None = None
        self._springs = _Springs(np.empty((0, 2)), np.empty(0), 1.0)
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
        data, contacts = self._data, self._data.contact
        addresses = contacts.efc_address
        is_active = addresses >= 0
        rows, solref = addresses[is_active], contacts.solref[is_active]
        contact_count = len(rows)
        if data.ne or data.nl:
            other_rows, other_solref = self._find_limits_and_equalities()
            rows, solref = np.concatenate([rows, other_rows]), np.concatenate([solref, other_solref])
        margins = data.efc_margin[rows]
        depths = data.efc_pos[rows] - margins
        springs = self._get_springs(solref, contact_count)
        max_depths = springs.compute_max_depths(-np.copysign(1.0, depths) * data.efc_vel[rows])
        is_too_deep = np.abs(depths) > max_depths
        if not is_too_deep.any():
            return False
        data.efc_pos[rows[is_too_deep]] = (margins + np.copysign(max_depths, depths))[is_too_deep]
        return True

    def _find_limits_and_equalities(self) -> tuple[Array, Array]:
        """Return the rows of joints at their limits and of limited equalities, and the solref of each row."""
        model, data = self._model, self._data
        types, ids = data.efc_type, data.efc_id
        limits = np.flatnonzero(types == self._limit_type)
        equalities = np.flatnonzero(types == self._equality_type)
        equalities = equalities[self._is_limited[ids[equalities]]]
        solref = np.concatenate([model.jnt_solref[ids[limits]], model.eq_solref[ids[equalities]]])
        return np.concatenate([limits, equalities]), solref

    def _get_springs(self, solref: Array, contact_count: int) -> _Springs:
        """Return the springs of contacts and of the other rows, which seldom differ from those of the last step."""
        key = (contact_count, solref.tobytes())
        if key != self._springs_key:
            max_speeds = np.full(len(solref), _MAX_CORRECTION_SPEED)
            max_speeds[:contact_count] = _MAX_SEPARATION_SPEED
            self._springs_key, self._springs = key, _Springs(solref, max_speeds, self._step_s)
        return self._springs


class _Springs:
    """Damped springs of MuJoCo.

    Args:
        solref: rows of a time constant in s and a damping ratio, or of negated stiffness and damping; shape
            (springs, 2).
        max_speeds: the maximum speeds in m/s or rad/s, shape (springs,).
        step_s: the time step in s.
    """

    def __init__(self, solref: Array, max_speeds: Array, step_s: float) -> None:
        self._max_speeds, self._step_s = max_speeds, step_s
        first, second = solref.T
        time_constants = np.maximum(first, 2.0 * step_s)
        with np.errstate(divide="ignore", invalid="ignore"):
            self._stiffness = np.where(first > 0.0, 1.0 / (time_constants * second) ** 2, -first)
            self._damping = np.where(first > 0.0, 2.0 / time_constants, -second)

    def compute_max_depths(self, speeds: Array) -> Array:
        """Return the depths in m or rad at which the springs reach their maximum speeds after a step.

        Args:
            speeds: the speeds at which the depths currently decrease, in m/s or rad/s, shape (springs,).
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            max_depths: Array = ((self._max_speeds - speeds) / self._step_s + self._damping * speeds) / self._stiffness
        return np.maximum(max_depths, 0.0)
