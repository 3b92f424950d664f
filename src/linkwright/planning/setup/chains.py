"""Finds the arms and grippers of a robot by the shape of its tree of joints.

An arm is a serial chain with at least three joints. A gripper consists of the fingers into which an arm branches at
its end. It can also be the last joint of an arm, if other joints mimic it or if it has the name of a gripper.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from linkwright.planning.setup.bodies import Body, bodies_below, branch_length, chain_length, count_active_joints

MIN_ARM_JOINTS = 3
_MAX_FINGER_SHARE = 0.5
"""The maximum length of a finger, as a share of the length of the arm. Longer branches are arms of a torso."""
_GRIPPER_NAME = re.compile(r"(?i)gripper|finger|jaw|claw|pinch")


@dataclass(frozen=True, slots=True)
class Chain:
    """An arm that was found.

    Attributes:
        bodies: the indexes of the bodies that the joints of the arm move, from the base to the tip.
        gripper: the indexes of the bodies that the joints of the gripper move; empty without a gripper.
    """

    bodies: tuple[int, ...]
    gripper: tuple[int, ...] = ()


def find_chains(bodies: list[Body]) -> list[Chain]:
    """Return the arms of a robot in the order of its joints.

    Args:
        bodies: the bodies of the robot.
    """
    counts = count_active_joints(bodies)
    found: list[Chain] = []
    starts: list[list[int]] = [[0]]
    while starts:
        chain = starts.pop()
        while True:
            number_of_joints = sum(bodies[number].is_active for number in chain)
            children = _relevant_children(bodies, counts, chain[-1], keeps_wheels=number_of_joints >= MIN_ARM_JOINTS)
            long_children = [child for child in children if counts[child] >= MIN_ARM_JOINTS]
            if len(children) == 1:
                chain.append(children[0])
            elif len(long_children) == 1 and _turns_arm(bodies, chain):
                chain.append(long_children[0])
            elif number_of_joints < MIN_ARM_JOINTS:
                starts += [[child] for child in reversed(children)]
                break
            elif not children:
                found.append(_split_last_joint(bodies, chain))
                break
            elif _are_fingers(bodies, chain, children):
                gripper = sorted(number for child in children for number in bodies_below(bodies, child))
                found.append(Chain(_without_root(chain), tuple(gripper)))
                break
            elif len(long_children) == 1:
                chain.append(long_children[0])
            else:
                starts += [[child] for child in reversed(children)]
                break
    return sorted(found, key=lambda arm: arm.bodies)


def _turns_arm(bodies: list[Body], chain: list[int]) -> bool:
    """Return whether joints before a branch belong to the only arm behind it, which turns a head or a camera too.

    A torso that is lifted is not a part of the arm.
    """
    types = {joint.type for number in chain if bodies[number].is_active and (joint := bodies[number].joint)}
    return bool(types) and types <= {"revolute", "continuous"}


def is_wheel(bodies: list[Body], number: int) -> bool:
    """Return whether a branch is a wheel or caster: it has one or two joints, and its ends turn without end."""
    below = bodies_below(bodies, number)
    ends = [bodies[index] for index in below if not bodies[index].children]
    is_short = not any(bodies[child].children for child in bodies[number].children)
    return is_short and all(end.joint is not None and end.joint.type == "continuous" for end in ends)


def find_wheels(bodies: list[Body]) -> list[int]:
    """Return the indexes of the bodies that belong to wheels and casters, including steering links."""
    wheels: set[int] = set()
    for number in range(1, len(bodies)):
        if number not in wheels and len(bodies[bodies[number].parent].children) > 1 and is_wheel(bodies, number):
            wheels.update(bodies_below(bodies, number))
    return sorted(wheels)


def _relevant_children(bodies: list[Body], counts: list[int], number: int, *, keeps_wheels: bool) -> list[int]:
    """Return the children of a body without wheels, and without linkages that only follow an arm."""
    children = [
        child
        for child in bodies[number].children
        if keeps_wheels or len(bodies[number].children) == 1 or not is_wheel(bodies, child)
    ]
    has_arm = any(counts[child] >= MIN_ARM_JOINTS for child in children)
    return [child for child in children if counts[child] or not has_arm]


def _are_fingers(bodies: list[Body], chain: list[int], children: list[int]) -> bool:
    longest = max(branch_length(bodies, child) for child in children)
    return longest <= _MAX_FINGER_SHARE * chain_length(bodies, list(_without_root(chain)))


def _split_last_joint(bodies: list[Body], chain: list[int]) -> Chain:
    """Return the arm of a chain without branches, whose last joint may be a gripper."""
    arm = list(_without_root(chain))
    active = [index for index, number in enumerate(arm) if bodies[number].is_active]
    last = active[-1]
    leader = bodies[arm[last]].joint
    assert leader is not None
    names = (leader.name, *bodies[arm[last]].links[:1])
    is_led = any(
        body.joint is not None and body.joint.mimic is not None and body.joint.mimic.joint == leader.name
        for body in (bodies[number] for number in arm[last + 1 :])
    )
    if len(active) > MIN_ARM_JOINTS and (is_led or any(map(_GRIPPER_NAME.search, names))):
        return Chain(tuple(arm[:last]), tuple(arm[last:]))
    return Chain(tuple(arm))


def _without_root(chain: list[int]) -> tuple[int, ...]:
    return tuple(number for number in chain if number)
