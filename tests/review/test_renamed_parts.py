"""Changes of YAML files whose values have another place.

The tests cover renamed and moved parts, and items of lists.
"""

from __future__ import annotations

import re
import textwrap

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/config/arm.yaml"


@pytest.fixture
def review_changes(repository, compare):
    """Review two versions of a YAML file.

    Return the changes, and the sentences of the breaking ones.
    """

    def run(old: str | None, new: str | None):
        repository.commit({"arm/package.xml": PACKAGE_XML, PATH: old})
        repository.write({PATH: new})
        result = compare(repository)
        return subject(result, PATH), breaking(result)

    return run


CONTROLLER = """arm_controller:
  type: position_controllers/JointTrajectoryController
  joints: [left_joint1, left_joint2]
  constraints:
    left_joint1: {goal: 0.05}
    left_joint2: {goal: 0.06}
  gains:
    left_joint1: {p: 1, i: 2}
    left_joint2: {p: 1, i: 2}
"""


def test_joints_that_get_another_prefix_are_one_change_and_the_list_of_them(review_changes):
    found, found_breaking = review_changes(CONTROLLER, CONTROLLER.replace("left", "right").replace("0.06", "0.07"))
    part = "arm_controller.constraints"
    assert sentences(found) == [
        f"{part}.left_joint1 renamed to {part}.right_joint1",
        "arm_controller.joints [left_joint1, left_joint2] -> [right_joint1, right_joint2]",
        f"{part}.right_joint2.goal 0.06 -> 0.07",
    ]
    gains = "arm_controller.gains"
    assert found.changes[0].other_names == (
        f"{part}.left_joint2 -> {part}.right_joint2",
        f"{gains}.left_joint1 -> {gains}.right_joint1",
        f"{gains}.left_joint2 -> {gains}.right_joint2",
    )
    assert found_breaking == sentences(found)[1:2]


def test_name_with_a_substitution_can_be_the_old_name(review_changes):
    _, found_breaking = review_changes(CONTROLLER, CONTROLLER.replace("left", "$(arg side)"))
    assert found_breaking == []


TELEOP = """bluetooth:
  teleop: {axis: 1, scale: 0.4, turbo: 2}
  joy: {deadzone: 0.1}
"""


def test_parts_outside_their_group_are_moved(review_changes):
    found, _ = review_changes(TELEOP, "teleop: {axis: 1, scale: 0.5, turbo: 2}\njoy: {deadzone: 0.1}\n")
    assert sentences(found) == ["bluetooth.teleop moved to teleop", "teleop.scale 0.4 -> 0.5"]
    assert found.changes[0].other_names == ("bluetooth.joy -> joy",)


POSES = """poses:
  ros__parameters:
    group:
    home:
      joints: [lift, pan, tilt]
      points: [{positions: [1, 2, 3], time: 1.0}]
      meta: {name: Home, usage: demo, text: go home}
    tour:
      joints: [pan, tilt]
      points: [{positions: [1, 2], time: 1.0}, {positions: [3, 4], time: 5.0}, {positions: [5, 6], time: 6.0}]
      meta: {name: Tour, usage: demo, text: look around}
"""
GROUPED_POSES = """poses:
  ros__parameters:
    group:
      home:
        joints: [lift, pan, tilt]
        positions: [1, 2, 3]
        meta: {name: Home, usage: demo, text: go home}
      tour:
        joints: [pan, tilt]
        positions: [1, 2, 3, 4, 5, 6]
        meta: {name: Tour, usage: demo, text: look around}
"""


def test_parts_that_move_together_are_paired_with_their_own_new_places(review_changes):
    found, found_breaking = review_changes(POSES, GROUPED_POSES)
    part = "poses.ros__parameters"
    assert sentences(found)[0] == f"{part}.home moved to {part}.group.home"
    assert found.changes[0].other_names == (f"{part}.tour -> {part}.group.tour",)
    assert not [text for text in sentences(found) if ".meta" in text or f"{part}.group removed" in text]
    assert found_breaking[0] == sentences(found)[0]
    assert [text.split(" removed: ")[0] for text in found_breaking[1:]] == [
        f"{part}.group.home.points",
        f"{part}.group.tour.points",
    ]


