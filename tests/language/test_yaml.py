"""Incomplete parameter files and RViz configurations. A ``|`` in a text marks the cursor."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.language.format import Document
from linkwright.language.formats import format_of
from linkwright.language.parameter_catalog import node_names, node_parameters, plugins
from linkwright.language.parameter_files import PARAMETER_FILES
from linkwright.language.rviz_files import RVIZ_FILES
from linkwright.language.workspace import Workspace
from linkwright.language.yaml_outline import YamlOutline, YamlPosition

ROBOT = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="wheel" params="side">
    <link name="${side}_wheel"/>
    <joint name="${side}_wheel_joint" type="continuous">
      <parent link="base_link"/><child link="${side}_wheel"/>
    </joint>
  </xacro:macro>
  <link name="base_link"/>
  <xacro:wheel side="left"/>
  <xacro:wheel side="right"/>
</robot>
"""
MANIFEST = "<package format='3'><name>r_bringup</name><version>1.0.0</version></package>"
MANAGER = """controller_manager:
  ros__parameters:
    update_rate: 100
    drive:
      type: diff_drive_controller/DiffDriveController
    arm:
      type: joint_trajectory_controller/JointTrajectoryController
"""
DRIVE = MANAGER + "drive:\n  ros__parameters:\n    "
ARM = MANAGER + "arm:\n  ros__parameters:\n    joints:\n    - left_wheel_joint\n    - x\n    "
MPPI = "controller_server:\n  ros__parameters:\n    F:\n      plugin: nav2_mppi_controller::MPPI|Controller\n"
COSTMAP = """local_costmap:
  local_costmap:
    ros__parameters:
      plugins: [obstacle_layer, inflation_layer]
      inflation_layer:
        plugin: "nav2_costmap_2d::InflationLayer"
"""
RVIZ = """Visualization Manager:
  Displays:
    - Alpha: 0.5
      Class: rviz_default_plugins/Grid
      Name: Grid
"""
OPTIONS = "  Global Options:\n    Fixed Frame: "


