"""A robot's structure as Graphviz text, byte for byte as ``urdf_to_graphviz`` writes it."""

from __future__ import annotations

from linkwright.geometry.single import pose_quaternion, rpy_from_quaternion
from linkwright.urdf.model import Robot
from linkwright.urdf.tree import parent_joints, walk


def to_gv(robot: Robot) -> str:
    """Return Graphviz text with links as boxes and joints as ellipses.

    Labels contain xyz in meters and rpy in radians. Numbers have six significant digits, as C++ streams print them. The
    angles are converted back from the quaternion, as in urdfdom.
    """
    lines = ["digraph G {", "node [shape=box];", f'"{robot.root}" [label="{robot.root}"];']
    joints = [joint for joint, _ in walk(robot)]
    lines += [f'"{joint.child}" [label="{joint.child}"];' for joint in joints]
    lines.append("node [shape=ellipse, color=blue, fontcolor=blue];")
    parents = parent_joints(robot)
    for joint in joints:
        # If a link has two parents, urdfdom prints the joint that it kept below each of them.
        parent_joint = parents[joint.child]
        x, y, z = parent_joint.origin.xyz
        roll, pitch, yaw = rpy_from_quaternion(pose_quaternion(parent_joint.origin))
        label = f"xyz: {x:g} {y:g} {z:g} \\nrpy: {roll:g} {pitch:g} {yaw:g}"
        lines.append(f'"{joint.parent}" -> "{parent_joint.name}" [label="{label}"]')
        lines.append(f'"{parent_joint.name}" -> "{joint.child}"')
    lines += ["}", ""]
    return "\n".join(lines)
