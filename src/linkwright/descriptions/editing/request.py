"""Requests to edit a robot, each with a part and its new values."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import Literal
from linkwright.urdf import Robot
from linkwright.xmltree import Element

Part = Literal["joint", "axis", "visual", "collision", "inertial"]

WITHOUT_AXIS = ("fixed", "floating")
"""The types of joints whose axis urdfdom does not read."""


@dataclass(frozen=True, slots=True)
class EditRequest:
    """A requested edit of the pose of a part, or of the axis of a joint.

    Attributes:
        part: the edited part: the origin of a joint, visual, collision or inertial, or the axis of a joint.
        name: the name of the joint, or of the link that contains any other part.
        index: the index of the visual or collision in the link, starting at 0.
        xyz: the requested position in meters, in the frame of the parent link or of the link. For the part ``axis``,
            the requested axis in the joint frame. None leaves the current value.
        rpy: the requested roll, pitch and yaw in rad. None leaves the current values.
        together: whether other parts that depend on the same text may also change.
    """

    part: Part
    name: str
    index: int = 0
    xyz: Sequence[float] | None = None
    rpy: Sequence[float] | None = None
    together: bool = False

    @property
    def tag(self) -> str:
        """The tag of the edited element."""
        return "axis" if self.part == "axis" else "origin"

    def owner(self, robot: Robot) -> Element | None:
        """Return the element of the joint, visual, collision or inertial, or None if there is none."""
        if self.part in ("joint", "axis"):
            joint = robot.joints.get(self.name)
            if joint is None or (self.part == "axis" and joint.type in WITHOUT_AXIS):
                return None
            return joint.element
        link = robot.links.get(self.name)
        if link is None:
            return None
        if self.part == "inertial":
            return link.inertial.element if link.inertial is not None else None
        shapes = link.visuals if self.part == "visual" else link.collisions
        return shapes[self.index].element if 0 <= self.index < len(shapes) else None