def test_removed_group_of_parameters_of_a_node_is_breaking_and_a_single_value_is_not(review_changes):
    text = "poses:\n  ros__parameters:\n    rate: 5\n    open: {x: 1}\n    close: {x: 0, y: 1}\n"
    _, found_breaking = review_changes(text, "poses:\n  ros__parameters:\n    close: {x: 0}\n")
    assert found_breaking == ["poses.ros__parameters.open.x 1 removed"]


def test_values_of_the_same_name_that_many_parts_lose_are_one_line(review_changes):
    text = "".join(f"joint{number}: {{gain: {number}.5, limit: 1}}\n" for number in range(5))
    text = f"joints:\n{textwrap.indent(text, '  ')}"
    found, _ = review_changes(text, re.sub(r"gain: \S+ ", "", text))
    assert sentences(found) == ["joints.joint0.gain removed"]
    assert found.changes[0].other_names == tuple(f"joints.joint{number}.gain" for number in range(1, 5))


ROS_1_CONTROLLERS = """torso_controller:
  trajectory: {type: robot_controllers/Trajectory, joints: [lift]}
  balance: {type: robot_controllers/Balance, root: base, tip: hand, autostart: true}
arm_controller:
  trajectory: {type: robot_controllers/Trajectory, joints: [arm]}
driver:
  default_controllers: [torso_controller/trajectory, torso_controller/balance]
"""


def test_controller_of_ros_1_with_another_name_is_breaking(review_changes):
    balance = "  balance: {type: robot_controllers/Balance, root: base, tip: hand, autostart: true}\n"
    text = ROS_1_CONTROLLERS.replace(balance, "").replace("arm_controller:\n", f"arm_controller:\n{balance}")
    text = text.replace("[torso_controller/trajectory, torso_controller/balance]", "[torso_controller/trajectory]")
    _, found_breaking = review_changes(ROS_1_CONTROLLERS, text)
    assert found_breaking[0] == "torso_controller.balance moved to arm_controller.balance"
    assert found_breaking[1].startswith("driver.default_controllers")


def test_removed_controller_of_ros_1_is_breaking(review_changes):
    part = "  balance: {type: robot_controllers/Balance, root: base, tip: hand, autostart: true}\n"
    found, found_breaking = review_changes(ROS_1_CONTROLLERS, ROS_1_CONTROLLERS.replace(part, ""))
    assert found_breaking == sentences(found)
    assert found_breaking[0].startswith("torso_controller.balance removed: type robot_controllers/Balance")


def test_empty_key_that_gets_or_loses_children_is_neither_removed_nor_added(review_changes):
    found, _ = review_changes("limits:\nrate: 1\n", "limits: {speed: 2}\nrate: 1\n")
    assert sentences(found) == ["limits.speed 2 added"]


NODE = "{ros__parameters: {rate: 1, size: 2, base: x}}"


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [("amcl", "/**/amcl", False), ("/**", "/**/amcl", False), ("amcl", "map_server", True), ("/a/amcl", "/*/b", True)],
)
def test_node_whose_new_name_matches_the_old_one_keeps_its_parameters(review_changes, old, new, is_breaking):
    _, found_breaking = review_changes(f"{old}: {NODE}\n", f"{new}: {NODE}\n")
    assert found_breaking == [f"{old} renamed to {new}"][: int(is_breaking)]


STEPS = [f"- {{action: move, to: {n}, tool: t{n}}}\n" for n in range(6)]


@pytest.mark.parametrize(
    ("steps", "expected"),
    [
        ([*STEPS[:3], "- {wait: 3}\n", STEPS[3].replace("t3", "t9"), *STEPS[4:]],
         ["steps[4].tool t3 -> t9", "steps[3].wait 3 added"]),
        ([*STEPS[:3], STEPS[4].replace("t4", "t9"), STEPS[5]],
         ["steps[3].tool t4 -> t9", "steps[old 3] removed: action move, to 3, tool t3"]),
        ([*STEPS[:5], "- {wait: 3}\n"],
         ["steps[5].wait 3 added", "steps[old 5] removed: action move, to 5, tool t5"]),
    ],
)  # fmt: skip
def test_items_that_move_in_a_list_are_compared_with_the_old_ones(review_changes, steps, expected):
    found, _ = review_changes("steps:\n" + "".join(STEPS), "steps:\n" + "".join(steps))
    assert sentences(found) == expected


