"""Breaking changes of the parameter files of MoveIt.

The tests cover controllers, actions, planners and joints with limits.
"""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "a/config/m.yaml"
SETTINGS = """controller_list:
  - name: ns/arm_controller
    action_ns: follow_joint_trajectory
    type: FollowJointTrajectory
    default: true
  - name: ns/hand_controller
    action_ns: grip
    type: GripperCommand
manager:
  controller_names: [wrist]
  wrist: {action_ns: follow, type: FollowJointTrajectory, joints: [upper, lower]}
joint_limits:
  upper: {has_velocity_limits: true, max_velocity: 1.0, has_acceleration_limits: false, max_position: 2.0}
  lower: {has_velocity_limits: true, max_velocity: 2.0, has_acceleration_limits: false}
planner_configs:
  EST: {type: geometric::EST, range: 0.0, goal_bias: 0.05}
  RRT: {type: geometric::RRT, range: 0.0, delay: 1}
arm:
  planner_configs: [EST, RRT]
  kinematics_solver: kdl
leg:
  kinematics_solver: kdl
  kinematics_solver_timeout: 0.1
  kinematics_solver_attempts: 3
"""
HAND = "  - name: ns/hand_controller\n    action_ns: grip\n    type: GripperCommand\n"
LOWER = "  lower: {has_velocity_limits: true, max_velocity: 2.0, has_acceleration_limits: false}\n"
LEG = "leg:\n  kinematics_solver: kdl\n  kinematics_solver_timeout: 0.1\n  kinematics_solver_attempts: 3\n"
RRT = "  RRT: {type: geometric::RRT, range: 0.0, delay: 1}\n"


@pytest.fixture
def review_changes(repository, compare):
    """Review two versions of a file.

    Return all changes, the breaking ones, and the reasons of these.
    """

    def run(text: str, changed: str):
        assert text != changed
        repository.commit({"a/package.xml": PACKAGE_XML, PATH: text})
        repository.write({PATH: changed})
        result = compare(repository)
        found = subject(result, PATH)
        return sentences(found), breaking(result), [str(each.reason) for each in found.changes if each.reason]

    return run


@pytest.mark.parametrize(
    ("old", "new", "sentence", "reason"),
    [
        ("ns/arm_controller", "ns/base_controller",
         "controller_list[ns/arm_controller] renamed to controller_list[ns/base_controller]",
         "programs that load or command the controller 'ns/arm_controller' do not find it"),
        (HAND, "", "controller_list[ns/hand_controller] removed: action_ns grip, type GripperCommand",
         "programs that load or command the controller 'ns/hand_controller' do not find it"),
        ("action_ns: grip", "action_ns: grasp", "controller_list[ns/hand_controller].action_ns grip -> grasp",
         "the action server 'ns/hand_controller/grip' gets no goals"),
        ("action_ns: follow,", "action_ns: go,", "manager.wrist.action_ns follow -> go",
         "the action server 'wrist/follow' gets no goals"),
        ("  lower:", "  elbow:", "joint_limits.lower renamed to joint_limits.elbow",
         "controllers and programs that name the joint 'lower' do not find it"),
        (RRT, "",
         "planner_configs.RRT removed: type geometric::RRT, range 0.0, delay 1",
         "programs that plan with the planner 'RRT' do not find it"),
        ("  RRT:", "  RRTquick:", "planner_configs.RRT renamed to planner_configs.RRTquick",
         "programs that plan with the planner 'RRT' do not find it"),
        ("action_ns: grip\n    type: GripperCommand", "action_ns: grip\n    type: FollowJointTrajectory",
         "controller_list[ns/hand_controller].type GripperCommand -> FollowJointTrajectory",
         ("the controller 'ns/hand_controller' must serve the action 'FollowJointTrajectory'"
          " instead of 'GripperCommand'")),
        ("[upper, lower]", "[upper, elbow]", "manager.wrist.joints [upper, lower] -> [upper, elbow]",
         "MoveIt finds no controller for the joint 'lower'"),
        ("max_position: 2.0", "max_position: 1.5", "joint_limits.upper.max_position 2.0 -> 1.5",
         "positions of 'upper' above 1.5 are now outside of its limits"),
        (LEG, "", "leg removed: kinematics_solver kdl, kinematics_solver_timeout 0.1, kinematics_solver_attempts 3",
         "MoveIt has no inverse kinematics for the group 'leg'"),
        ("leg:\n", "foot:\n", "leg renamed to foot", "MoveIt has no inverse kinematics for the group 'leg'"),
        ("[EST, RRT]", "[RRT]", "arm.planner_configs [EST, RRT] -> [RRT]",
         "programs that plan with the planner 'EST' do not find it"),
    ],
)  # fmt: skip
def test_name_that_is_gone_is_one_breaking_change(review_changes, old, new, sentence, reason):
    found, found_breaking, review_reasons = review_changes(SETTINGS, SETTINGS.replace(old, new))
    assert found == found_breaking == [sentence]
    assert review_reasons == [reason]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (LOWER, ""),
        (SETTINGS[: SETTINGS.index("manager:")], ""),
        ("ns/arm_controller", "$(arg ns)/arm_controller"),
        ("  lower:", "  $(arg side)lower:"),
        ("  lower: {has_velocity_limits: true, max_velocity", "  lower: {has_velocity_limits: false, max_velocity"),
        ("action_ns: grip", "action_ns: $(arg action)"),
        ("[EST, RRT]", "[RRT, EST]"),
        ("max_position: 2.0", "max_position: 2.5"),
        ("max_position: 2.0", "max_position: 1.99"),
        ("[upper, lower]", "[lower, upper, elbow]"),
        ("leg:\n  kinematics_solver: kdl", "leg:\n  kinematics_solver: lma"),
        ("joint_limits:", "limits:\n  joint_limits:"),
    ],
)
def test_other_change_is_not_breaking(review_changes, old, new):
    changed = SETTINGS.replace(old, new)
    if new.startswith("limits:"):
        start = changed.index("  upper:")
        end = changed.index("planner_configs:\n  EST")
        changed = changed[:start] + changed[start:end].replace("  ", "    ") + changed[end:]
    assert review_changes(SETTINGS, changed)[1] == []


