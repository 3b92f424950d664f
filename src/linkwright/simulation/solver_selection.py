"""Select how MuJoCo solves forces: by islands of bodies in contact, or all together.

Separate groups, called "islands", may fall asleep, so bodies at rest cost nothing. With the discrete integrator,
however, MuJoCo processes all motors for each island, which doubles the time of a step with a hundred robots. The forces
are the same.
"""

from __future__ import annotations

from typing import Any

from linkwright.simulation.library import load_mujoco
from linkwright.simulation.schedule import Schedule, Task
from linkwright.simulation.sleep import Sleep

_MIN_MOTORS, _MIN_TREES = 16, 8
"""The minimum numbers of motors and trees for which solving all bodies together may be faster."""
_ISLAND_COST, _AWAKE_COST = 80, 300
"""The costs of an island without its motors, and of a tree that is awake, in units of a motor's cost.

Measured with 4 to 100 mbots: an island costs 2.5 us, and 0.03 us for each motor; mbot itself, as a box, 9 us.
"""
_CHECK_STEPS = 20
"""The number of steps between two checks. Resting bodies may fall asleep within half as many."""
_CHECKS_WITHOUT_ISLANDS = 50
"""The number of checks during which all bodies are solved together, before islands are tried again."""


class SolverSelector:
    """A selector of the solver of a simulation.

    The selection depends only on the state of the simulation, so the same calls give exactly the same results.

    Args:
        schedule: the schedule of the simulation.
        sleep: decides when bodies may sleep.
    """

    def __init__(self, schedule: Schedule, sleep: Sleep) -> None:
        self._schedule = schedule
        self._sleep = sleep
        self._task: Task | None = None
        self._remaining_checks = 0
        self._model: Any = None
        self._data: Any = None

    def set_model(self, model: Any, data: Any, now: int, step: int) -> None:
        """Use another model and its data, initially solved by islands.

        Args:
            model: MuJoCo's model, whose options are set here.
            data: MuJoCo's data of the model.
            now: the simulated time in nanoseconds.
            step: the time step in nanoseconds.
        """
        self._model, self._data, self._remaining_checks = model, data, 0
        if self._task is not None:
            self._task.is_cancelled, self._task = True, None
        if model.nu >= _MIN_MOTORS and model.ntree >= _MIN_TREES:
            self._task = self._schedule.add(_CHECK_STEPS * step, self._update_solver, now)

    def restart(self) -> None:
        """Return to solving by islands, because the simulation restarts."""
        if self._remaining_checks:
            self._select(without_islands=False)

    def _update_solver(self) -> None:
        if self._remaining_checks:
            self._remaining_checks -= 1
            if not self._remaining_checks:
                self._select(without_islands=False)
            return
        model, data = self._model, self._data
        sleeping_tree_count = model.ntree - data.ntree_awake
        if (model.nu + _ISLAND_COST) * data.nisland > _AWAKE_COST * sleeping_tree_count:
            self._select(without_islands=True)

    def _select(self, *, without_islands: bool) -> None:
        mujoco, option = load_mujoco(), self._model.opt
        sleep, islands = mujoco.mjtEnableBit.mjENBL_SLEEP.value, mujoco.mjtDisableBit.mjDSBL_ISLAND.value
        if without_islands:
            self._remaining_checks = _CHECKS_WITHOUT_ISLANDS
            option.enableflags &= ~sleep
            option.disableflags |= islands
        else:
            self._remaining_checks = 0
            self._sleep.wake_briefly()
            option.enableflags |= sleep
            option.disableflags &= ~islands
