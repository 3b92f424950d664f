"""Breaking changes of the parameters of controllers and bridges, and their wording."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "a/config/c.yaml"
CONTROLLERS = """controller_manager:
  ros__parameters:
    arm:
      type: joint_trajectory_controller/JointTrajectoryController
    base:
      type: diff_drive_controller/DiffDriveController
arm:
  ros__parameters:
    joints: [upper, lower]
    command_interfaces: [position]
base:
  ros__parameters:
    wheel_separation: 0.4
    wheel_radius: 0.1
    base_frame_id: base_link
    use_stamped_vel: false
executor:
  ros__parameters:
    joint_names: [upper, lower]
"""
BRIDGES = """- ros_topic_name: /scan
  gz_topic_name: /lidar
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  direction: GZ_TO_ROS
- topic_name: /clock
  ros_type_name: rosgraph_msgs/msg/Clock
  gz_type_name: gz.msgs.Clock
"""


@pytest.fixture
def review_changes(repository, compare):
    def run(text: str, changed: str):
        assert text != changed
        repository.commit({"a/package.xml": PACKAGE_XML, PATH: text})
        repository.write({PATH: changed})
        result = compare(repository)
        return sentences(subject(result, PATH)), breaking(result)

    return run


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("joint_trajectory_controller/JointTrajectoryController", "a/B",
         "controller_manager.ros__parameters.arm.type joint_trajectory_controller/JointTrajectoryController -> a/B",
         True),
        ("[position]", "[velocity]", "arm.ros__parameters.command_interfaces [position] -> [velocity]", False),
        ("    joints: [upper, lower]", "    joints: [upper, tool]",
         "arm.ros__parameters.joints [upper, lower] -> [upper, tool]", True),
        ("joint_names: [upper, lower]", "joint_names: [upper]",
         "executor.ros__parameters.joint_names [upper, lower] -> [upper]", False),
    ],
)  # fmt: skip
def test_names_that_controllers_offer_are_breaking(review_changes, old, new, expected, is_breaking):
    changes, found_breaking = review_changes(CONTROLLERS, CONTROLLERS.replace(old, new))
    assert changes == [expected]
    assert bool(found_breaking) is is_breaking


FILTERS = """local_filter:
  ros__parameters: {odom_frame: odom, base_link_frame: base_link, world_frame: odom}
global_filter:
  ros__parameters: {map_frame: map, odom_frame: odom, base_link_frame: base_link, world_frame: map}
costmap:
  ros__parameters: {global_frame: map}
