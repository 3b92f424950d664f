"""The positions of the joints of joint_state_publisher."""

from __future__ import annotations

from array import array

import numpy as np
from numpy.typing import NDArray

from linkwright.messages import JointState
from linkwright.nodes.joint_layout import JointLayout, JointRange, empty_layout
from linkwright.nodes.joint_settings import JointSettings

Array = NDArray[np.float64]


class _Quantity:
    """A number for each free joint; NaN means none."""

    def __init__(self, values: Array) -> None:
        self._with_zero = np.append(values, 0.0)
        self.values = self._with_zero[:-1]

    def spread(self, layout: JointLayout, *, scaled: bool, shifted: bool) -> Array | None:
        """Return the numbers for a message, one for each published joint; None if there are none at all.

        A joint that follows one without a number has 0, as in the ROS node.
        """
        if np.isnan(self.values).all():
            return None
        spread: Array = self._with_zero[layout.masters]  # masters are -1 for what does not move
        if scaled:
            spread *= layout.factor
        if shifted:
            spread += layout.offset
        spread[np.isnan(spread)] = 0.0
        return spread


class JointPositions:
    """Positions (rad or m), velocities and efforts of the free joints; all others follow from them.

    Args:
        settings: which quantities joints have from the start.
    """

    def __init__(self, settings: JointSettings) -> None:
        self.layout = empty_layout()
        self._rows: dict[str, int] = {}
        self._direction: NDArray[np.float64] = np.ones(0)
        self._position, self._velocity, self._effort = (_Quantity(np.zeros(0)) for _ in range(3))
        self.take_over(self.layout, settings)

    def take_over(self, layout: JointLayout, settings: JointSettings) -> None:
        """Take over another layout.

        Joints that were free before and still are keep their state, moved into the new limits, if it ever was other
        than where they start; the others begin at zero.
        """
        before, rows_before = self._free_states(), self._rows
        zeros_before = {joint.name: joint.zero for joint in self.layout.free}
        self.layout = layout
        self._rows = {joint.name: row for row, joint in enumerate(layout.free)}
        start = [joint.zero if settings.publish_default_positions else np.nan for joint in layout.free]
        count = len(layout.free)
        self._position = _Quantity(np.array(start, dtype=np.float64))
        self._velocity = _Quantity(np.full(count, 0.0 if settings.publish_default_velocities else np.nan))
        self._effort = _Quantity(np.full(count, 0.0 if settings.publish_default_efforts else np.nan))
        self._direction = np.ones(count)
        self._lower = np.array([joint.lower for joint in layout.free])
        self._upper = np.array([joint.upper for joint in layout.free])
        self._ahead = self._upper
        self._wraps = np.array([joint.kind == "continuous" for joint in layout.free], dtype=np.bool_)
        for joint in layout.free:
            row = rows_before.get(joint.name)
            if row is not None:
                self._store(joint, before[:, row], zeros_before[joint.name])

    def hear(self, message: JointState) -> None:
        """Take over the values of a message for free joints; positions outside of limits too."""
        for number, name in enumerate(message.name):
            row = self._rows.get(name)
            if row is None:
                continue
            for quantity, given in (
                (self._position, message.position),
                (self._velocity, message.velocity),
                (self._effort, message.effort),
            ):
                if number < len(given):
                    quantity.values[row] = given[number]

    def sweep(self, delta: float) -> None:
        """Move every free joint by delta (rad or m), reversing at limits; continuous ones wrap around."""
        position, direction = self._position.values, self._direction
        position += direction * delta
        beyond = (position - self._ahead) * direction > 0.0
        if beyond.any():
            position[beyond] = np.where(self._wraps, self._lower, self._ahead)[beyond]
            self._direction = np.where(beyond & ~self._wraps, -direction, direction)
            self._ahead = np.where(self._direction > 0.0, self._upper, self._lower)

    def set(self, name: str, position: float) -> None:
        """Set the position of a free joint, within its limits; raise KeyError if there is no such joint."""
        row = self._rows[name]
        self._position.values[row] = min(max(position, self._lower[row]), self._upper[row])

    def published(self) -> Array:
        """Positions of all published joints in the order of messages; 0 for those without one."""
        positions = self._position.spread(self.layout, scaled=True, shifted=True)
        return np.zeros(len(self.layout.ranges)) if positions is None else positions

    def fill(self, message: JointState) -> None:
        """Write names and quantities into a message; those that no joint has stay empty."""
        message.name = list(self.layout.ranges)
        velocities = self._velocity.spread(self.layout, scaled=True, shifted=False)
        efforts = self._effort.spread(self.layout, scaled=False, shifted=False)
        positions = self._position.spread(self.layout, scaled=True, shifted=True)
        if positions is None and self.layout.dependent:
            positions = np.zeros(len(self.layout.ranges))
        if positions is not None:
            message.position = array("d", positions.tobytes())
        if velocities is not None:
            message.velocity = array("d", velocities.tobytes())
        if efforts is not None:
            message.effort = array("d", efforts.tobytes())

    def _free_states(self) -> Array:
        return np.array([self._position.values, self._velocity.values, self._effort.values])

    def _store(self, joint: JointRange, state: Array, zero_before: float) -> None:
        row = self._rows[joint.name]
        position, velocity, effort = state.tolist()
        starts_without = np.isnan(self._position.values[row])
        if not np.isnan(position) and (position != zero_before or starts_without):
            self._position.values[row] = joint.clamp(position)
        if not np.isnan(velocity):
            self._velocity.values[row] = velocity
        if not np.isnan(effort):
            self._effort.values[row] = effort
