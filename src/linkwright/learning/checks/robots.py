"""Checks of the learner's robot: links, joints, poses and shapes, in any notation."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase, nearest, phrase, quoted_names
from linkwright.geometry.arrays import matrix_from_pose, row_from_pose
from linkwright.geometry.shapes import Box, Cylinder, Sphere
from linkwright.kinematics.tree import KinematicTree
from linkwright.learning.checks.findings import add_hint
from linkwright.learning.checks.inertias import compute_moments_of_inertia, make_inertia_matrix
from linkwright.learning.checks.not_yet import NotYet
from linkwright.urdf.model import Collision, Joint, Link, Mesh, Robot, Visual

Vector = Sequence[float]
Part = Literal["visual", "collision"]

_LENGTH_TOLERANCE_M = 0.001
"""The difference between lengths and positions that checks accept, in m."""

_ANGLE_TOLERANCE_RAD = 0.02
"""The difference between directions that checks accept, in rad: 1.57 instead of pi/2 passes."""

_COLOR_TOLERANCE = 0.15
"""The maximum difference of red, green or blue, from 0 to 1, for equal colors."""

_DEFAULT_AXIS = (1.0, 0.0, 0.0)
_MAX_LISTED_NAMES = 8


@dataclass(frozen=True)
class ShapeSpec:
    """A shape that a check expects.

    Attributes:
        shape: the shape with its size in m.
        along: the direction of a cylinder's axis in the root frame, with all joints at zero; None for any direction.
        at: the position of its center relative to the link's origin, expressed in the root frame, in m; None for any
            position.
    """

    shape: Box | Cylinder | Sphere
    along: Vector | None = None
    at: Vector | None = None


class _CheckedPart:
    """The base class of checked parts, which adds the circumstance of a check to messages."""

    def __init__(self, circumstance: Phrase | None) -> None:
        self._circumstance = circumstance

    def _make_not_yet(self, message: Phrase) -> NotYet:
        """Return the exception for an unsatisfied check, with the circumstance of the check."""
        if self._circumstance is None:
            return NotYet(message)
        return NotYet(phrase("{circumstance}: {message}", circumstance=self._circumstance, message=message))


class RobotCheck(_CheckedPart):
    """A robot of the learner.

    Attributes:
        robot: the robot as read from its description.
        path: the file that it was read from.
    """

    def __init__(
        self,
        robot: Robot,
        path: Path,
        *,
        circumstance: Phrase | None = None,
        explain_missing: Callable[[str, str], Phrase | None] | None = None,
        explain_unread: Callable[[], Phrase | None] | None = None,
    ) -> None:
        """Create the checks of a robot.

        Args:
            robot: the robot as read from its description.
            path: the file that it was read from.
            circumstance: what is special about this robot, such as a property with another value.
            explain_missing: returns the reason why a link or joint of the files is missing, from its kind and name.
            explain_unread: returns the finding about an element of the files that is ignored.
        """
        super().__init__(circumstance)
        self.robot = robot
        self.path = path
        self._explain_missing = explain_missing
        self._explain_unread = explain_unread

    def link(self, name: str) -> LinkCheck:
        """Return a link.

        Raises:
            NotYet: there is no link with this name.
        """
        link = self.robot.links.get(name)
        if link is None:
            raise self._make_not_yet(self._explain_absence("link", name, self.robot.links))
        return LinkCheck(link, self._compute_rotation(name), self._circumstance, self._explain_unread)

    def joint(self, name: str) -> JointCheck:
        """Return a joint.

        Raises:
            NotYet: there is no joint with this name.
        """
        joint = self.robot.joints.get(name)
        if joint is None:
            raise self._make_not_yet(self._explain_absence("joint", name, self.robot.joints))
        return JointCheck(joint, self._compute_rotation(joint.child), self._circumstance)

    def _compute_rotation(self, link: str) -> NDArray[np.float64]:
        """Return the rotation of a link's frame in the root frame, with all joints at zero."""
        tree, frames = self._frames
        return np.asarray(frames[tree.link_index(link)][:3, :3])

    def _explain_absence(self, kind: Literal["link", "joint"], name: str, names: Iterable[str]) -> Phrase:
        """Return the message for a missing link or joint, with the reason or the existing names."""
        message = phrase("no link is called '{name}'", name=name)
        if kind == "joint":
            message = phrase("no joint is called '{name}'", name=name)
        names = list(names)
        if similar := nearest(name, names, 1):
            return phrase("{message}; there is '{similar}'", message=message, similar=similar[0])
        if self._explain_missing is not None and (reason := self._explain_missing(kind, name)):
            return phrase("{message}; {reason}", message=message, reason=reason)
        if not names:
            return message
        return phrase(
            "{message}; the robot has {names}", message=message, names=quoted_names(names[:_MAX_LISTED_NAMES])
        )

    def pose(self, link: str, frame: str | None = None) -> NDArray[np.float64]:
        """Return the pose of a link's frame with all joints at zero.

        Args:
            link: the name of the link.
            frame: the link whose frame is the reference; None for the root link.

        Returns:
            The homogeneous matrix of shape (4, 4), in m.

        Raises:
            NotYet: there is no link with this name.
        """
        self.link(link)
        tree, frames = self._frames
        pose: NDArray[np.float64] = frames[tree.link_index(link)]
        if frame is None:
            return pose
        self.link(frame)
        return np.asarray(np.linalg.inv(frames[tree.link_index(frame)]) @ pose)

    def expect_position(
        self, link: str, position: Vector, *, frame: str | None = None, tolerance: float = _LENGTH_TOLERANCE_M
    ) -> None:
        """Require a link's frame to be at a position with all joints at zero.

        Args:
            link: the name of the link.
            position: x, y and z in m.
            frame: the link whose frame is the reference; None for the root link.
            tolerance: the greatest accepted distance, in m.

        Raises:
            NotYet: the link is missing, or at another position.
        """
        actual = self.pose(link, frame)[:3, 3]
        if np.linalg.norm(actual - np.asarray(position)) > tolerance:
            raise self._make_not_yet(
                phrase(
                    "the frame of '{link}' is at {actual} in the frame of '{frame}', but should be at {expected}",
                    link=link,
                    actual=_format_vector(actual),
                    frame=frame or self.robot.root,
                    expected=_format_vector(position),
                )
            )

    def expect_direction(self, link: str, axis: Vector, direction: Vector, *, frame: str | None = None) -> None:
        """Require an axis of a link's frame to point in a direction, with all joints at zero.

        Args:
            link: the name of the link.
            axis: the axis in the link's frame, such as ``(1, 0, 0)``.
            direction: the direction in the frame of reference.
            frame: the link whose frame is the reference; None for the root link.

        Raises:
            NotYet: the link is missing, or its axis points in another direction.
        """
        actual = self.pose(link, frame)[:3, :3] @ np.asarray(axis, float)
        if _compute_angle(actual, direction, either_sign=False) > _ANGLE_TOLERANCE_RAD:
            raise self._make_not_yet(
                phrase(
                    "the frame of '{link}' has the wrong orientation: its axis {axis} points along {actual} in the "
                    "frame of '{frame}', but should point along {expected}; check the rpy of its joint",
                    link=link,
                    axis=_format_vector(axis),
                    actual=_format_vector(actual),
                    frame=frame or self.robot.root,
                    expected=_format_vector(direction),
                )
            )

    @cached_property
    def _frames(self) -> tuple[KinematicTree, NDArray[np.float64]]:
        tree = KinematicTree(self.robot)
        return tree, np.asarray(tree.forward({}))