"""
LOST = "the filter no longer publishes the transform of the frame '{}'"


@pytest.mark.parametrize(
    ("old", "new", "reasons"),
    [
        ("world_frame: map", "world_frame: earth", [LOST.format("map")]),
        ("odom}", "map}", []),
        (": odom", ": wheels", [LOST.format("odom")]),
        ("world_frame: map", "publish_tf: false, world_frame: earth", []),
        ("costmap:\n  ros__parameters: {global_frame: map}", "costmap:\n  ros__parameters: {global_frame: odom}", []),
    ],
)
def test_frames_that_a_filter_no_longer_publishes(repository, compare, old, new, reasons):
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: FILTERS})
    repository.write({PATH: FILTERS.replace(old, new)})
    assert [str(change.reason) for _, change in compare(repository).breaking_changes] == reasons


@pytest.mark.parametrize(
    ("text", "reasons"),
    [
        ("odom_frame: odom\nbase_link_frame: base_link\nworld_frame: odom\n", [LOST.format("odom")]),
        ("base_link_frame: base_link\nworld_frame: odom\n", []),
    ],
)
def test_frame_of_a_filter_of_ros1_whose_file_has_no_node_name(repository, compare, text, reasons):
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: text})
    repository.write({PATH: text.replace(": odom", ": wheels")})
    assert [str(change.reason) for _, change in compare(repository).breaking_changes] == reasons


def test_node_that_claims_interfaces_is_a_controller(review_changes):
    start = CONTROLLERS.index("arm:\n  ros__parameters:\n    joints")
    text = CONTROLLERS[start:]
    _, found = review_changes(text, text.replace("joints: [upper, lower]", "joints: [upper]"))
    assert found == ["arm.ros__parameters.joints [upper, lower] -> [upper]"]


def test_renamed_controller_is_compared_with_the_old_one(review_changes):
    text = CONTROLLERS.replace("    base:\n", "    drive:\n").replace("\nbase:\n", "\ndrive:\n").replace("0.4", "0.5")
    changes, found_breaking = review_changes(CONTROLLERS, text)
    assert changes == [
        "base renamed to drive",
        "drive.ros__parameters.wheel_separation 0.4 -> 0.5",
        "controller_manager.ros__parameters.drive.type diff_drive_controller/DiffDriveController added",
        "controller_manager.ros__parameters.base.type diff_drive_controller/DiffDriveController removed",
    ]
    assert found_breaking == changes[3:]


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("ros_topic_name: /scan", "ros_topic_name: /laser/scan", "bridge '/scan' renamed to '/laser/scan'", True),
        ("ros_topic_name: /scan", "ros_topic_name: scan", "bridge '/scan' renamed to 'scan'", False),
        ("msg/LaserScan", "msg/PointCloud2",
         "bridge '/scan': ros_type_name sensor_msgs/msg/LaserScan -> sensor_msgs/msg/PointCloud2", True),
        ("/msg/LaserScan", "/LaserScan",
         "bridge '/scan': ros_type_name sensor_msgs/msg/LaserScan -> sensor_msgs/LaserScan", False),
        ("GZ_TO_ROS", "BIDIRECTIONAL", "bridge '/scan': direction GZ_TO_ROS -> BIDIRECTIONAL", False),
        ("GZ_TO_ROS", "ROS_TO_GZ", "bridge '/scan': direction GZ_TO_ROS -> ROS_TO_GZ", True),
        ("/lidar", "/lidar2", "bridge '/scan': gz_topic_name /lidar -> /lidar2", False),
        (BRIDGES[BRIDGES.index("- topic_name") :], "",
         "bridge '/clock' removed: ros_type_name rosgraph_msgs/msg/Clock, gz_type_name gz.msgs.Clock", True),
        ("- topic_name", "- topic_name: /tf\n  gz_topic_name: /pose\n  direction: GZ_TO_ROS\n- topic_name",
         "bridge '/tf' added: gz_topic_name /pose, direction GZ_TO_ROS", False),
    ],
)  # fmt: skip
def test_bridges_are_compared_by_topic(review_changes, old, new, expected, is_breaking):
    changes, found_breaking = review_changes(BRIDGES, BRIDGES.replace(old, new))
    assert changes == [expected]
    assert bool(found_breaking) is is_breaking


@pytest.mark.parametrize(
    ("old", "new", "first", "others", "is_breaking"),
    [
        ("ros_topic_name: /", "ros_topic_name: ", "bridge '/left' renamed to 'left'", ("/right -> right",), False),
        ("ros_topic_name: /", "ros_topic_name: /arm/", "bridge '/left' renamed to '/arm/left'",
         ("/right -> /arm/right",), True),
        ("/yard/", "/hall/", "bridge '/left': gz_topic_name /yard/left -> /hall/left", ("/right",), False),
    ],
)  # fmt: skip
def test_topics_of_bridges_that_are_edited_alike_are_one_line(
    repository, compare, old, new, first, others, is_breaking
):
    bridge = "- ros_topic_name: /{0}\n  gz_topic_name: /yard/{0}\n  ros_type_name: std_msgs/msg/Bool\n"
    text = bridge.format("left") + bridge.format("right")
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: text})
    repository.write({PATH: text.replace(old, new)})
    (change,) = compare(repository).subjects[0].changes
    assert (str(change.sentence), change.other_names) == (first, others)
    assert (change.reason is not None) is is_breaking


def test_topics_of_bridges_that_are_edited_otherwise_have_a_line_each(repository, compare):
    text = "- ros_topic_name: /left\n  gz_topic_name: /a\n- ros_topic_name: /right\n  gz_topic_name: /b\n"
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: text})
    repository.write({PATH: text.replace("/a", "/c").replace("/b", "/d")})
    found = [str(change.sentence) for change in compare(repository).subjects[0].changes]
    assert found == ["bridge '/left': gz_topic_name /a -> /c", "bridge '/right': gz_topic_name /b -> /d"]


SETTINGS = "a: null\nb: ~\nc:\nd: ''\ne: 1\nf: [null, 1]\n"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("b: ~", "b: ''", ["b null -> ''"]),
        ("c:\n", "c: 2\n", ["c null -> 2"]),
        ("c:\n", "", ["c null removed"]),
        ("d: ''", "d: ~", ["d '' -> null"]),
        ("f: [null, 1]", "f: [1]", ["f [null, 1] -> [1]"]),
    ],
)
def test_null_is_shown_as_null(review_changes, old, new, expected):
    assert review_changes(SETTINGS, SETTINGS.replace(old, new))[0] == expected


def test_other_writing_of_null_is_no_change(repository, compare):
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: SETTINGS})
    repository.write({PATH: SETTINGS.replace("b: ~", "b:")})
    assert compare(repository).subjects == []


NODES = """planner_server:
  ros__parameters:
    planner_plugins: [GridBased, Smooth]
    plugins: [GridBased, Smooth]
    rate: 10
    scale: 1.0
    use_map: true
    names: ["a", "b"]
