"""Actors that walk to targets at random, around obstacles: ``libActorPlugin.so``.

The direction to the target and the directions away from near models add up. An actor turns on the spot until its
heading is within 10 degrees of the sum, and then walks along it. Close to its target, it chooses another one.

Source: Gazebo Classic (parameters, defaults, formulas, and the region in which the actor stays). The pose is computed
100 times a second. The limbs do not move.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import atan2, dist, pi, radians, remainder

from linkwright.geometry.single import (
    Transform,
    Vector3,
    add_vectors,
    length,
    quaternion_from_rpy,
    rpy_from_quaternion,
    scaled,
    subtract_vectors,
)
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.scene.figures import Figure

_RATE_HZ = 100.0
_SPEED = 0.8
"""The speed in m/s for a direction of length 1."""
_TURNING_GAIN = 1.0
"""The turning rate in rad/s for each rad of the error of the heading."""
_MAX_HEADING_ERROR = radians(10.0)
_REACHED_M = 0.3
_SEEN_M = 4.0
"""The distance in m up to which an actor avoids a model."""
_CLEARANCE_M = 2.0
"""The least distance in m of a new target from the old one and from all models."""
_MAX_DRAWS = 1000
_X_RANGE, _Y_RANGE, _HEIGHT = (-3.0, 3.5), (-10.0, 2.0), 1.2138
"""The region in which actors walk, and the height of their hips, in m."""


@dataclass(frozen=True, kw_only=True)
class ActorParameters:
    """Parameters of ``libActorPlugin.so``."""

    target: Vector3 = (0.0, -5.0, _HEIGHT)
    target_weight: float = 1.15
    obstacle_weight: float = 1.5


class ActorWalk(SimulatedPlugin[ActorParameters]):
    """The substitute for ``libActorPlugin.so``."""

    PARAMETERS = ActorParameters
    IGNORED = ("ignore_obstacles", "animation_factor")
    CARRIED = ("_target", "_pose")

    def start(self) -> None:
        """Read the models that the actor does not avoid."""
        element = self.context.element
        ignored = None if element is None else element.first("ignore_obstacles")
        models = () if ignored is None else ignored.elements("model")
        self._ignored = {self.context.path, *(model.text().strip() for model in models)}
        self._pose: Transform | None = None
        self.reset()
        self.every(_RATE_HZ, self._walk)

    def reset(self) -> None:
        """Return to the initial pose and the first target, and restart the random numbers."""
        self._generator = self.random
        self._target = self.parameters.target
        figure = self._figure
        self._pose = None if figure is None else _with_heading(figure.pose, _find_heading(figure.pose) - pi / 2.0)
        self._show()

    @property
    def _figure(self) -> Figure | None:
        """The figure of the actor, or None if the world no longer has it."""
        return next((item for item in self.simulation.scene.figures if item.model.name == self.context.path), None)

    def _show(self) -> None:
        figure = self._figure
        if figure is not None and self._pose is not None:
            figure.steered_pose = self._pose
            self.simulation.mark_moved()

    def _walk(self) -> None:
        """Turn the actor, or move it, for one period."""
        if self._pose is None:
            return
        position = self._pose[:3]
        if dist(self._target, position) < _REACHED_M:
            self._target = self._choose_target()
        direction = self._find_direction(position)
        heading = _find_heading(self._pose)
        error = remainder(atan2(direction[1], direction[0]) - heading, 2.0 * pi)
        if abs(error) > _MAX_HEADING_ERROR:
            heading += error * _TURNING_GAIN / _RATE_HZ
        else:
            heading += error
            position = add_vectors(position, scaled(direction, _SPEED / _RATE_HZ))
        x, y = (min(max(value, low), high) for value, (low, high) in zip(position, (_X_RANGE, _Y_RANGE), strict=False))
        self._pose = _with_heading((x, y, _HEIGHT, 0.0, 0.0, 0.0, 1.0), heading)
        self._show()

    def _find_direction(self, position: Vector3) -> Vector3:
        """Return the weighted sum of the direction to the target and those away from near models."""
        parameters = self.parameters
        to_target = subtract_vectors(self._target, position)
        direction = scaled(to_target, parameters.target_weight / (length(to_target) or 1.0))
        for name, other in self._find_positions():
            offset = subtract_vectors(other, position)
            distance = length(offset)
            if name not in self._ignored and 0.0 < distance < _SEEN_M:
                direction = subtract_vectors(direction, scaled(offset, parameters.obstacle_weight / distance**2))
        return direction

    def _find_positions(self) -> Iterator[tuple[str, Vector3]]:
        """Yield the names and positions of all models and of the other actors."""
        simulation = self.simulation
        for name in simulation.scene.models:
            yield name, simulation.model_pose(name)[:3]
        for figure in simulation.scene.figures:
            if figure.model.name != self.context.path:
                yield figure.model.name, figure.pose_at(simulation.seconds)[:3]

    def _choose_target(self) -> Vector3:
        """Return a target that is clear of the old one and of all models; the old one if none is found."""
        others = [position for _, position in self._find_positions()]
        for _ in range(_MAX_DRAWS):
            x, y = (float(self._generator.uniform(*limits)) for limits in (_X_RANGE, _Y_RANGE))
            target = (x, y, self._target[2])
            if all(dist(target, position) >= _CLEARANCE_M for position in (self._target, *others)):
                return target
        return self._target


def _find_heading(pose: Transform) -> float:
    """Return the yaw of a pose in rad."""
    return rpy_from_quaternion(pose[3:])[2]


def _with_heading(pose: Transform, heading: float) -> Transform:
    """Return a pose that is upright and has a heading in rad."""
    return (*pose[:3], *quaternion_from_rpy((0.0, 0.0, heading)))
