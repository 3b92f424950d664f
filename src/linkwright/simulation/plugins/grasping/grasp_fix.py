"""Objects that a gripper holds without slip: ``libgazebo_grasp_fix.so``.

If two forces of the gripper's links on an object oppose each other for some time, the object is fixed to the palm. It
is released when the forces are gone and a link has moved away from it.

Source: gazebo_grasp_plugin (parameters, defaults, the conditions for attaching and releasing).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import combinations
from math import cos, radians

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import compose, invert
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.sensors.contact import ContactSensor
from linkwright.simulation.sensors.mount import Mount
from linkwright.xmltree import Element

_MIN_FORCE = 1e-4
"""The least force in N that counts."""
_MIN_DISTANCE = 1e-6
"""The least distance in m from the origin of an object to a contact point."""
_MIN_FORCE_RATIO = 0.3
"""The least ratio of two opposing forces."""


@dataclass(frozen=True, kw_only=True)
class GraspFixParameters:
    """Parameters of ``libgazebo_grasp_fix.so``."""

    update_rate: float = 5.0
    forces_angle_tolerance: float = 120.0
    max_grip_count: int = 10
    grip_count_threshold: float | None = None
    release_tolerance: float = 0.005
    disable_collisions_on_attach: bool = False


@dataclass(frozen=True, slots=True)
class _Touch:
    """The contacts between a link of the gripper and an object.

    Attributes:
        link: the link of the gripper.
        force: the force on the object in N, in the axes of the world.
        point: the mean contact point in m, in the frame of the link.
        offset_from_object: the vector from the object's origin to the contact point in m, in the object's frame.
    """

    link: str
    force: Array
    point: Array
    offset_from_object: Array


@dataclass(slots=True)
class _Gripper:
    """A gripper.

    Attributes:
        palm: the link to which objects are fixed.
        sensors: the contact sensors of the links that grasp, by the names of the links.
        counts: the number of updates in which each object was gripped, by the name of its link.
        held_object: the link that is fixed to the palm; empty for none.
        touches: the touches with which `held_object` was gripped.
    """

    palm: str
    sensors: dict[str, ContactSensor]
    counts: dict[str, int] = field(default_factory=dict)
    held_object: str = ""
    touches: list[_Touch] = field(default_factory=list)


class GraspFix(SimulatedPlugin[GraspFixParameters]):
    """The substitute for ``libgazebo_grasp_fix.so``."""

    PARAMETERS = GraspFixParameters
    IGNORED = ("arm", "contact_topic")  # arms are read by start

    def start(self) -> None:
        """Find the grippers.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, there is no arm, or it names no links.
        """
        element = self.context.element
        arms = [] if element is None else list(element.elements("arm"))
        if not arms:
            raise self._incomplete_arm_error()
        self._grippers = [self._read_gripper(arm) for arm in arms]
        parameters = self.parameters
        self._max_cosine = cos(radians(parameters.forces_angle_tolerance))
        self._threshold = (
            parameters.max_grip_count // 2
            if parameters.grip_count_threshold is None
            else parameters.grip_count_threshold
        )
        self.every(parameters.update_rate, self._update)

    def reset(self) -> None:
        """Release the objects."""
        for gripper in self._grippers:
            self._release(gripper)

    def stop(self) -> None:
        """Release the objects."""
        self.reset()

    def _incomplete_arm_error(self) -> Exception:
        return self.parameter_error(
            phrase(
                "plugin '{plugin}': it needs an <arm> with a <palm_link> and with <gripper_link> elements",
                plugin=self.context.name,
            )
        )

    def _read_gripper(self, arm: Element) -> _Gripper:
        palm, links = self.text_in(arm, "palm_link"), [child.text().strip() for child in arm.elements("gripper_link")]
        if not palm or not links:
            raise self._incomplete_arm_error()
        names = [self.link(link) for link in links]
        return _Gripper(self.link(palm), {name: ContactSensor(Mount(self.simulation, name)) for name in names})

    def _update(self) -> None:
        for gripper in self._grippers:
            touches_by_object = self._measure_touches(gripper)
            gripped_objects = {
                name for name, touches in touches_by_object.items() if self._has_opposing_forces(touches)
            }
            for name in gripped_objects:
                gripper.counts[name] = min(gripper.counts.get(name, 0) + 1, self.parameters.max_grip_count)
                if gripper.counts[name] > self._threshold and not gripper.held_object:
                    self._hold(gripper, name, touches_by_object[name])
            for name in gripper.counts.keys() - gripped_objects:
                gripper.counts[name] = max(gripper.counts[name] - 1, 0)
            held_object = gripper.held_object
            if held_object and held_object not in self.simulation.scene.bodies:
                gripper.held_object = ""
            elif held_object and gripper.counts[held_object] <= self._threshold and self._has_opened(gripper):
                self._release(gripper)

    def _measure_touches(self, gripper: _Gripper) -> dict[str, list[_Touch]]:
        """Return the touches of a gripper, by the links of the objects that can move."""
        simulation = self.simulation
        own_model = self.context.path.partition(SEPARATOR)[0]
        touches: dict[str, list[_Touch]] = {}
        for link, sensor in gripper.sensors.items():
            pose = simulation.link_pose(link)
            for contact in sensor.measure():
                touched_link = contact.collision2.rpartition(SEPARATOR)[0]
                is_fixed = touched_link not in simulation.scene.bodies or (
                    simulation.model.body_weldid[simulation.body(touched_link)] == 0
                )
                if is_fixed or touched_link.partition(SEPARATOR)[0] == own_model:
                    continue
                position = contact.positions.mean(axis=0)
                point = rotation_matrix(pose[3:]).T @ (position - pose[:3])
                force = -contact.forces.sum(axis=0)
                touch = _Touch(link, force, point, self._to_link_frame(touched_link, position))
                touches.setdefault(touched_link, []).append(touch)
        return touches

    def _has_opposing_forces(self, touches: list[_Touch]) -> bool:
        for first, second in combinations(touches, 2):
            magnitudes = sorted(float(np.linalg.norm(touch.force)) for touch in (first, second))
            if magnitudes[0] < _MIN_FORCE or magnitudes[0] < _MIN_FORCE_RATIO * magnitudes[1]:
                continue
            if float(first.force @ second.force) < self._max_cosine * magnitudes[0] * magnitudes[1]:
                return True
        return False

    def _hold(self, gripper: _Gripper, held_object: str, touches: list[_Touch]) -> None:
        simulation = self.simulation
        pose = compose(invert(simulation.link_pose(gripper.palm)), simulation.link_pose(held_object))
        is_colliding = not self.parameters.disable_collisions_on_attach
        simulation.scene.weld(gripper.palm, held_object, pose, is_colliding=is_colliding)
        simulation.mark_changed()
        simulation.refresh()
        gripper.held_object, gripper.touches = held_object, touches

    def _release(self, gripper: _Gripper) -> None:
        held_object, gripper.held_object = gripper.held_object, ""
        gripper.counts.clear()
        scene = self.simulation.scene
        if held_object in scene.bodies and scene.is_welded(gripper.palm, held_object):
            scene.unweld(gripper.palm, held_object)
            self.simulation.mark_changed()
            self.simulation.refresh()

    def _has_opened(self, gripper: _Gripper) -> bool:
        """Return whether a link of the gripper has moved away from the object that it holds."""
        return any(distance > self.parameters.release_tolerance for distance in self._measure_retreats(gripper))

    def _measure_retreats(self, gripper: _Gripper) -> Iterator[float]:
        """Yield how far each touching link has moved outward from the object since the grasp, in m."""
        for touch in gripper.touches:
            pose = self.simulation.link_pose(touch.link)
            point = pose[:3] + rotation_matrix(pose[3:]) @ touch.point
            distance = float(np.linalg.norm(touch.offset_from_object))
            movement = self._to_link_frame(gripper.held_object, point) - touch.offset_from_object
            yield float(movement @ touch.offset_from_object) / max(distance, _MIN_DISTANCE)

    def _to_link_frame(self, link: str, point: Array) -> Array:
        """Return a point of the world in the frame of a link, in m."""
        pose = self.simulation.link_pose(link)
        coordinates: Array = rotation_matrix(pose[3:]).T @ (point - pose[:3])
        return coordinates
