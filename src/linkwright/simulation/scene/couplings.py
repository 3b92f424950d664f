"""Couplings of joints: screw threads and gears."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import tau
from typing import Any

from linkwright.geometry.single import Vector3, rotate
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.structure import PlacedJoint

THREAD_SUFFIX = "#thread"
"""The suffix of the name of the joint for the translation of a screw."""
_TIME_CONSTANT_STEPS = 4.0
"""The time constant of joint couplings, in steps."""


def add_screw_coupling(spec: Any, joint: PlacedJoint) -> Iterator[Any]:
    """Yield the equality constraint of a screw joint's translation and rotation.

    The thread pitch is in m per revolution. Nothing is yielded for other types of joints.
    """
    if joint.joint.type == "screw" and joint.axes:
        pitch = joint.joint.thread_pitch or 0.0
        yield _add_coupling(spec, joint.name + THREAD_SUFFIX, joint.name, pitch / tau)


def add_gearbox_coupling(spec: Any, gear: PlacedJoint, joints: Iterable[PlacedJoint]) -> Iterator[Any]:
    """Yield the equality constraint of a gearbox, unless one of its links has no joint.

    The child turns ``-gearbox_ratio`` times as far as the parent (SDFormat).

    Args:
        spec: the specification.
        gear: the gearbox.
        joints: the movable joints, including the joints of the gearbox's parent and child links.
    """
    joint_of_link = {joint.child: joint for joint in joints if joint.axes}
    parent, child = joint_of_link.get(gear.parent), joint_of_link.get(gear.child)
    if parent is None or child is None or not gear.axes:
        return
    parent_axis, child_axis = gear.axes[0], gear.axes[-1]
    axis_sign = _compute_axis_sign(_rotate_to_world(gear, parent_axis[1]), parent) * _compute_axis_sign(
        _rotate_to_world(gear, child_axis[1]), child
    )
    yield _add_coupling(spec, child.name, parent.name, -gear.joint.gearbox_ratio * axis_sign)


def _add_coupling(spec: Any, follower: str, leader: str, factor: float) -> Any:
    equality = spec.add_equality(type=load_mujoco().mjtEq.mjEQ_JOINT)
    equality.name1, equality.name2 = follower, leader
    equality.data[:5] = [0.0, factor, 0.0, 0.0, 0.0]
    equality.solref = [_TIME_CONSTANT_STEPS * spec.option.timestep, 1.0]
    return equality


def _rotate_to_world(joint: PlacedJoint, direction: Vector3) -> Vector3:
    return rotate(joint.pose[3:], direction)


def _compute_axis_sign(direction: Vector3, joint: PlacedJoint) -> float:
    """Return 1 if a joint's axis points along a direction in the world, or else -1."""
    axis = _rotate_to_world(joint, joint.axes[0][1])
    return -1.0 if sum(a * b for a, b in zip(axis, direction, strict=True)) < 0.0 else 1.0
