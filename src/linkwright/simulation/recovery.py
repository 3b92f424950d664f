"""Slow separation of bodies that overlap at the start.

MuJoCo's contacts are damped springs: a body that starts 0.3 m inside the ground leaves it at 20 m/s. The same holds for
joints that start beyond their limits, and for couplings and loops that do not fit yet. Such a spring may accelerate
bodies only up to a maximum speed within a step: a depth that results in a higher speed is replaced by the depth that
results in exactly this speed. Smaller depths remain unchanged, so bodies at rest bear their load.

gz's engine DART also bounds the speed, and ODE does so with ``contact_max_correcting_vel``.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.scene import SERVO

_PARTING = 0.3
"""The greatest speed in m/s at which overlapping bodies part: one that leaves so rises by 5 mm."""
_MOVING = 1.0
"""The greatest speed in rad/s or m/s at which joints return to their limits, and couplings and loops close."""
_CALM = 100
"""The number of steps without any excess of depth after which it is no longer looked for."""


class Recovery:
    """Bounds the speed at which bodies separate if they overlap at the start or after being placed.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data.
    """

    def __init__(self, model: Any, data: Any) -> None:
        self._mujoco, self._model, self._data = load_mujoco(), model, data
        self._left = 0
        servos = [number for number in range(model.neq) if SERVO in model.equality(number).name]
        self._free = np.ones(model.neq, dtype=bool)
        self._free[servos] = False
        self.expect()

    @property
    def is_expected(self) -> bool:
        """Whether overlaps are still possible, so that the caller has to use `step`."""
        return self._left > 0

    def expect(self) -> None:
        """Check each step for overlaps, until a number of steps in a row has had none."""
        self._left = _CALM

    def step(self) -> None:
        """Simulate one step with bounded separation speeds."""
        mujoco, model, data = self._mujoco, self._model, self._data
        mujoco.mj_step1(model, data)
        self._left -= 1
        if data.nefc and self._bound():
            self._left = _CALM
        mujoco.mj_step2(model, data)

    def _bound(self) -> bool:
        """Reduce penetration depths that are too large; return whether any depth was reduced."""
        model, data, kinds = self._model, self._data, self._mujoco.mjtConstraint
        types, numbers, contacts = data.efc_type, data.efc_id, data.contact
        touching = contacts.efc_address >= 0
        limits = np.flatnonzero(types == kinds.mjCNSTR_LIMIT_JOINT)
        equal = np.flatnonzero(types == kinds.mjCNSTR_EQUALITY)
        equal = equal[self._free[numbers[equal]]]
        rows = np.concatenate([contacts.efc_address[touching], limits, equal])
        springs = (contacts.solref[touching], model.jnt_solref[numbers[limits]], model.eq_solref[numbers[equal]])
        greatest = np.full(len(rows), _MOVING)
        greatest[: np.count_nonzero(touching)] = _PARTING
        margins = data.efc_margin[rows]
        depths = data.efc_pos[rows] - margins
        most = self._maximum_depths(np.concatenate(springs), -np.copysign(1.0, depths) * data.efc_vel[rows], greatest)
        deep = np.abs(depths) > most
        data.efc_pos[rows[deep]] = (margins + np.copysign(most, depths))[deep]
        return bool(deep.any())

    def _maximum_depths(self, solref: Array, speeds: Array, greatest: Array) -> Array:
        """Return the depths in m or rad at which springs reach their maximum speeds after a step.

        Args:
            solref: time constants in s and damping ratios; where negative, stiffness and damping. Shape (springs, 2).
            speeds: the speeds at which the depths currently decrease, in m/s or rad/s.
            greatest: the maximum speeds.
        """
        step = self._model.opt.timestep
        first, second = solref.T
        time = np.maximum(first, 2.0 * step)
        with np.errstate(divide="ignore", invalid="ignore"):
            stiffness = np.where(first > 0.0, 1.0 / (time * second) ** 2, -first)
            damping = np.where(first > 0.0, 2.0 / time, -second)
            most: Array = ((greatest - speeds) / step + damping * speeds) / stiffness
        return np.maximum(most, 0.0)