class JointCheck(_CheckedPart):
    """A joint of the learner's robot.

    Attributes:
        joint: the joint as read from the description.
    """

    def __init__(
        self, joint: Joint, rotation: NDArray[np.float64] | None = None, circumstance: Phrase | None = None
    ) -> None:
        super().__init__(circumstance)
        self.joint = joint
        self._rotation = np.eye(3) if rotation is None else rotation

    def expect_type(self, *types: str) -> None:
        """Require the joint to have one of the given types.

        Raises:
            NotYet: it has another type.
        """
        if self.joint.type not in types:
            raise self._make_not_yet(
                phrase(
                    "the joint '{joint}' has the type '{actual}', but should be {expected}",
                    joint=self.joint.name,
                    actual=str(self.joint.type),
                    expected=quoted_names(types, " or "),
                )
            )

    def expect_links(self, parent: str, child: str) -> None:
        """Require the joint to connect two links.

        Raises:
            NotYet: it connects other links.
        """
        if (self.joint.parent, self.joint.child) == (parent, child):
            return
        if (self.joint.parent, self.joint.child) == (child, parent):
            raise self._make_not_yet(
                phrase(
                    "the parent and the child of the joint '{joint}' are exchanged: the parent must be '{parent}'",
                    joint=self.joint.name,
                    parent=parent,
                )
            )
        raise self._make_not_yet(
            phrase(
                "the joint '{joint}' connects '{actual_parent}' and '{actual_child}', but should connect '{parent}' "
                "and '{child}'",
                joint=self.joint.name,
                actual_parent=self.joint.parent,
                actual_child=self.joint.child,
                parent=parent,
                child=child,
            )
        )

    def expect_axis(self, axis: Vector, *, either_sign: bool = False) -> None:
        """Require the joint to turn about, or move along, an axis.

        Args:
            axis: the direction in the frame of the root link, with all joints at zero.
            either_sign: whether the opposite direction is also accepted.

        Raises:
            NotYet: the axis is another one.
        """
        actual = self._rotation @ np.asarray(self.joint.axis, float)
        if _compute_angle(actual, axis, either_sign=either_sign) <= _ANGLE_TOLERANCE_RAD:
            return
        if not np.any(actual):
            raise self._make_not_yet(
                phrase(
                    "the axis of the joint '{joint}' has no direction; write <axis xyz=\"{expected}\"/>",
                    joint=self.joint.name,
                    expected=_format_vector(axis),
                )
            )
        if _compute_angle(actual, self.joint.axis, either_sign=True) > _ANGLE_TOLERANCE_RAD:
            raise self._make_not_yet(
                phrase(
                    "the axis of the joint '{joint}' points along {actual}, because the rpy of a joint's <origin> "
                    "turns it, but should point along {expected}",
                    joint=self.joint.name,
                    actual=_format_vector(actual),
                    expected=_format_vector(axis),
                )
            )
        if _compute_angle(actual, axis, either_sign=True) <= _ANGLE_TOLERANCE_RAD:
            raise self._make_not_yet(
                phrase("the axis of the joint '{joint}' has the wrong sign", joint=self.joint.name)
            )
        if tuple(self.joint.axis) == _DEFAULT_AXIS:
            raise self._make_not_yet(
                phrase(
                    "the axis of the joint '{joint}' is 1 0 0, the default without <axis>, but should be {expected}",
                    joint=self.joint.name,
                    expected=_format_vector(axis),
                )
            )
        raise self._make_not_yet(
            phrase(
                "the axis of the joint '{joint}' is {actual}, but should be {expected}",
                joint=self.joint.name,
                actual=_format_vector(self.joint.axis),
                expected=_format_vector(axis),
            )
        )


