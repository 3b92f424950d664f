"""The groups of robots by their shape, and those that a user names."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.planning.setup.groups import GroupRequests, PlanningGroup, find_groups
from tests.planning.setup.robots import chain, fingers, joint, link, mobile_arm, robot, two_arms, wheels


def by_name(description: object, requests: GroupRequests | None = None) -> dict[str, PlanningGroup]:
    return {group.name: group for group in find_groups(description, requests).groups}  # type: ignore[arg-type]


def code_of(error: pytest.ExceptionInfo[LinkwrightError]) -> str:
    return error.value.diagnostics[0].code


class TestFoundGroups:
    def test_arm_ends_before_palm_and_gripper_has_fingers(self) -> None:
        groups = by_name(mobile_arm())
        assert list(groups) == ["arm", "gripper"]
        assert (groups["arm"].base, groups["arm"].tip) == ("base", "link_6")
        assert groups["arm"].active_joints == tuple(f"joint_{index}" for index in range(1, 7))
        gripper = groups["gripper"]
        assert gripper.joints == ("finger_1_joint", "finger_2_joint")
        assert gripper.active_joints == ("finger_1_joint",)
        assert gripper.links == ("hand", "hand_tcp")
        assert (gripper.parent_link, gripper.parent_group) == ("link_6", "arm")

    def test_wheels_are_passive(self) -> None:
        groups = find_groups(mobile_arm())
        assert groups.passive_joints == ("caster_joint", "left_wheel_joint", "right_wheel_joint", "roll_joint")
        assert groups.other_joints == ()
        assert groups.controlled_joints == (*(f"joint_{index}" for index in range(1, 7)), "finger_1_joint")

    def test_two_arms_are_named_by_their_side(self) -> None:
        groups = find_groups(two_arms())
        assert [group.name for group in groups.groups] == ["left_arm", "left_gripper", "right_arm", "right_gripper"]
        assert groups.groups[0].base == "torso"
        assert groups.groups[3].parent_group == "right_arm"
        assert groups.other_joints == ("lift", "head_joint_1", "head_joint_2")

    def test_arms_without_shared_words_are_numbered(self) -> None:
        second = chain("base", "b_", 3).replace("b_joint_1", "pan").replace("b_joint_2", "lift")
        names = by_name(robot(link("base"), chain("base", "a_", 3), second))
        assert list(names) == ["arm_1", "arm_2"]

    def test_legs_are_named_by_their_joints(self) -> None:
        legs = "".join(
            chain("base", f"{side}_", 3, xyz=f"0 {y} 0").replace(f"{side}_joint_1", f"{side}_hip_joint")
            for side, y in (("FL", 0.2), ("FR", -0.2))
        )
        assert list(by_name(robot(link("base"), legs))) == ["FL_leg", "FR_leg"]

    def test_hand_with_many_fingers_is_a_gripper(self) -> None:
        hand = "".join(
            link(f"f{finger}_{part}", 0.02)
            + joint(
                f"j{finger}_{part}", f"f{finger}_{part - 1}" if part else "link_6", f"f{finger}_{part}", xyz="0 0 0.04"
            )
            for finger in range(4)
            for part in range(4)
        )
        groups = by_name(robot(link("base"), chain("base", "", 6), hand))
        assert len(groups["arm"].joints) == 6
        assert len(groups["gripper"].active_joints) == 16

    def test_single_finger_is_known_by_its_name_or_its_followers(self) -> None:
        named = robot(link("base"), chain("base", "", 5), link("jaw") + joint("gripper_joint", "link_5", "jaw"))
        assert by_name(named)["gripper"].joints == ("gripper_joint",)
        led = robot(
            link("base"),
            chain("base", "", 6),
            link("end") + joint("follower", "link_6", "end", mimic="joint_6"),
        )
        assert by_name(led)["gripper"].joints == ("joint_6", "follower")
        plain = robot(link("base"), chain("base", "", 6))
        assert list(by_name(plain)) == ["arm"]

    def test_tip_is_the_tool_and_not_a_camera(self) -> None:
        tools = "".join(
            link(name) + joint(f"{name}_mount", parent, name, kind="fixed")
            for name, parent in (
                ("flange", "link_4"),
                ("tool0", "flange"),
                ("camera", "link_4"),
                ("camera_optical", "camera"),
                ("camera_optical_2", "camera_optical"),
            )
        )
        assert by_name(robot(link("base"), chain("base", "", 4), tools))["arm"].tip == "tool0"

    def test_linkage_that_follows_the_arm_is_no_branch(self) -> None:
        linkage = link("rod") + joint("rod_joint", "link_1", "rod", mimic="joint_2")
        groups = by_name(robot(link("base"), chain("base", "", 4), linkage))
        assert list(groups) == ["arm"]
        assert groups["arm"].joints == ("joint_1", "joint_2", "joint_3", "joint_4")

    def test_first_joint_that_turns_a_head_too_belongs_to_the_arm(self) -> None:
        head = link("head", 0.05) + joint("head_pan", "link_1", "head")
        groups = by_name(robot(link("base"), chain("base", "", 7), head))
        assert groups["arm"].joints == tuple(f"joint_{index}" for index in range(1, 8))
        assert groups["arm"].base == "base"

    def test_torso_that_lifts_a_head_too_does_not_belong_to_the_arm(self) -> None:
        torso = link("torso", 0.2) + joint("lift", "base", "torso", kind="prismatic", limits=(0.0, 0.3))
        head = link("head", 0.05) + joint("head_pan", "torso", "head")
        assert by_name(robot(link("base"), torso, chain("torso", "", 6), head))["arm"].base == "torso"

    def test_arm_whose_last_joint_is_continuous_is_no_wheel(self) -> None:
        text = chain("base", "", 2) + link("end") + joint("roll", "link_2", "end", kind="continuous")
        assert by_name(robot(link("base"), wheels("base"), text))["arm"].joints == ("joint_1", "joint_2", "roll")


class TestRequests:
    def test_requested_chain_replaces_groups_with_its_joints(self) -> None:
        groups = by_name(two_arms(), GroupRequests(groups={"left": "base:left_link_5"}))
        assert list(groups) == ["left_gripper", "right_arm", "right_gripper", "left"]
        assert groups["left"].joints[0] == "lift"

    def test_requested_joints_make_a_group(self) -> None:
        groups = by_name(two_arms(), GroupRequests(groups={"head": "head_joint_1,head_joint_2"}))
        assert groups["head"].active_joints == ("head_joint_1", "head_joint_2")
        assert not groups["head"].is_chain

    def test_tip_and_end_effector_are_chosen(self) -> None:
        requests = GroupRequests(
            groups={"claw": "finger_1_joint,finger_2_joint"}, tips={"arm": "hand"}, end_effectors={"claw": "hand"}
        )
        groups = by_name(mobile_arm(), requests)
        assert groups["arm"].tip == "hand"
        assert (groups["claw"].parent_link, groups["claw"].parent_group) == ("hand", "arm")
        assert list(groups) == ["arm", "claw"]

    @pytest.mark.parametrize(
        "requests",
        [
            GroupRequests(groups={"arm": "base:nowhere"}),
            GroupRequests(groups={"arm": "link_6:base"}),
            GroupRequests(groups={"arm": "joint_1,joint_9"}),
            GroupRequests(tips={"leg": "hand"}),
            GroupRequests(end_effectors={"gripper": "nowhere"}),
        ],
    )
    def test_unknown_names_are_refused(self, requests: GroupRequests) -> None:
        with pytest.raises(LinkwrightError) as error:
            find_groups(mobile_arm(), requests)
        assert code_of(error) == "ARM106"

    def test_robot_without_arm_is_refused_unless_a_group_is_named(self) -> None:
        short = robot(link("base"), chain("base", "", 2), wheels("base"), fingers("link_2", ""))
        with pytest.raises(LinkwrightError) as error:
            find_groups(short)
        assert code_of(error) == "ARM105"
        assert list(by_name(short, GroupRequests(groups={"arm": "base:link_2"}))) == ["arm"]
