"""Sleep of bodies at rest: MuJoCo skips sleeping bodies, and their velocity is zero.

MuJoCo lets bodies sleep as soon as they are slow for ten steps. However, a pendulum is slow at its turning point, and
so is any body that starts to move under a small force. Here a body may only sleep if its pose has not changed for a
while. A body with contacts may move slightly in that time, because contacts never stop completely. A body that
hangs, swings or floats may not move at all.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.schedule import Schedule, Task

_CHECK_PERIOD_NS = 50_000_000
"""The time between two checks, in nanoseconds."""
_MIN_CALM_CHECKS = 5
"""The number of successive checks that must find a body at rest."""
_MAX_CONTACT_SPEED, _MAX_FREE_SPEED = 3e-4, 1e-6
"""The maximum speeds of a body at rest, in m/s or rad/s: with contacts, and without contacts."""
_WAKING_SPEED = 1e-30
"""A negligible speed that makes MuJoCo wake a tree before the next step."""


class Sleep:
    """Lets trees of bodies fall asleep when they are at rest.

    Args:
        schedule: the schedule of the simulation.
    """

    def __init__(self, schedule: Schedule) -> None:
        self._mujoco = load_mujoco()
        self._schedule = schedule
        self._task: Task | None = None
        self._model: Any = None
        self._data: Any = None

    def set_model(self, model: Any, data: Any, now: int, step: int, *, is_allowed: bool = True) -> None:
        """Use another model and its data, and wake all bodies.

        Args:
            model: MuJoCo's model, whose sleep policies are set here.
            data: MuJoCo's data of the model.
            now: the simulated time in nanoseconds.
            step: the time step in nanoseconds.
            is_allowed: whether bodies may sleep. An actor, which moves without dynamics, does not wake them.
        """
        self._model, self._data = model, data
        policies = self._mujoco.mjtSleepPolicy
        self._may_sleep: Any = (model.tree_sleep_policy == policies.mjSLEEP_AUTO_ALLOWED) & is_allowed
        self._seconds = step * max(1, round(_CHECK_PERIOD_NS / step)) * 1e-9
        self._calm_checks = np.zeros(model.ntree, dtype=np.int64)
        self._last_positions: Array = data.qpos.copy()
        if self._task is not None:
            self._task.is_cancelled, self._task = True, None
        if self._may_sleep.any():
            self._task = self._schedule.add(round(self._seconds * 1e9), self._update_sleep, now)
            lengths: Array = np.array(model.dof_length)
            self._lengths = np.where(lengths > 0.0, lengths, 1.0)
            self._tree_indices: Any = model.dof_treeid
        self.wake()

    def wake_briefly(self) -> None:
        """Wake all bodies.

        A body at rest can fall asleep again after MuJoCo's ten steps.
        """
        data = self._data
        if self._model.nv:
            is_resting = (data.tree_asleep >= 0)[self._model.dof_treeid] & (data.qvel == 0.0)
            data.qvel[is_resting] = _WAKING_SPEED

    def wake(self) -> None:
        """Wake all bodies, and keep them awake until they have been at rest for a while."""
        self.wake_briefly()
        self._calm_checks[:] = 0
        self._set_policies()

    def wake_tree(self, tree: int) -> None:
        """Wake a tree that was moved or set in motion.

        A tree of -1, for a static body without a tree, has no effect.
        """
        if tree >= 0:
            self._calm_checks[tree] = 0
            self._set_policies()
            self.wake_briefly()

    def keep_awake(self, tree: int) -> None:
        """Wake a tree, and prevent it from falling asleep again."""
        self._may_sleep[tree] = False
        self.wake()

    def _set_policies(self) -> None:
        policies = self._mujoco.mjtSleepPolicy
        may_sleep = self._may_sleep & (self._calm_checks >= _MIN_CALM_CHECKS)
        self._model.tree_sleep_policy[:] = np.where(may_sleep, policies.mjSLEEP_AUTO_ALLOWED, policies.mjSLEEP_NEVER)

    def _update_sleep(self) -> None:
        model, data = self._model, self._data
        if not data.ntree_awake:
            return
        velocity, positions = np.empty(model.nv), data.qpos
        self._mujoco.mj_differentiatePos(model, velocity, self._seconds, self._last_positions, positions)
        self._last_positions[:] = positions
        contact_speed = np.zeros(model.ntree)
        np.maximum.at(contact_speed, self._tree_indices, np.abs(velocity) * self._lengths)
        free_speed = np.zeros(model.ntree)
        np.maximum.at(free_speed, self._tree_indices, np.maximum(np.abs(velocity), np.abs(data.qvel)))
        is_at_rest = np.where(
            self._find_touching_trees(), contact_speed < _MAX_CONTACT_SPEED, free_speed < _MAX_FREE_SPEED
        )
        self._calm_checks = np.where(is_at_rest, self._calm_checks + 1, 0)
        self._set_policies()

    def _find_touching_trees(self) -> Any:
        """Return whether each tree has a contact, shape (trees,)."""
        model, contacts = self._model, self._data.contact
        geoms = contacts.geom[contacts.efc_address >= 0]
        geoms = geoms[geoms >= 0]
        touching = np.zeros(model.ntree + 1, dtype=bool)  # The last item is for static bodies, whose tree is -1.
        touching[model.body_treeid[model.geom_bodyid[geoms]]] = True
        return touching[:-1]
