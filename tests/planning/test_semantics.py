"""Semantic descriptions (SRDF), and the groups that they define."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from linkwright.descriptions.service import load
from linkwright.planning.groups import joint_limits, resolve_groups
from linkwright.planning.known_names import leave_out_unknown_names
from linkwright.planning.semantics import GroupDefinition, read_semantics
from tests.planning.arms import SRDF, arm, urdf

pytestmark = pytest.mark.extra("arm")


class TestSemantics:
    def test_all_parts_are_read(self) -> None:
        semantics = read_semantics(SRDF)
        assert list(semantics.groups) == ["arm", "gripper", "all"]
        assert semantics.groups["arm"].chains == (("base", "tool"),)
        assert semantics.groups["all"].subgroups == ("arm", "gripper")
        assert semantics.states["arm"]["ready"] == {"lift": 0.4, "elbow": 1.2}
        assert semantics.end_effectors[0].parent_link == "tool"
        assert semantics.virtual_joints[0].parent_frame == "world"
        assert semantics.disabled_collisions[frozenset(("wrist", "palm"))] == "Adjacent"

    def test_link_may_collide_with_all_by_default(self) -> None:
        semantics = read_semantics("<robot><disable_default_collisions link='tool'/></robot>")
        assert semantics.disabled_collisions == {frozenset(("tool", "")): "Default"}

    def test_missing_attribute_names_its_place(self) -> None:
        semantics = read_semantics("<robot>\n  <group><joint name='a'/></group></robot>")
        assert [problem.code for problem in semantics.problems] == ["ARM101"]
        assert semantics.problems[0].span.line == 2

    @pytest.mark.parametrize(
        "element",
        [
            "<virtual_joint type='floating' parent_frame='world' child_link='base'/>",
            "<end_effector name='hand' parent_link='tool'/>",
            "<disable_collisions link1='base'/>",
            "<passive_joint/>",
            "<group_state name='home'/>",
            "<group><link name='base'/></group>",
        ],
    )
    def test_incomplete_element_leaves_the_rest(self, element: str) -> None:
        whole, semantics = read_semantics(SRDF), read_semantics(SRDF.replace("</robot>", f"{element}</robot>"))
        assert len(semantics.problems) == 1
        assert replace(semantics, problems=()) == whole

    def test_incomplete_part_leaves_the_rest_of_a_group(self) -> None:
        semantics = read_semantics(
            "<robot><group name='g'><joint/><joint name='a'/><chain base_link='b'/></group></robot>"
        )
        assert semantics.groups["g"] == GroupDefinition("g", joints=("a",))
        assert len(semantics.problems) == 2

    def test_position_must_be_a_number(self) -> None:
        joints = "<joint name='a' value='x'/><joint name='b' value='1'/>"
        semantics = read_semantics(f"<robot><group_state name='s' group='g'>{joints}</group_state></robot>")
        assert "'x' is not a number" in semantics.problems[0].message
        assert semantics.states == {"g": {"s": {"b": 1.0}}}


class TestGroups:
    def test_chain_contains_moving_joints_from_base_to_tip(self) -> None:
        group = arm().groups["arm"]
        assert group.joint_names == ("pan", "lift", "elbow", "roll", "bend", "twist")
        assert group.tip == "tool"
        np.testing.assert_allclose(group.max_velocities, 2.0)
        np.testing.assert_allclose(group.max_accelerations, 4.0)

    def test_mimic_joint_has_no_position_of_its_own(self) -> None:
        assert arm().groups["gripper"].joint_names == ("left",)

    def test_subgroups_are_joined(self) -> None:
        assert arm().groups["all"].joint_names == (*arm().groups["arm"].joint_names, "left")

    def test_group_of_links_contains_their_parent_joints(self) -> None:
        semantics = read_semantics("<robot><group name='g'><link name='forearm'/><link name='palm'/></group></robot>")
        group = resolve_groups(arm().robot, semantics, arm().model.joint_names)["g"]
        assert group.joint_names == ("elbow", "bend")
        assert group.tip is None

    @pytest.mark.parametrize(
        ("content", "kind"),
        [
            ("<joint name='elbwo'/>", "joint"),
            ("<link name='elbwo'/>", "link"),
            ("<group name='elbwo'/>", "group"),
            ("<chain base_link='base' tip_link='elbwo'/>", "link"),
            ("<group name='g'/>", "group"),
        ],
    )
    def test_unknown_name_is_left_out(self, content: str, kind: str) -> None:
        text = (
            f"<robot><group name='arm'><joint name='pan'/></group><group name='g'><joint name='pan'/>{content}</group>"
        )
        semantics = leave_out_unknown_names(read_semantics(f"{text}</robot>"), arm().robot)
        assert [problem.code for problem in semantics.problems] == ["ARM102"]
        assert f"names the {kind} " in semantics.problems[0].message
        groups = resolve_groups(arm().robot, semantics, arm().model.joint_names)
        assert groups["arm"].joint_names == ("pan",)
        assert ("g" in groups) == (kind != "group")

    def test_end_effector_of_an_unknown_link_is_left_out(self) -> None:
        text = SRDF.replace("parent_link='tool'", "parent_link='tol'")
        assert leave_out_unknown_names(read_semantics(text), arm().robot).end_effectors == ()

    def test_virtual_joint_may_belong_to_a_group(self) -> None:
        text = SRDF.replace("<group name='gripper'>", "<group name='gripper'><joint name='fixed'/>")
        semantics = leave_out_unknown_names(read_semantics(text), arm().robot)
        assert semantics.problems == ()
        assert resolve_groups(arm().robot, semantics, arm().model.joint_names)["gripper"].joint_names == ("left",)

    def test_unwinding_removes_full_turns_within_bounds(self) -> None:
        robot = load(
            "<robot name='r'><link name='a'/><link name='b'/><link name='c'/><link name='d'/>"
            "<joint name='wide' type='revolute'><parent link='a'/><child link='b'/>"
            "<limit lower='-6.3' upper='6.3' effort='1' velocity='1'/></joint>"
            "<joint name='endless' type='continuous'><parent link='b'/><child link='c'/></joint>"
            "<joint name='slide' type='prismatic'><parent link='c'/><child link='d'/>"
            "<limit lower='-9' upper='9' effort='1' velocity='1'/></joint></robot>"
        )
        semantics = read_semantics("<robot><group name='g'><chain base_link='a' tip_link='d'/></group></robot>")
        group = resolve_groups(robot, semantics, ("wide", "endless", "slide"))["g"]
        unwound = group.unwind(np.array((-3.0, -3.0, -3.0)), np.array((3.0, 7.0, 7.0)))
        np.testing.assert_allclose(unwound, (2 * pi - 3.0, 4 * pi - 3.0, -3.0))
        np.testing.assert_allclose(
            group.unwind(np.array((6.2, 6.2, 6.2)), np.full(3, -6.2)), (6.2 - 2 * pi, 6.2 - 4 * pi, 6.2)
        )
        assert group.satisfies_bounds(np.array((6.0, 50.0, 8.0)))
        assert not group.satisfies_bounds(np.array((6.4, 0.0, 0.0)))


class TestLimits:
    def test_soft_limits_and_overrides_apply(self) -> None:
        text = urdf().replace(
            "effort='1' velocity='2'/>",
            "effort='1' velocity='2'/><safety_controller k_velocity='1' soft_lower_limit='-1' soft_upper_limit='9'/>",
            1,
        )
        joint = load(text).joints["pan"]
        assert (joint_limits(joint).lower, joint_limits(joint).upper) == (-1.0, 2.8)
        overrides = {"has_velocity_limits": True, "max_velocity": 0.5, "has_position_limits": True, "max_position": 1}
        limits = joint_limits(joint, overrides)
        assert (limits.lower, limits.upper, limits.max_velocity, limits.max_acceleration) == (-1.0, 1.0, 0.5, 1.0)

    def test_jerk_is_limited_only_if_the_file_says_so(self) -> None:
        joint = load(urdf()).joints["pan"]
        assert joint_limits(joint, {"has_jerk_limits": True, "max_jerk": 20}).max_jerk == 20.0
        assert joint_limits(joint, {"has_jerk_limits": False, "max_jerk": 20}).max_jerk == float("inf")