local_costmap:
  ros__parameters:
    base: base_footprint
    size: 3
global_costmap:
  ros__parameters:
    base: base_footprint
    size: 3
"""


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("rate: 10", "rate: 10.0", ["planner_server.ros__parameters.rate 10 -> 10.0"], True),
        ("rate: 10", "rate: 12", ["planner_server.ros__parameters.rate 10 -> 12"], False),
        ("true", '"true"', ['planner_server.ros__parameters.use_map true -> "true"'], True),
        ("    plugins: [GridBased, Smooth]", "    plugins: [GridBased]",
         ["planner_server.ros__parameters.plugins [GridBased, Smooth] -> [GridBased]"], True),
        ("base: base_footprint", "base: base_link",
         ["local_costmap.ros__parameters.base base_footprint -> base_link"], False),
        (NODES[NODES.index("global"):], "", ["global_costmap removed: base base_footprint, size 3"], True),
    ],
)  # fmt: skip
def test_types_and_nodes_of_parameters_are_compared(review_changes, old, new, expected, is_breaking):
    found, found_breaking = review_changes(NODES, NODES.replace(old, new))
    assert found == expected
    assert bool(found_breaking) is is_breaking


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("scale: 1.0", "scale: 1.00"),
        ("scale: 1.0", "scale: 1.0000000001"),
        ('["a", "b"]', "[a, b]"),
        ("use_map: true", "use_map: True"),
        ("[a", "[ a"),
    ],
)
def test_another_writing_of_a_parameter_is_not_reported(repository, compare, old, new):
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: NODES})
    repository.write({PATH: NODES.replace(old, new)})
    assert compare(repository).subjects == []


@pytest.mark.parametrize(
    ("old", "new", "is_same"),
    [
        ("0.3", "0.30000001192092896", True),
        ("0.009999999776482582", "0.01", True),
        ("0.3", "0.30000002", False),
        ("48.13713580", "48.13713590", False),
    ],
)
def test_number_of_32_bits_written_in_full_is_the_same(repository, compare, old, new, is_same):
    texts = [NODES.replace("scale: 1.0", f"scale: {value}") for value in (old, new)]
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: texts[0]})
    repository.write({PATH: texts[1]})
    assert (compare(repository).subjects == []) is is_same


def test_equal_changes_of_a_parameter_are_one_line(repository, compare):
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: NODES})
    repository.write({PATH: NODES.replace("size: 3", "size: 5")})
    (change,) = subject(compare(repository), PATH).changes
    assert change.other_names == ("global_costmap.ros__parameters.size",)


POINTS = "vertices:\n" + "".join(f"  - [{n}.0, 0.0, {{kind: [1, p{n}]}}]\n" for n in range(20))


def test_inserted_item_of_a_list_does_not_shift_the_others(review_changes):
    text = POINTS.replace("  - [3.0", "  - [7.5, 1.0, {kind: [1, q]}]\n  - [3.0")
    found, _ = review_changes(POINTS, text)
    assert found == ["vertices[3] added: [0] 7.5, [1] 1.0, [2].kind [1, q]"]


def test_many_changes_of_a_list_are_one_line(review_changes):
    found, _ = review_changes(POINTS, POINTS.replace("0.0,", "2.0,"))
    assert found[0].startswith("list vertices: 22 values changed: [0][0] 0.0 -> 2.0; ")


LAYERS = """costmap:
  ros__parameters:
    plugins: [voxels]
    voxels:
      height: 2.0
      size: 16
      source: scan