def test_equal_edits_of_names_are_one_change(review_changes):
    text = "".join(f"{name}: {{topic: /robot/{name}, timeout: 1}}\n" for name in ("joy", "key"))
    found, _ = review_changes(text, text.replace("/robot/", ""))
    assert sentences(found) == ["joy.topic /robot/joy -> joy"]
    assert found.changes[0].other_names == ("key.topic /robot/key -> key",)


def test_empty_text_in_a_list_is_visible(review_changes):
    found, _ = review_changes('buttons: [Select, "", ""]\n', "buttons: [Select]\n")
    assert sentences(found) == ["buttons [Select, '', ''] -> [Select]"]


def test_removed_file_has_its_values_and_the_number_of_the_others(review_changes):
    text = "".join(f"gain{number}: {number}\n" for number in range(42))
    found, _ = review_changes(text, None)
    assert sentences(found)[0].startswith("parameter file removed: gain0 0, gain1 1, ")
    assert sentences(found)[0].endswith(" and 2 more")


def test_items_of_a_list_that_have_only_a_name_are_shown_by_it(review_changes):
    found, _ = review_changes("wheels:\n- name: left\n- {name: right, arm: {length: 1}}\n- id: rear\n", None)
    assert sentences(found) == ["parameter file removed: wheels (left, [right].arm.length 1, rear)"]


PLANNERS = """planners:
  SBLkOld: {type: g.SBL, range: 0.0}
  ESTkOld: {type: g.EST, range: 0.0, bias: 0.05}
  RRTkOld: {type: g.RRT, range: 0.0, bias: 0.05}
  RRTtoldkOld: {type: g.RRTstar, range: 0.0, bias: 0.05, delay: 1}
"""


def test_parts_whose_names_lose_the_same_end_are_renamed_beside_added_ones(review_changes):
    added = "  BiEST: {type: g.BiEST, range: 0.0, bias: 0.05}\n  Lazy: {type: g.Lazy, range: 0.0}\n"
    found, _ = review_changes(PLANNERS, PLANNERS.replace("kOld", "") + added)
    assert [text.partition(":")[0] for text in sentences(found)] == [
        "planners.SBLkOld renamed to planners.SBL",
        "planners.BiEST added",
        "planners.Lazy added",
    ]
    assert found.changes[0].other_names == tuple(
        f"planners.{name}kOld -> planners.{name}" for name in ("EST", "RRT", "RRTtold")
    )


def test_part_with_a_unique_text_is_not_another_part_with_equal_numbers(review_changes):
    text = "filters:\n  first: {type: clip, low: 1, high: 2, rate: 3, size: 4}\n"
    new = text.replace("first", "b").replace("rate: 3", "rate: 5")
    new = new.replace("  b", "  a: {type: mean, low: 1, high: 2, rate: 3, size: 4}\n  b")
    found, _ = review_changes(text, new)
    assert sentences(found) == [
        "filters.first renamed to filters.b",
        "filters.b.rate 3 -> 5",
        "filters.a added: type mean, low 1, high 2, rate 3, size 4",
    ]


def test_name_that_gains_a_part_wins_over_another_with_equal_contents(review_changes):
    text = "filters:\n  scan: {low: 1, high: 2, rate: 3, size: 4}\n"
    new = "filters:\n  depth: {low: 1, high: 2, rate: 3, size: 4}\n  scan_left: {low: 1, high: 2, rate: 3, size: 5}\n"
    found, _ = review_changes(text, new)
    assert sentences(found)[:2] == ["filters.scan renamed to filters.scan_left", "filters.scan_left.size 4 -> 5"]


def test_parts_that_keep_their_values_are_the_renamed_ones(review_changes):
    old = "layer:\n  obstacle_range: 3.0\n  raytrace_range: 4.0\n"
    new = (
        "layer:\n  obstacle_min_range: 0.0\n  obstacle_max_range: 3.0\n  raytrace_min_range: 0.0\n"
        "  raytrace_max_range: 4.0\n"
    )
    found, _ = review_changes(old, new)
    assert sentences(found) == [
        "layer.obstacle_range renamed to layer.obstacle_max_range",
        "layer.obstacle_min_range 0.0 added",
        "layer.raytrace_min_range 0.0 added",
    ]
    assert found.changes[0].other_names == ("layer.raytrace_range -> layer.raytrace_max_range",)