class LinkCheck(_CheckedPart):
    """A link of the learner's robot.

    Attributes:
        link: the link as read from the description.
    """

    def __init__(
        self,
        link: Link,
        rotation: NDArray[np.float64] | None = None,
        circumstance: Phrase | None = None,
        explain_unread: Callable[[], Phrase | None] | None = None,
    ) -> None:
        super().__init__(circumstance)
        self.link = link
        self._explain_unread = explain_unread
        self._rotation = np.eye(3) if rotation is None else rotation

    def expect_shape(self, expected: ShapeSpec, part: Part = "visual") -> None:
        """Require a visual or a collision of the link to have a shape and size.

        Other shapes of the link are ignored.

        Args:
            expected: the shape.
            part: whether it is a visual or a collision.

        Raises:
            NotYet: no visual or collision is this shape.
        """
        parts: Sequence[Visual | Collision] = self.link.visuals if part == "visual" else self.link.collisions
        self.expect_part(part)
        all_objections = (_describe_shape_difference(candidate, expected, self._rotation) for candidate in parts)
        objections = [objection for objection in all_objections if objection is not None]
        if len(objections) == len(parts):
            raise self._make_not_yet(
                phrase("the {part} of '{link}': {reason}", part=part, link=self.link.name, reason=objections[0])
            )

    def expect_part(self, part: Part) -> None:
        """Require the link to have a visual or a collision.

        Raises:
            NotYet: the link has none; the message names an element of the file that is ignored.
        """
        if self.link.visuals if part == "visual" else self.link.collisions:
            return
        message = phrase("the link '{link}' has no <{part}>", link=self.link.name, part=part)
        raise self._make_not_yet(add_hint(message, self._explain_unread and self._explain_unread()))

    def expect_inertia(self, shape: Box | Cylinder | Sphere, *, along: Vector | None = None, factor: float) -> None:
        """Require the link to have the moments of inertia of a solid shape with the link's mass.

        Args:
            shape: the solid shape with its size in m.
            along: the direction of a cylinder's axis in the root frame, with all joints at zero.
            factor: the greatest accepted ratio between a moment and the correct moment.

        Raises:
            NotYet: the link has no inertia, or another one.
        """
        inertial = self.link.inertial
        if inertial is None:
            raise self._make_not_yet(phrase("the link '{link}' has no <{part}>", link=self.link.name, part="inertial"))
        rotation = self._rotation @ matrix_from_pose(row_from_pose(inertial.origin))[:3, :3]
        actual = np.diag(rotation @ make_inertia_matrix(inertial) @ rotation.T)
        expected = compute_moments_of_inertia(shape, inertial.mass, along)
        for name, moment, right in zip(("ixx", "iyy", "izz"), actual, expected, strict=True):
            if not right / factor <= moment <= right * factor:
                raise self._make_not_yet(
                    phrase(
                        "the moment {name} of '{link}' is {actual:.3g} kg m², but should be about {expected:.3g} "
                        "for a mass of {mass:g} kg; check the sizes and the rpy that the inertia macro receives",
                        name=name,
                        link=self.link.name,
                        actual=moment,
                        expected=right,
                        mass=inertial.mass,
                    )
                )

    def expect_color(self, rgb: Vector) -> None:
        """Require a visual of the link to have a color.

        Args:
            rgb: red, green and blue from 0 to 1.

        Raises:
            NotYet: no visual has the color.
        """
        colors = [visual.material.rgba for visual in self.link.visuals if visual.material and visual.material.rgba]
        if not colors:
            raise self._make_not_yet(phrase("the visual of '{link}' has no color", link=self.link.name))
        if all(np.abs(np.subtract(color[:3], rgb)).max() > _COLOR_TOLERANCE for color in colors):
            raise self._make_not_yet(
                phrase(
                    "the visual of '{link}' has the color {actual}, but should have {expected}",
                    link=self.link.name,
                    actual=_format_vector(colors[0][:3]),
                    expected=_format_vector(rgb),
                )
            )

    def expect_mass(self, lowest: float, highest: float) -> None:
        """Require the link's mass to be in a range.

        Args:
            lowest: the smallest accepted mass, in kg.
            highest: the greatest accepted mass, in kg.

        Raises:
            NotYet: the link has no mass, or another one.
        """
        if self.link.inertial is None:
            raise self._make_not_yet(phrase("the link '{link}' has no <{part}>", link=self.link.name, part="inertial"))
        mass = self.link.inertial.mass
        if not lowest <= mass <= highest:
            raise self._make_not_yet(
                phrase(
                    "the mass of '{link}' is {mass:g} kg, but should be between {lowest:g} and {highest:g} kg",
                    link=self.link.name,
                    mass=mass,
                    lowest=lowest,
                    highest=highest,
                )
            )