"""


def test_renamed_plugin_is_compared_with_the_old_one(review_changes):
    found, found_breaking = review_changes(LAYERS, LAYERS.replace("voxels", "cubes").replace("16", "10"))
    part = "costmap.ros__parameters"
    renamed = f"{part}.voxels renamed to {part}.cubes"
    assert found == [renamed, f"{part}.plugins [voxels] -> [cubes]", f"{part}.cubes.size 16 -> 10"]
    assert found_breaking == found[1:2]


FRAMES = """odometry:
  ros__parameters: {frame_id: map, tf.send: true}
pose:
  ros__parameters: {frame_id: map}
"""


def test_frame_that_others_still_offer_and_transform_that_is_switched_off(review_changes):
    text = FRAMES.replace("{frame_id: map, tf", "{frame_id: odom, tf")
    changes, found_breaking = review_changes(FRAMES, text.replace("send: true", "send: false"))
    assert "odometry.ros__parameters.frame_id map -> odom" in changes
    assert found_breaking == ["odometry.ros__parameters.tf.send true -> false"]


@pytest.mark.parametrize(("node", "is_breaking"), [("head_client", False), ("clients_view", True), ("head", True)])
def test_frame_of_a_client_is_only_used(review_changes, node, is_breaking):
    text = f"{node}:\n  ros__parameters: {{frame_id: left/base}}\n"
    _, found = review_changes(text, text.replace("left/base", "base"))
    assert bool(found) is is_breaking


def test_frame_in_a_file_of_a_client_is_only_used(repository, compare):
    path = "a/config/head_client.yaml"
    repository.commit({"a/package.xml": PACKAGE_XML, path: "frame_id: left/base\n"})
    repository.write({path: "frame_id: base\n"})
    assert breaking(compare(repository)) == []


def test_long_list_of_names_has_the_added_and_removed_ones(review_changes):
    names = [f"left_gripper_inner_finger_joint_{number}" for number in range(8)]
    text = "hand: {joints: [finger_joint, old_joint]}\n"
    found, _ = review_changes(text, text.replace("old_joint", ", ".join(names)))
    assert found == [f"hand.joints: {', '.join(names)} added, old_joint removed"]


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("arm:\n  shoulder_controller:\n    type: TYPE\n    joint: shoulder\n", "arm/shoulder_controller"),
        ("shoulder:\n  ros__parameters:\n    type: TYPE\n    joints: [shoulder]\n", "shoulder"),
    ],
)
def test_another_type_of_a_controller_is_breaking(repository, compare, text, name):
    old, new = "velocity_controllers/JointPositionController", "effort_controllers/JointPositionController"
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: text.replace("TYPE", old)})
    repository.write({PATH: text.replace("TYPE", new)})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.reason) == (
        f"the controller '{name}' has the type '{new}' instead of '{old}', with other topics and interfaces"
    )


def test_another_type_of_something_else_is_not_breaking(review_changes):
    text = "filters:\n  - name: a\n    type: laser_filters/A\nmap:\n  type: costmap_2d/Static\n"
    assert review_changes(text, text.replace("Static", "Layer")) == (
        ["map.type costmap_2d/Static -> costmap_2d/Layer"],
        [],
    )


def test_list_without_names_has_the_smallest_edit_with_its_values(review_changes):
    def steps(*values: str) -> str:
        moves = [
            f"  - action: move\n    target: {{x: 0.0, y: {y}, turn: {turn}}}\n" for y, turn in map(str.split, values)
        ]
        return "actions:\n" + "  - action: grasp\n".join(moves)

    old, new = steps("0.0 -60", "-0.1 -60", "0.0 60", "-0.1 60", "0.0 -60"), steps("-0.2 -60", "-0.2 60", "-0.2 -60")
    found, _ = review_changes(old, new)
    assert found == [
        (
            "list actions: 3 values changed, 4 parts removed: [0, 2, 4].target.y 0.0 -> -0.2; "
            "[old 2] removed: action move, target.x 0.0, target.y -0.1, target.turn -60; "
            "[old 3].action grasp removed; [old 6] removed: action move, target.x 0.0, target.y -0.1, target.turn 60; "
            "[old 7].action grasp removed"
        )
    ]


def test_equal_changes_of_list_items_are_told_once(review_changes):
    lasers = "lasers:\n" + "".join(f"  - {{id: {n}, two_pt: false}}\n" for n in range(12))
    found, _ = review_changes(lasers, lasers.replace("two_pt: false", "two_pt: true"))
    assert found == ["list lasers: 12 values changed: [0..11].two_pt false -> true"]
    found, _ = review_changes(
        lasers, lasers.replace("id: 3, two_pt: false", "id: 3, two_pt: 5").replace("false", "true")
    )
    assert found == ["list lasers: 12 values changed: [0..2, 4..11].two_pt false -> true; [3].two_pt false -> 5"]


def test_components_of_a_vector_are_one_line(review_changes):
    found, _ = review_changes(
        "link:\n  cog:\n    x: 0.0\n    y: 0.1\n    z: 2\n  speed: 1\n",
        "link:\n  cog:\n    x: 0.5\n    y: 0.2\n    z: 2\n  speed: 3\n",
    )
    assert found == ["link.cog: x 0.0 -> 0.5, y 0.1 -> 0.2", "link.speed 1 -> 3"]


@pytest.mark.parametrize(
    ("text", "is_breaking"),
    [
        ("odom_frame: a/odom\nodom_child_frame: base\n", True),
        ("odom_frame: a/odom\nbase_frame: base\n", False),
        ("base: {wheel_odom_map_frame: a/odom}\n", True),
    ],
)
def test_a_frame_of_the_odometry_that_the_node_publishes(repository, compare, text, is_breaking):
    path = "arm/config/odometry.yaml"
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), path: text})
    repository.write({path: text.replace("a/odom", "odom")})
    assert bool(compare(repository).breaking_changes) is is_breaking


SERVERS = "controller_server:\n  ros__parameters:\n    goal_checker_plugins: {checkers}\n    rate: {rate}\n"


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        ({"checkers": "near", "rate": 10}, {"checkers": "[near]", "rate": 10}, False),
        ({"checkers": "[near]", "rate": 10}, {"checkers": "near", "rate": 10}, True),
        ({"checkers": "[near]", "rate": 10}, {"checkers": "[near]", "rate": "[10]"}, True),
    ],
)
def test_list_of_plugins_that_was_a_text_breaks_nobody(review_changes, old, new, is_breaking):
    found, found_breaking = review_changes(SERVERS.format(**old), SERVERS.format(**new))
    assert found
    assert bool(found_breaking) is is_breaking


@pytest.mark.parametrize(
    ("old", "value", "is_breaking"),
    [
        (True, "enable_stamped_cmd_vel: true", True),
        (True, "enable_stamped_cmd_vel: false", False),
        (False, "enable_stamped_cmd_vel: true", False),
        (True, "publish_stamped_twist: true", True),
        (True, "use_stamped_vel: true", False),
        (True, "use_stamped_vel: false", True),
    ],
)
def test_velocity_commands_of_a_node_that_newly_have_a_header_are_breaking(review_changes, old, value, is_breaking):
    other = "docking_server:\n  ros__parameters:\n    rate: 5\n"
    text = SERVERS.format(checkers="[near]", rate=10)
    new = f"{other}{text}    {value}\n"
    found, found_breaking = review_changes(other + text if old else other, new)
    assert found
    assert bool(found_breaking) is is_breaking
    if old:
        assert bool(review_changes(new, other + text)[1]) is is_breaking


def test_a_type_of_a_controller_that_no_package_has_is_repaired(review_changes):
    text = "controller_manager:\n  ros__parameters:\n    base:\n      type: {}/OmniController\n"
    for package, is_breaking in (("ros2_controllers", False), ("omni_controllers", True)):
        found, found_breaking = review_changes(text.format(package), text.format("omni_controller"))
        assert found
        assert bool(found_breaking) is is_breaking


ROS1_BASE = """base_control:
  type: lamp_controllers/OmniController
  odom_topic: base_control/odom
  twist_mux_topic: cmd
