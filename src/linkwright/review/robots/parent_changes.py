"""Write the lines about joints that attach their link to another parent.

The origin of such a joint is a pose in another frame, so the distance between its old and new values is not the
distance by which the link moved. The line about the parent contains that distance.
"""

from __future__ import annotations

from linkwright.descriptions.comparison import Comparison, Difference, sentence
from linkwright.diagnostics import Phrase
from linkwright.diagnostics.phrase import as_phrase
from linkwright.review.frames import SharedFrames
from linkwright.review.texts.motions import add_motion
from linkwright.urdf import Robot


class ParentChanges:
    """The joints of two robots that attach their link to another parent.

    Args:
        comparison: the comparison of the robots.
        new: the new robot.
        frames: the frames of the links of both robots; None if they are unknown.
    """

    def __init__(self, comparison: Comparison, new: Robot, frames: SharedFrames | None) -> None:
        self._joints = {item.name for item in comparison.differences if _is_change_of_link(item, "parent")}
        self._joints_of_other_links = {
            item.name for item in comparison.differences if _is_change_of_link(item, "child")
        }
        self._old_links = {new_name: old_name for old_name, new_name in comparison.links.items()}
        self._new = new
        self._frames = frames

    def sentence(self, difference: Difference) -> Phrase | None:
        """Return the line about the parent or the origin of such a joint; None for other differences."""
        if difference.subject != "joint" or difference.name not in self._joints:
            return None
        if difference.property.startswith("origin "):
            return sentence(difference)
        is_of_other_link = difference.name in self._joints_of_other_links
        if not _is_change_of_link(difference, "parent") or is_of_other_link or self._frames is None:
            return None
        child = self._new.joints[difference.name].child
        motion = self._frames.motion_seen_from(difference.old or "", self._old_links.get(child, ""))
        if motion is None:
            return None
        return sentence(difference).with_arguments(new=add_motion(as_phrase(difference.new or ""), *motion))


def _is_change_of_link(difference: Difference, end: str) -> bool:
    """Return whether a joint has another link at an end, ``parent`` or ``child``."""
    return (difference.subject, difference.kind, difference.property) == ("joint", "changed", end)
