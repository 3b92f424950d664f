"""The link tree as text, byte for byte as ``check_urdf`` prints it."""

from __future__ import annotations

from linkwright.urdf.model import Robot
from linkwright.urdf.tree import children_of, walk

MAX_INDENTED_LEVELS = 200
"""The maximum number of levels that are indented."""


def tree_text(robot: Robot) -> str:
    """Return the robot's name and its links as an indented list.

    Children are ordered by joint name, with four spaces per level. From level `MAX_INDENTED_LEVELS` on, the indentation
    no longer grows. Otherwise, the text of a chain of a hundred thousand links would exhaust the memory.
    """
    lines = [
        f"robot name is: {robot.name}",
        "---------- Successfully Parsed XML ---------------",
        f"root Link: {robot.root} has {len(children_of(robot)[robot.root])} child(ren)",
    ]
    counts: list[int] = []
    for joint, depth in walk(robot):
        del counts[depth:]
        if len(counts) < depth:
            counts.append(0)
        counts[depth - 1] += 1
        lines.append(f"{'    ' * min(depth, MAX_INDENTED_LEVELS)}child({counts[depth - 1]}):  {joint.child}")
    return "\n".join(lines) + "\n"