planner:
  odom_topic: odom
"""


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        ("base_control/odom", "lamp/odom", True),
        ("topic: cmd", "topic: command", False),
        ("topic: odom", "topic: lamp/odom", False),
        ("type: lamp_controllers/OmniController\n  odom_topic: base_control/odom", "odom_topic: odom", True),
    ],
)
def test_topic_of_a_controller_of_ros_1_is_breaking(review_changes, old, new, is_breaking):
    _, found_breaking = review_changes(ROS1_BASE, ROS1_BASE.replace(old, new))
    assert bool(found_breaking) is is_breaking


@pytest.mark.parametrize(
    ("new_class", "start"),
    [("Slow", "controller_manager.ros__parameters.hand.type lamp/Fast -> lamp/Slow"), ("Fast", "hand removed")],
)
def test_parameters_of_a_controller_with_another_class_are_told_with_it(repository, compare, new_class, start):
    manager = "controller_manager:\n  ros__parameters:\n    hand: {type: lamp/Fast}\n    arm: {type: lamp/Arm}\n"
    repository.commit({"lamp.yaml": f"{manager}hand:\n  ros__parameters: {{rate: 1, size: 2}}\n"})
    repository.write({"lamp.yaml": manager.replace("lamp/Fast", f"lamp/{new_class}")})
    (line,) = breaking(compare(repository))
    assert line.startswith(start)


CRITICS = """controller_server:
  ros__parameters:
    controller_plugins: [Follow]
    Follow:
      critics: [GoalCritic, Heading]
      GoalCritic: {weight: 5.0, power: 1}
      Heading: {scale: 2.0, power: 1}
      SpeedCritic: {weight: 1.0, power: 1}
      Limits: {radius: 0.2, speed: 1.0}
