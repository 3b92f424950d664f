"""Planning in joint space with the sampling-based planners of OMPL.

Source: OMPL, and MoveIt's interface to it (names and defaults of planners, resolution of the checks).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.effort import CHECK_S, elapsed_s, is_counted, next_seed, spend
from linkwright.planning.groups import JointGroup
from linkwright.planning.library import load_ompl

DEFAULT_PLANNER = "RRTConnect"
_PLANNERS = (
    "BFMT", "BITstar", "BKPIECE1", "FMT", "InformedRRTstar", "KPIECE1", "LBKPIECE1", "PRM", "PRMstar", "RRT",
    "RRTConnect", "RRTstar",
)  # fmt: skip
_MAX_STEP = 0.05
"""The largest step between two checked configurations while planning, in rad or m over all joints."""
_MAX_STEP_SHARE = 0.5
"""The largest step as a share of the range of all joints. OMPL refuses 1, and the range of fingers can be shorter."""
_CHECKS_PER_STEP = 10
"""How many times as many configurations of the final path are checked."""
_SEARCH_SHARE = 0.3
"""The share of the remaining time for one search; planners that optimize the path use all of it."""
_MIN_SEARCH_SHARE = 0.05
"""The minimum share of the planning time for one search."""
_FIRST_SEARCH_S = 0.5
"""The maximum time in s of the first search, before the goals are revised, of planners that do not optimize."""
_MAX_SIMPLIFICATION_S = 0.15
_MAX_EXTENSION = 1000.0
"""The maximum real time of a search whose work is counted, as a share of its time limit."""


def planner_class(name: str) -> str | None:
    """Return the planner of OMPL for a planner in ``ompl_planning.yaml``, or None.

    Args:
        name: such as ``geometric::RRTConnect``, ``RRTConnectkConfigDefault`` or ``RRTConnect``.
    """
    short_name = name.rpartition("::")[2].removesuffix("kConfigDefault")
    short_name = {"BKPIECE": "BKPIECE1", "KPIECE": "KPIECE1", "LBKPIECE": "LBKPIECE1"}.get(short_name, short_name)
    return short_name if short_name in _PLANNERS else None


class SamplingProblem:
    """The search for a path of a group between configurations.

    Args:
        group: the joints to move.
        is_free: returns whether the positions of the group's joints are free of collisions, shape (joints,).
        planner: a planner of OMPL, see `planner_class`.
        parameters: the parameters of the planner, by OMPL's names.
        is_canceled: returns whether the search must stop; it is called before each check of a configuration.
    """

    def __init__(
        self,
        group: JointGroup,
        is_free: Callable[[Array], bool],
        planner: str,
        parameters: Mapping[str, Any],
        is_canceled: Callable[[], bool],
    ) -> None:
        self._group = group
        self._is_free = is_free
        self._is_canceled = is_canceled
        self._planner = planner
        self._parameters = parameters
        self._ompl = load_ompl()

    def solve(
        self,
        start: Array,
        goals: Sequence[Array],
        timeout_s: float,
        revise: Callable[[], Sequence[Array]] | None = None,
    ) -> Array | None:
        """Return a path from a configuration to one of several goals, or None if there is none or it is canceled.

        Args:
            start: positions of the joints in rad or m, shape (joints,).
            goals: the positions to reach, each of shape (joints,).
            timeout_s: the maximum time in s.
            revise: called once after a search without a path, returns the goals of the next searches.

        Returns:
            The corners of the path, shape (n, joints). The straight lines between them are free of collisions.
        """
        deadline = elapsed_s() + timeout_s
        step = _MAX_STEP
        while (remaining := deadline - elapsed_s()) > 0.0 and not self._is_canceled():
            search_s = max(_SEARCH_SHARE * remaining, _MIN_SEARCH_SHARE * timeout_s)
            if revise is not None and not self._planner.endswith("star"):
                search_s = min(search_s, _FIRST_SEARCH_S)
            path = self._search(start, goals, step, min(remaining, search_s))
            if path is None:
                if revise is not None and not self._is_canceled():
                    goals, revise = revise(), None
                continue
            if self.is_path_free(path, step / _CHECKS_PER_STEP):
                return path
            step /= 2.0
        return None

    def is_path_free(self, path: Array, max_step: float) -> bool:
        """Return whether a path is free of collisions.

        It is checked in steps of at most `max_step`, in rad or m.
        """
        return all(map(self._is_free, subdivide(path, max_step)))

    def _search(self, start: Array, goals: Sequence[Array], step: float, timeout_s: float) -> Array | None:
        base, geometric = self._ompl.base, self._ompl.geometric
        count = len(start)
        space = base.RealVectorStateSpace(count)
        bounds = base.RealVectorBounds(count)
        lower, upper = self._bounds(start)
        for index in range(count):
            bounds.setLow(index, float(lower[index]))
            bounds.setHigh(index, float(upper[index]))
        space.setBounds(bounds)
        setup = geometric.SimpleSetup(space)
        is_free, is_canceled, indexes = self._is_free, self._is_canceled, range(count)
        seed = next_seed()
        if seed is not None:
            self._ompl.util.RNG.setSeed(seed)
        condition, deadline = self._limit(timeout_s)

        def is_valid(state: Any) -> bool:
            if is_canceled():  # OMPL cannot raise an error of Python, and a condition in Python would block it.
                condition.terminate()
                return False
            spend(CHECK_S)
            if elapsed_s() >= deadline:
                condition.terminate()
            return is_free(np.array([state[index] for index in indexes]))

        setup.setStateValidityChecker(is_valid)
        information = setup.getSpaceInformation()
        information.setStateValidityCheckingResolution(min(step / space.getMaximumExtent(), _MAX_STEP_SHARE))
        setup.setStartState(_make_state(space, start))
        goal = base.GoalStates(information)
        for positions in goals:
            goal.addState(_make_state(space, positions))
        setup.setGoal(goal)
        planner = getattr(geometric, self._planner)(information)
        apply_parameters(planner, self._parameters)
        setup.setPlanner(planner)
        setup.solve(condition)
        if not setup.haveExactSolutionPath() or is_canceled():
            return None
        condition, deadline = self._limit(min(_MAX_SIMPLIFICATION_S, timeout_s))
        setup.simplifySolution(condition)
        path = setup.getSolutionPath()
        return np.array([[state[index] for index in indexes] for state in path.getStates()])

    def _limit(self, timeout_s: float) -> tuple[Any, float]:
        """Return a condition of OMPL for the end of a search, and the time at which the search ends."""
        real_s = timeout_s * _MAX_EXTENSION if is_counted() else timeout_s
        return self._ompl.base.timedPlannerTerminationCondition(real_s), elapsed_s() + timeout_s

    def _bounds(self, start: Array) -> tuple[Array, Array]:
        """Return the bounds of the search; continuous joints may make a turn in both directions."""
        group = self._group
        turning = group.is_continuous
        lower = np.where(turning, start - 2 * pi, np.minimum(group.lower, start))
        upper = np.where(turning, start + 2 * pi, np.maximum(group.upper, start))
        return lower, upper


def apply_parameters(planner: Any, parameters: Mapping[str, Any]) -> None:
    """Set the parameters of a planner that have a setter; a range of 0 is chosen by OMPL.

    Args:
        planner: a planner of OMPL.
        parameters: the values by OMPL's names, such as ``goal_bias``.
    """
    for name, value in parameters.items():
        setter = getattr(planner, "set" + "".join(word.capitalize() for word in name.split("_")), None)
        if setter is not None and not (name == "range" and not value):
            setter(value)


def _make_state(space: Any, positions: Array) -> Any:
    state = space.allocState()
    for index, position in enumerate(positions):
        state[index] = float(position)
    return state


def subdivide(path: Array, max_step: float) -> Array:
    """Return a path with additional configurations on its lines.

    Args:
        path: shape (n, joints).
        max_step: the maximum Euclidean distance between two configurations in rad or m.
    """
    pieces = [path[:1]]
    for first, second in pairwise(path):
        count = max(1, int(np.ceil(np.linalg.norm(second - first) / max_step)))
        pieces.append(first + (second - first) * (np.arange(1, count + 1) / count)[:, None])
    return np.concatenate(pieces)