class Typing:
    """Texts in a package with a robot."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        (folder / "package.xml").write_text(MANIFEST)
        (folder / "r.urdf.xacro").write_text(ROBOT)
        self.workspace = Workspace([folder])
        self.workspace.index.refresh()

    def document(self, marked: str, name: str) -> tuple[Document, int]:
        offset = marked.index("|")
        text = marked.replace("|", "", 1)
        return Document(self.workspace, {}, self.folder / name, text), offset

    def labels(self, marked: str, name: str = "a.yaml") -> list[str]:
        document, offset = self.document(marked, name)
        return [item.label for item in format_of(document.file).complete(document, offset)]

    def explained(self, marked: str, name: str = "a.yaml") -> str:
        document, offset = self.document(marked, name)
        explanation = format_of(document.file).explain(document, offset)
        return "" if explanation is None else str(explanation.text)

    def targets(self, marked: str, name: str = "a.yaml") -> list[tuple[str, str]]:
        document, offset = self.document(marked, name)
        definitions = [*format_of(document.file).define(document, offset)]
        texts = [
            document.text if target.file == document.file else document.other(target.file) for target in definitions
        ]
        return [
            (target.file.name, text[target.start : target.end]) for target, text in zip(definitions, texts, strict=True)
        ]


@pytest.fixture
def typing(tmp_path: Path) -> Typing:
    return Typing(tmp_path.resolve())


@pytest.mark.parametrize(
    ("marked", "place", "path", "typed"),
    [
        ("a:\n  b|", YamlPosition.KEY, ("a",), "b"),
        ("a:\n  b:\n    c: 1\n  |", YamlPosition.KEY, ("a",), ""),
        ("a:\n  b: fo|o", YamlPosition.VALUE, ("a", "b"), "fo"),
        ("a:\n  b: [x,\n   y|]\n", YamlPosition.VALUE, ("a", "b"), "y"),
        ("a:\n  - 'x|", YamlPosition.VALUE, ("a",), "x"),
        ("a:\n- x: |", YamlPosition.VALUE, ("a", "x"), ""),
        ("a: {b: 1, c|: 2}", YamlPosition.KEY, ("a",), "c"),
        ("a: 1 # b|", YamlPosition.NOTHING, (), ""),
        ("a: |\n  b", YamlPosition.VALUE, ("a",), ""),
    ],
)
def test_cursor_position_is_found_by_indentation(marked, place, path, typed):
    cursor = YamlOutline(marked.replace("|", "", 1)).cursor(marked.index("|"))
    assert (cursor.position, cursor.parent_entry.path, cursor.typed) == (place, path, typed)


@pytest.mark.parametrize(
    ("marked", "expected"),
    [
        ("am|", "amcl"),
        ("amcl:\n  |", "ros__parameters"),
        ("local_costmap:\n  |", "local_costmap"),
        ("amcl:\n  ros__parameters:\n    base|", "base_frame_id"),
        ("amcl:\n  ros__parameters:\n    initial_pose:\n      y|", "y"),
        ("amcl:\n  ros__parameters:\n    initial_pose.ya|", "initial_pose.yaw"),
        (MANAGER + "    joint_st|", "joint_state_broadcaster"),
        (MANAGER + "    broad:\n      ty|", "type"),
        (MANAGER + "    diff:\n      type: |", "diff_drive_controller/DiffDriveController"),
        (MANAGER + "dr|", "drive"),
        (DRIVE + "wheel_sep|", "wheel_separation"),
        (DRIVE + "left_wheel_names: [|]", "left_wheel_joint"),
        (DRIVE + "base_frame_id: |", "base_link"),
        (DRIVE + "open_loop: t|", "true"),
        (DRIVE + "linear.x.max_v|", "linear.x.max_velocity"),
        (DRIVE + "linear:\n      x:\n        max_v|", "max_velocity"),
        (ARM + "gains:\n      |", "left_wheel_joint"),
        (ARM + "gains:\n      x: {|}", "p"),
        (ARM + "command_interfaces: [vel|]", "velocity"),
        (ARM + "interpolation_method: n|", "none"),
        (COSTMAP + "        cost|", "cost_scaling_factor"),
        (COSTMAP + "      obstacle_layer:\n        plugin: |", "nav2_costmap_2d::ObstacleLayer"),
        ("controller_server:\n  ros__parameters:\n    FollowPath:\n      plugin: |", "dwb_core/DWBLocalPlanner"),
        ("ekf_filter_node:\n  ros__parameters:\n    odom0_c|", "odom0_config"),
        ("/**:\n  ros__parameters:\n    |", "use_sim_time"),
    ],
)
def test_first_completion_in_parameter_file(typing, marked, expected):
    assert typing.labels(marked)[0] == expected


def test_existing_keys_and_values_are_not_offered(typing):
    assert "update_rate" not in typing.labels(MANAGER + "    |")
    assert typing.labels(DRIVE + "left_wheel_names: [left_wheel_joint, |]")[0] == "right_wheel_joint"


def test_unrelated_yaml_file_has_no_node_completion(typing):
    assert not typing.labels("joint_limits:\n  a: 1\n|")


def test_yaml_launch_file_is_not_a_parameter_file():
    assert not PARAMETER_FILES.covers(Path("a.launch.yaml"))
    assert format_of(Path("a.rviz")) is RVIZ_FILES


@pytest.mark.parametrize(
    ("marked", "words"),
    [
        ("am|cl:\n  ros__parameters:\n", ("amcl", "base_frame_id")),
        ("amcl:\n  ros__parameters:\n    base_frame|_id: a", ("base_frame_id", "string", "base_footprint")),
        (MANAGER.replace("arm", "a|rm"), ("joint_trajectory_controller/JointTrajectoryController",)),
        (DRIVE + "wheel_rad|ius: 1.0", ("wheel_radius", "double", "m")),
        (DRIVE + "left_wheel_names: [left|_wheel_joint]", ("joint left_wheel_joint", "continuous", "base_link")),
        (ARM + "gains:\n      x:\n        p|: 1", ("gains.x.p", "double")),
        (COSTMAP.replace("radius", "").replace("::Infl", "::In|fl"), ("inflation_radius", "local_costmap")),
        (COSTMAP + "        inflation_rad|ius: 1.0", ("inflation_layer.inflation_radius", "0.55", "meters")),
        (MPPI, ("plugin of controller_server: follows a path by model predictive path integral control",)),
    ],
)
def test_hover_in_parameter_file(typing, marked, words):
    text = typing.explained(marked)
    assert all(word in text for word in words), text


@pytest.mark.parametrize(
    ("marked", "target"),
    [
        (DRIVE + "left_wheel_names: [left|_wheel_joint]", ("r.urdf.xacro", "${side}_wheel_joint")),
        (DRIVE + "base_frame_id: base|_link", ("r.urdf.xacro", "base_link")),
        (MANAGER + "dri|ve:\n  ros__parameters:\n", ("a.yaml", "drive")),
        (COSTMAP.replace("inflation_layer]", "infl|ation_layer]"), ("a.yaml", "inflation_layer")),
    ],
)
def test_definitions_in_parameter_file(typing, marked, target):
    assert typing.targets(marked) == [target]


def test_plugin_library_in_list_has_no_definition(typing):
    assert not typing.targets("bt_navigator:\n  ros__parameters:\n    plugin_lib_names:\n    - a|_node\n    - b_node\n")


@pytest.mark.parametrize(
    ("marked", "expected"),
    [
        (RVIZ + "    - |", "Class"),
        (RVIZ + "    - Class: |", "rviz_default_plugins/RobotModel"),
        (RVIZ + "    - Class: rviz_default_plugins/La|", "rviz_default_plugins/LaserScan"),
        (RVIZ + "      Cell|", "Cell Size"),
        (RVIZ + "      Plane: |", "XY"),
        (RVIZ + "      Reference Frame: ba|", "base_link"),
        (RVIZ + "    - Class: rviz_default_plugins/LaserScan\n      Topic:\n        Reli|", "Reliability Policy"),
        (RVIZ + OPTIONS + "|", "base_link"),
        (RVIZ + "  Views:\n    Current:\n      Class: |", "rviz_default_plugins/Orbit"),
        (RVIZ + "  Views:\n    Current:\n      Class: rviz_default_plugins/Orbit\n      Dis|", "Distance"),
        (RVIZ + "  Tools:\n    - Class: rviz_default_plugins/SetI|", "rviz_default_plugins/SetInitialPose"),
    ],
)
def test_first_completion_in_rviz_file(typing, marked, expected):
    assert typing.labels(marked, "a.rviz")[0] == expected


def test_hover_and_definitions_in_rviz_file(typing):
    assert "Opacity" in typing.explained(RVIZ.replace("Alpha", "Al|pha"), "a.rviz")
    assert "Cell Size" in typing.explained(RVIZ.replace("/Grid", "/Gr|id"), "a.rviz")
    assert "link base_link" in typing.explained(RVIZ + OPTIONS + "base|_link", "a.rviz")
    assert typing.targets(RVIZ + OPTIONS + "base|_link", "a.rviz") == [("r.urdf.xacro", "base_link")]


def test_symbols_are_keys(typing):
    document, _ = typing.document(MANAGER + "|", "a.yaml")
    (manager,) = PARAMETER_FILES.symbols(document)
    assert manager.name == "controller_manager"
    assert [child.name for child in manager.children[0].children] == ["update_rate", "drive", "arm"]


def test_parameters_of_own_nodes_are_read_from_sources(typing):
    source = "class A(Node):\n    def __init__(self):\n        super().__init__('finder')\n"
    declared = "        self.declare_parameter('size', 0.5)\n        self.declare_parameter('is_on', True)\n"
    (typing.folder / "finder.py").write_text(source + declared)
    (typing.folder / "other.cpp").write_text('declare_parameter<int>("speed", 3); Node("other")')
    text = "finder:\n  ros__parameters:\n    "
    assert typing.labels(text + "|")[:2] == ["size", "is_on"]
    assert "speed" not in typing.labels(text + "|")
    assert typing.labels(text + "is_on: |") == ["true", "false"]
    assert "double" in typing.explained(text + "si|ze: 1.0")
    assert typing.targets(text + "si|ze: 1.0") == [("finder.py", "size")]


def test_completion_follows_open_description(typing):
    file = typing.folder / "r.urdf.xacro"
    text = "base_frame_id: |"
    document, offset = typing.document(DRIVE + text, "a.yaml")
    assert "trunk" not in typing.labels(DRIVE + text)
    changed = Document(typing.workspace, {file: ROBOT.replace("base_link", "trunk")}, document.file, document.text)
    assert "trunk" in [item.label for item in PARAMETER_FILES.complete(changed, offset)]


def test_catalog_contains_nodes_and_plugins_with_types():
    assert {"amcl", "slam_toolbox", "ekf_filter_node", "robot_state_publisher", "map_server"} <= set(node_names())
    assert all(parameter.name for node in node_names() for parameter in node_parameters(node))
    assert plugins()["nav2_costmap_2d/VoxelLayer"].list_parameter == "plugins"