BRIDGE = "bridge:\n  ros__parameters:\n    {}:\n      topic: /ping\n      peer: lamp/ping\n      is_raw: true\n"
NAMED_BRIDGE = BRIDGE.replace("      ", "        ").replace("{}:\n", "{}:\n      names: [lamp]\n      lamp:\n")


def test_values_that_move_into_a_new_part_beside_them_are_moved(review_changes):
    changed, reasons = review_changes(BRIDGE.format("out"), NAMED_BRIDGE.format("out"))
    prefix = "bridge.ros__parameters.out"
    assert sentences(changed)[0] == f"{prefix}.topic moved to {prefix}.lamp.topic"
    assert any(
        "values that are set under the old names no longer have an effect" in str(each.reason)
        for each in changed.changes
    )
    assert reasons
    assert not any("removed" in sentence for sentence in sentences(changed))


def test_equal_numbers_alone_do_not_show_that_values_moved(review_changes):
    old = BRIDGE.replace("lamp/ping", "2").replace("/ping", "1")
    new = NAMED_BRIDGE.replace("lamp/ping", "2").replace("/ping", "1")
    changed, _ = review_changes(old.format("out"), new.format("out"))
    assert not any(" moved to " in sentence for sentence in sentences(changed))


SCAN = """observation_sources: scan
scan: {data_type: LaserScan, topic: /scan, marking: true, clearing: true}
"""
SCAN_LAYER = """obstacles:
  observation_sources: scan
  scan: {data_type: LaserScan, topic: scan, marking: true, clearing: true, frame: laser, low: 0, high: 1.0, far: 2.5}
"""


def test_part_that_moves_into_a_group_and_gets_many_new_values_has_moved(review_changes):
    changed, reasons = review_changes(SCAN, SCAN_LAYER)
    assert "scan moved to obstacles.scan" in sentences(changed)
    assert "obstacles.scan.topic /scan -> scan" in sentences(changed)
    assert reasons == []


def test_part_that_shares_few_values_with_one_in_a_group_has_not_moved(review_changes):
    other = SCAN_LAYER.replace("LaserScan", "PointCloud2").replace("marking", "mark").replace("clearing", "clear")
    changed, _ = review_changes(SCAN, other)
    assert any(sentence.startswith("scan removed: ") for sentence in sentences(changed))


@pytest.mark.parametrize(
    ("values", "renamed"),
    [
        ("h_min: 1\nh_max: 255\ns_min: 90\ns_max: 255\n", False),
        ("h_min: 160\nh_max: 255\ns_min: 90\ns_max: 255\n", True),
        ("h_min: 1\nh_max: 255\n", True),
    ],
)
def test_one_of_several_new_groups_is_no_renamed_one(repository, compare, values, renamed):
    path = "a/config/a.yaml"
    repository.commit({"a/package.xml": PACKAGE_XML.replace("arm_description", "a"), path: "r_min: 160\nr_max: 255\n"})
    repository.write({path: values})
    found = [line for line in sentences(subject(compare(repository), path)) if "renamed" in line]
    assert found == (["r_min renamed to h_min"] if renamed else [])


def test_parts_with_equal_values_are_one_line(review_changes):
    limits = "".join(f"  joint_{number}: {{has_limit: true, velocity: 0.5}}\n" for number in range(3))
    old = "limits:\n  own: {has_limit: true, velocity: 1.0}\n"
    found, _ = review_changes(old, f"{old}{limits}")
    assert sentences(found) == ["limits.joint_0 added: has_limit true, velocity 0.5"]
    assert found.changes[0].other_names == ("limits.joint_1", "limits.joint_2")


def test_item_whose_name_gains_a_part_wins_over_an_earlier_one_with_equal_contents(review_changes):
    item = "  - {{name: {}, type: T2, size: [{}, 0.1, 0.2], turn: [0, 90, 0]}}\n"
    old = "motors:\n" + item.format("right", 1) + item.format("left", 2)
    added = [item.format(name, number) for number, name in enumerate(("right_a", "right_b", "left_a", "left_b"), 3)]
    found, _ = review_changes(old, "motors:\n" + "".join(added))
    assert sentences(found)[0] == "motors[right] renamed to motors[right_a]"
    assert found.changes[0].other_names == ("motors[left] -> motors[left_a]",)