def test_planner_that_is_also_gone_from_the_groups_is_breaking_once(review_changes):
    _, found_breaking, _ = review_changes(SETTINGS, SETTINGS.replace(RRT, "").replace("[EST, RRT]", "[EST]"))
    assert found_breaking == ["planner_configs.RRT removed: type geometric::RRT, range 0.0, delay 1"]


def test_joints_that_are_renamed_alike_are_one_breaking_change(review_changes):
    text = SETTINGS.replace("  upper:", "  left_upper:").replace("  lower:", "  left_lower:")
    found, _, review_reasons = review_changes(text, text.replace("left", "right"))
    assert found == ["joint_limits.left_upper renamed to joint_limits.right_upper"]
    assert review_reasons == [
        "controllers and programs that name the joint 'left_upper' do not find it; likewise for the others"
    ]


@pytest.mark.parametrize(("joint", "is_breaking"), [("elbow", False), ("lower", True)])
def test_controller_without_a_joint_that_the_semantic_description_lacks(repository, compare, joint, is_breaking):
    semantics = f'<robot name="a"><group name="arm"><joint name="upper"/><joint name="{joint}"/></group></robot>\n'
    repository.commit({"a/package.xml": PACKAGE_XML, "a/config/a.srdf": semantics, PATH: SETTINGS})
    repository.write({PATH: SETTINGS.replace("[upper, lower]", "[upper, elbow]")})
    assert bool(breaking(compare(repository))) is is_breaking


SEMANTICS = "<robot name='a'><group name='{}'><joint name='upper'/></group><group name='arm'/></robot>\n"
FAKE = "controller_list:\n  - name: fake_leg_controller\n    joints: [upper]\n"
FAKE += "  - name: fake_arm_controller\n    joints: [upper]\n"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (LEG, ""),
        ("leg:\n", "foot:\n"),
        (FAKE.partition("  - name: fake_arm")[0], "controller_list:\n"),
    ],
)
@pytest.mark.parametrize("is_lost", [True, False])
def test_settings_of_a_lost_group_break_nothing_more(repository, compare, old, new, is_lost):
    text = FAKE if "fake" in old else SETTINGS
    files = {"a/package.xml": PACKAGE_XML, PATH: text, "a/config/a.srdf": SEMANTICS.format("leg")}
    files["a/config/copy.srdf"] = files["a/config/a.srdf"]
    repository.commit(files)
    repository.write({PATH: text.replace(old, new), "a/config/a.srdf": SEMANTICS.format("foot" if is_lost else "leg")})
    lost = [change for change in subject(compare(repository), PATH).changes if change.reason is not None]
    assert bool(lost) != is_lost


TYPE = "joint_trajectory_controller/JointTrajectoryController"
CONTROLLERS = f"controller_manager: {{{{ros__parameters: {{{{{{name}}: {{{{type: {TYPE}}}}}}}}}}}}}"
WRIST, HAND = CONTROLLERS.format(name="wrist"), CONTROLLERS.format(name="hand")


@pytest.mark.parametrize(
    ("others", "is_breaking"),
    [
        ({"a/config/c.yaml": HAND}, False),
        ({"a/config/c.yaml": WRIST}, True),
        ({"a/config/c.yaml": WRIST, "a/config/d.yaml": HAND}, True),
        ({}, True),
    ],
)  # fmt: skip
def test_controllers_of_moveit_that_follow_the_configured_ones(repository, compare, others, is_breaking):
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: SETTINGS, **others})
    repository.write({PATH: SETTINGS.replace("[wrist]", "[hand]")})
    result = compare(repository)
    text = "manager.controller_names [wrist] -> [hand]"
    assert text in sentences(subject(result, PATH))
    assert (text in breaking(result)) is is_breaking
