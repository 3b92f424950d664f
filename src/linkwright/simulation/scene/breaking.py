"""Joints that break under a force: joints with a sensor that has the plugin ``libBreakableJointPlugin.so``.

Such a joint is not part of a kinematic tree, because MuJoCo cannot cut a tree during the simulation. Equality
constraints connect its links, and are deactivated when the joint breaks. The position of such a joint is not measured
or driven, and its links never collide with each other.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.sdf.joints import Joint
from linkwright.sdf.plugins import library_name

BREAKABLE_JOINT_LIBRARY = "BreakableJointPlugin"
_SUFFIX = "#break"
_TYPES = ("fixed", "revolute", "hinge", "continuous", "ball")


def is_breakable(joint: Joint) -> bool:
    """Return whether a joint breaks under a force, and has a type that can."""
    return has_breaking_plugin(joint) and (joint.type in _TYPES or is_rigid(joint))


def has_breaking_plugin(joint: Joint) -> bool:
    """Return whether a sensor of a joint has the plugin that breaks joints."""
    plugins = (plugin for sensor in joint.sensors for plugin in sensor.plugins)
    return any(library_name(plugin.filename) == BREAKABLE_JOINT_LIBRARY for plugin in plugins)


def is_rigid(joint: Joint) -> bool:
    """Return whether a joint cannot move, because it is fixed or the limits of its only axis are equal."""
    if joint.type == "fixed":
        return True
    return joint.axis is not None and joint.axis2 is None and joint.axis.limit.lower == joint.axis.limit.upper


def prepare_to_break(spec: Any, joint: str, constraints: Sequence[Any]) -> Iterator[Any]:
    """Name the constraints of a breakable joint, and add and yield the contact exclusion of its links."""
    for index, equality in enumerate(constraints):
        equality.name = f"{joint}{_SUFFIX}{index}"
    if constraints and constraints[0].name2:
        first, second = constraints[0].name1, constraints[0].name2
        yield spec.add_exclude(bodyname1=first, bodyname2=second)


class Breaking:
    """The constraints of a breakable joint in a simulation.

    Args:
        spec: MuJoCo's specification.
        joint: the name of the joint in the world.
    """

    def __init__(self, spec: Any, joint: str) -> None:
        self._spec, self._joint = spec, joint
        self._model: Any = None
        self._indices: list[int] = []

    @property
    def links(self) -> tuple[str, ...]:
        """The links that the joint connects, without the world; empty if the scene has no such breakable joint."""
        constraints = [*self._constraints()]
        return tuple(name for name in (constraints[0].name1, constraints[0].name2) if name) if constraints else ()

    def set_broken(self, model: Any, data: Any, *, is_broken: bool) -> None:
        """Break the joint or connect its links again, in the specification and in MuJoCo's model and data."""
        for equality in self._constraints():
            equality.active = not is_broken
        for index in self._find_indices(model):
            model.eq_active0[index] = data.eq_active[index] = not is_broken

    def compute_force(self, model: Any, data: Any) -> Array:
        """Return the force in N that the joint carried in the last step, in world axes; shape (3,)."""
        total = np.zeros(3)
        constraints_of_rows = data.efc_id[
            : data.ne
        ]  # Rows of equality constraints are first, in the order of their ids.
        for index in self._find_indices(model):
            start = int(np.searchsorted(constraints_of_rows, index))
            if start < len(constraints_of_rows) and constraints_of_rows[start] == index:
                total += data.efc_force[start : start + 3]
        return total

    def _constraints(self) -> Iterator[Any]:
        index = 0
        while (equality := self._spec.equality(f"{self._joint}{_SUFFIX}{index}")) is not None:
            yield equality
            index += 1

    def _find_indices(self, model: Any) -> list[int]:
        """Return the ids of the constraints in a compiled model."""
        if model is not self._model:
            self._model = model
            self._indices = [int(model.equality(equality.name).id) for equality in self._constraints()]
        return self._indices
