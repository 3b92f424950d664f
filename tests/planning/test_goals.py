"""Goals with positions of joints that mimic others."""

from __future__ import annotations

import pytest

from linkwright.kinematics.tree import MimicRelation
from linkwright.planning.goals import ContradictionError, Goal, JointTarget

pytestmark = pytest.mark.extra("arm")

RELATIONS = {
    "left": MimicRelation("left"),
    "right": MimicRelation("left", factor=-2.0, offset=0.1),
    "still": MimicRelation("left", factor=0.0),
}


def test_target_of_a_mimic_joint_is_one_of_its_leader() -> None:
    goal = Goal({"right": JointTarget(0.5, above=0.04, below=0.02)}).follow_leaders(RELATIONS)
    (target,) = goal.joints.values()
    assert list(goal.joints) == ["left"]
    # right = 0.48 to 0.54, so left = -0.19 to -0.22
    assert (target.position, target.above, target.below) == pytest.approx((-0.2, 0.01, 0.02))


def test_targets_of_both_joints_are_both_fulfilled() -> None:
    left, right = JointTarget(-0.15, above=0.1, below=0.04), JointTarget(0.5, above=0.04, below=0.06)
    for joints in ({"left": left, "right": right}, {"right": right, "left": left}):
        target = Goal(joints).follow_leaders(RELATIONS).joints["left"]
        assert target.position - target.below == pytest.approx(-0.19)
        assert target.position + target.above == pytest.approx(-0.17)


def test_equal_targets_without_tolerances_stay_as_they_are() -> None:
    goal = Goal({"left": JointTarget(0.03), "right": JointTarget(0.1 - 2 * 0.03)}).follow_leaders(RELATIONS)
    assert goal.joints["left"].position == pytest.approx(0.03)


def test_contradicting_targets_are_refused() -> None:
    goal = Goal({"left": JointTarget(0.03), "right": JointTarget(0.03)})
    with pytest.raises(ContradictionError, match=r"'right' contradict those of other joints that move with 'left'"):
        goal.follow_leaders(RELATIONS)


def test_other_targets_are_kept() -> None:
    joints = {"left": JointTarget(0.03), "still": JointTarget(0.0), "unknown": JointTarget(1.0)}
    assert Goal(joints).follow_leaders(RELATIONS).joints == joints
