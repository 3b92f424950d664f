"""Describe a model that leaves a world because a launch file spawns it now."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.files.worlds.sdf_numbers import parse_numbers
from linkwright.review.texts.motions import add_pose_motion
from linkwright.xmltree import Element

POSE_LENGTH = 6
"""The number of values of a pose: the position, then roll, pitch and yaw."""


@dataclass(frozen=True)
class SpawnedModel:
    """A model that a launch file spawns.

    Attributes:
        path: the path of the launch file.
        condition: the condition of the node that spawns it; empty for none.
        pose: the position and the rotation, as numbers; None if they are unknown.
    """

    path: str
    condition: str
    pose: tuple[float, ...] | None

    def describe_move(self, title: str, element: Element) -> Phrase:
        """Return the sentence that a model of a world is spawned now, perhaps at another place.

        Args:
            title: the path of the model in the world.
            element: the model or include that the world had.
        """
        text = phrase("{element} moved to {path}", element=title, path=self.path)
        if self.condition:
            text = phrase("{change} ({condition})", change=text, condition=self.condition)
        pose = element.first("pose")
        old = parse_numbers(pose.text() if pose is not None else " ".join("0" * POSE_LENGTH))
        if self.pose is None or len(old) != len(self.pose) or tuple(old) == self.pose:
            return text
        values = [" ".join(f"{number:g}" for number in numbers) for numbers in (old, self.pose)]
        move = phrase("{change}; pose: {old} -> {new}", change=text, old=values[0], new=values[1])
        return add_pose_motion(move, old, self.pose)