"""


@pytest.mark.parametrize(
    ("lost", "remaining", "is_breaking"),
    [
        ("Heading: {scale: 2.0, power: 1}", "[GoalCritic]", False),
        ("Heading: {scale: 2.0, power: 1}", "[GoalCritic, Heading]", True),
        ("SpeedCritic: {weight: 1.0, power: 1}", "[GoalCritic, Heading]", False),
        ("SpeedCritic: {weight: 1.0, power: 1}", "[GoalCritic, Heading, SpeedCritic]", True),
        ("Limits: {radius: 0.2, speed: 1.0}", "[GoalCritic]", True),
    ],
)
def test_controller_reads_no_parameters_of_a_critic_that_it_does_not_list(review_changes, lost, remaining, is_breaking):
    new = CRITICS.replace(f"      {lost}\n", "").replace("[GoalCritic, Heading]", remaining)
    _, breaking_lines = review_changes(CRITICS, new)
    name = lost.partition(":")[0]
    assert [f"Follow.{name}" in line for line in breaking_lines] == [True] * is_breaking


REFUSED = """controller_manager:
  ros__parameters:
    update_rate: 50
hand_controller:
  type: position_controllers/JointPositionController
  joints: [finger]
state_controller:
  type: joint_state_controller/JointStateController
  rate: 50
"""


@pytest.mark.parametrize("is_refused", [True, False])
def test_file_that_ros2_refused_had_no_readers(review_changes, is_refused):
    old = REFUSED if is_refused else REFUSED.replace("  ros__parameters:\n    update_rate", "  update_rate")
    new = """controller_manager:
  ros__parameters:
    update_rate: 50
    hand_controller:
      type: position_controllers/JointGroupPositionController
hand_controller:
  ros__parameters:
    joints: [finger]
"""
    found, breaking_lines = review_changes(old, new)
    assert any(line.startswith("state_controller removed") for line in found)
    assert bool(breaking_lines) is not is_refused
