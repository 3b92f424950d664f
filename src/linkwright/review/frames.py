"""Compute the frames of the links of two robots in a common frame."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.shapes import IDENTITY, Placement
from linkwright.picture.link_frames import compute_link_frames
from linkwright.urdf import Robot

Array = NDArray[np.float64]

UNMOVED = Placement(IDENTITY, (0.0, 0.0, 0.0))
_TOLERANCE = 1e-6
"""The maximum difference, in m and between entries of rotation matrices, of a link that has not moved."""
_MIN_ANGLE_DEG = 1e-4
"""The minimum angle of a link that has rotated. Smaller ones are errors of rounding in the cosine."""


class SharedFrames:
    """The frames of the links of two robots in a common frame.

    All joints are at the initial positions of joint_state_publisher. The new robot may have a different root link, such
    as a `base_footprint` below the old root. Therefore, the new robot is placed so that a link of both robots has the
    same pose: the old root link, or else the first link below it that the new robot has.

    Args:
        old: the robot of the old version.
        new: the robot of the new version.
        links: the new names of the links that both robots have, by old name.

    Attributes:
        old: the frames of the old robot in the frame of its root link, by link.
        new: the frames of the new robot in the same frame, by link.
        reference: the new name of the link with the same pose; empty if the robots have no link in common.
        are_aligned: whether the reference link is not the root link of both robots.
        new_root: the frame of the new root link.
    """

    def __init__(self, old: Robot, new: Robot, links: Mapping[str, str]) -> None:
        self._links = links
        self.old: Mapping[str, Placement] = compute_link_frames(old, {})
        own_frames = compute_link_frames(new, {})
        shared = (name for name in self.old if links.get(name) in own_frames)
        reference = next(shared, None)
        self.reference = "" if reference is None else links[reference]
        self.new_root = UNMOVED
        self.are_aligned = reference is not None and (reference, self.reference) != (old.root, new.root)
        if reference is not None and self.are_aligned:
            self.new_root = UNMOVED.seen_from(own_frames[self.reference]).inside(self.old[reference])
        self.new = {name: frame.inside(self.new_root) for name, frame in own_frames.items()}

    def motion(self, old_name: str) -> tuple[float, float] | None:
        """Return the distance in m and the angle in degrees by which a link has moved.

        The result is None if its pose is unchanged or cannot be compared.
        """
        new_name = self._links.get(old_name, "")
        if old_name not in self.old or new_name not in self.new:
            return None
        motion = _compute_motion(self.old[old_name], self.new[new_name])
        return motion if any(motion) else None

    def motion_seen_from(self, old_observer: str, old_name: str) -> tuple[float, float] | None:
        """Return the distance in m and the angle in degrees by which a link has moved in the frame of another link.

        If only the old robot has the other link, it is the frame of the reference link. The result is None if the poses
        cannot be compared.
        """
        new_name, observer = self._links.get(old_name, ""), self._links.get(old_observer, "")
        if old_name not in self.old or new_name not in self.new:
            return None
        if old_observer not in self.old or observer not in self.new:
            return _compute_motion(self.old[old_name], self.new[new_name]) if self.reference else None
        before = self.old[old_name].seen_from(self.old[old_observer])
        return _compute_motion(before, self.new[new_name].seen_from(self.new[observer]))


def _compute_motion(old: Placement, new: Placement) -> tuple[float, float]:
    """Return the distance in m and the angle in degrees between two frames; 0 for errors of rounding."""
    before, after = to_matrix(old), to_matrix(new)
    if np.allclose(before, after, rtol=0.0, atol=_TOLERANCE):
        return 0.0, 0.0
    cosine = (np.trace(before[:3, :3].T @ after[:3, :3]) - 1.0) / 2.0
    angle = math.degrees(math.acos(min(1.0, max(-1.0, float(cosine)))))
    distance = float(np.linalg.norm(before[:3, 3] - after[:3, 3]))
    return distance if distance > _TOLERANCE else 0.0, angle if angle > _MIN_ANGLE_DEG else 0.0


def to_matrix(placement: Placement) -> Array:
    """Return a placement as a homogeneous matrix, shape (4, 4)."""
    result = np.eye(4)
    result[:3, :3] = placement.rotation
    result[:3, 3] = placement.position
    return result