def _describe_shape_difference(
    part: Visual | Collision, expected: ShapeSpec, rotation: NDArray[np.float64]
) -> Phrase | None:
    """Return the difference between a part and the expected shape, or None if they are equal.

    The rotation is that of the link's frame in the root frame.
    """
    shape = part.geometry
    if isinstance(shape, Mesh) or type(shape) is not type(expected.shape):
        return phrase(
            "it is a {actual}, but should be a {expected}",
            actual=_get_shape_kind(shape),
            expected=_get_shape_kind(expected.shape),
        )
    for name, actual, expected_size in _compare_sizes(shape, expected.shape):
        if abs(actual - expected_size) > _LENGTH_TOLERANCE_M:
            return phrase(
                "its {size} is {actual:g} m, but should be {expected:g} m",
                size=name,
                actual=actual,
                expected=expected_size,
            )
    matrix = matrix_from_pose(row_from_pose(part.origin))
    direction, center = rotation @ matrix[:3, 2], rotation @ matrix[:3, 3]
    largest_angle = max(map(abs, part.origin.rpy))
    if expected.along is not None and largest_angle > 2 * np.pi:
        return phrase(
            "its rpy contains {angle:g}: angles are in radians, and a quarter turn is 1.5708", angle=largest_angle
        )
    if (
        expected.along is not None
        and _compute_angle(direction, expected.along, either_sign=True) > _ANGLE_TOLERANCE_RAD
    ):
        return phrase(
            "its axis points along {actual}, but should point along {expected}",
            actual=_format_vector(direction),
            expected=_format_vector(expected.along),
        )
    if expected.at is not None and np.linalg.norm(center - np.asarray(expected.at)) > _LENGTH_TOLERANCE_M:
        return phrase(
            "its center is at {actual}, but should be at {expected}",
            actual=_format_vector(center),
            expected=_format_vector(expected.at),
        )
    return None


def _compare_sizes(shape: object, expected: object) -> list[tuple[str, float, float]]:
    """Return the name, the actual value and the expected value of each size of a shape, in m."""
    if isinstance(shape, Box) and isinstance(expected, Box):
        sizes = zip("xyz", shape.size, expected.size, strict=True)
        return [(f"size {axis}", actual, expected_size) for axis, actual, expected_size in sizes]
    names = [name for name in ("radius", "length") if hasattr(expected, name)]
    return [(name, getattr(shape, name), getattr(expected, name)) for name in names]


def _get_shape_kind(shape: object) -> str:
    return type(shape).__name__.lower()


def _compute_angle(first: Vector | NDArray[np.float64], second: Vector, *, either_sign: bool) -> float:
    """Return the angle between two directions in rad."""
    lengths = np.linalg.norm(first) * np.linalg.norm(second)
    cosine = float(np.dot(first, second) / lengths) if lengths else 0.0
    return float(np.arccos(np.clip(abs(cosine) if either_sign else cosine, -1.0, 1.0)))


def _format_vector(vector: Vector | NDArray[np.float64]) -> str:
    return " ".join(f"{round(float(value), 4) + 0.0:g}" for value in vector)
