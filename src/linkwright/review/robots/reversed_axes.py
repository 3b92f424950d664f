"""Find joints whose axis points in the opposite direction, so that they turn or slide the other way."""

from __future__ import annotations

import numpy as np

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, phrase
from linkwright.review.breaking import MOVING_TYPES
from linkwright.review.frames import SharedFrames
from linkwright.urdf import Robot

_AXIS = "axis"
_TOLERANCE = 1e-6
_ROTATED = 1e-3
"""The minimum angle in degrees of a link that counts as rotated."""


def find_reversal_reason(difference: Difference, old: Robot, new: Robot, frames: SharedFrames | None) -> Phrase | None:
    """Return why another axis of a joint is breaking: it is reversed. The result is None for other differences.

    An axis in a link that is itself rotated may be the same axis of the robot, and a mimic joint may have another
    sign.

    Args:
        difference: the difference between both versions.
        old: the robot of the old version.
        new: the robot of the new version.
        frames: the frames of the links of both robots; None if they are unknown.
    """
    if (difference.subject, difference.kind, difference.property) != ("joint", "changed", _AXIS) or frames is None:
        return None
    joint, new_joint = old.joints.get(difference.name), new.joints.get(difference.name)
    if joint is None or new_joint is None or not MOVING_TYPES.issuperset((joint.type, new_joint.type)):
        return None
    motion = frames.motion(joint.child)
    if joint.mimic is not None or new_joint.mimic is not None or (motion is not None and motion[1] > _ROTATED):
        return None
    axes = [np.array(axis) / (np.linalg.norm(axis) or 1.0) for axis in (joint.axis, new_joint.axis)]
    if not np.allclose(axes[0], -axes[1], atol=_TOLERANCE):
        return None
    return phrase("the same position of '{name}' moves it in the opposite direction", name=difference.name)
