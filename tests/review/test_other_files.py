"""Changes of files other than descriptions in a review.

The tests cover launch files, worlds, parameters, interfaces, manifests, maps and meshes.
"""

from __future__ import annotations

import pytest

from linkwright.review.changes import MAX_NAMES
from linkwright.review.reports.text import as_text
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

LAUNCH = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

RATE = 10


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("use_sim_time", default_value="false"),
        DeclareLaunchArgument("model"),
        Node(package="arm", executable="driver", name="driver", parameters=[{"rate": RATE}],
             remappings=[("cmd", "arm/cmd")]),
        Node(package="arm", executable="camera", name="left"),
        Node(package="arm", executable="camera", name="right"),
    ])
"""
XML_LAUNCH = """<launch>
  <arg name="use_sim_time" default="false"/>
  <node pkg="arm" exec="driver" name="driver">
    <param name="rate" value="10"/>
    <remap from="cmd" to="arm/cmd"/>
  </node>
  <include file="$(find-pkg-share arm)/launch/other.launch.xml"><arg name="a" value="1"/></include>
</launch>
"""


@pytest.mark.parametrize(
    ("old", "new", "sentence", "is_breaking"),
    [
        ("RATE = 10", "RATE = 20", "node 'arm/driver': parameter rate 10 -> 20", False),
        ('"false"', '"true"', "argument 'use_sim_time': default false -> true", True),
        ('        DeclareLaunchArgument("model"),\n', "", "argument 'model' removed; the file did not use it", False),
        ('"use_sim_time", default_value="false"', '"use_sim_time"',
         "argument 'use_sim_time': default false removed", True),
        ('name="right"', 'name="rear"', "node 'arm/camera': name right -> rear", True),
        ('        Node(package="arm", executable="camera", name="left"),\n', "",
         "node 'arm/camera' removed: name left", True),
        ("    return Launch", "    print('starting')\n    return Launch",
         "other code added: print('starting')", False),
        ('"arm/cmd"', '"cmd_vel"', "node 'arm/driver': remapping cmd arm/cmd -> cmd_vel", True),
    ],
)  # fmt: skip
def test_python_launch_file_changes_are_reported(repository, compare, old, new, sentence, is_breaking):
    repository.commit({"arm/launch/arm.launch.py": LAUNCH})
    repository.write({"arm/launch/arm.launch.py": LAUNCH.replace(old, new)})
    result = compare(repository)
    assert sentence in sentences(subject(result, "arm/launch/arm.launch.py"))
    assert (sentence in breaking(result)) is is_breaking


def test_reformatted_launch_file_is_not_reported(repository, compare):
    repository.commit({"arm/launch/arm.launch.py": LAUNCH})
    text = LAUNCH.replace("RATE = 10", "RATE = (  # Hz\n    10\n)").replace('"', "'")
    repository.write({"arm/launch/arm.launch.py": text})
    assert compare(repository).subjects == []


TRANSFORMS = """from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(package="tf2_ros", executable="static_transform_publisher", arguments=["0", "0", "0", "base", "left"]),
        Node(package="tf2_ros", executable="static_transform_publisher", arguments=["1", "0", "0", "base", "right"]),
        Node(package="rviz2", executable="rviz2", name="rviz2"),
        Node(package="controller_manager", executable="ros2_control_node", remappings=[("/arm/cmd", "/cmd")]),
        Node(package="controller_manager", executable="spawner", arguments=["arm"]),
    ])
"""


LEFT = '["0", "0", "0", "base", "left"]'
ADDED = """    return LaunchDescription([
        Node(package="tf2_ros", executable="static_transform_publisher", arguments=["5", "0", "0", "base", "top"]),"""
RVIZ = '        Node(package="rviz2", executable="rviz2", name="rviz2"),\n'
SPAWNER = '["arm", "--controller-ros-args", "-r /arm/cmd:=/cmd"]'


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        (
            [(LEFT, LEFT.replace('"0", "base"', '"2", "base"')), ("    return LaunchDescription([", ADDED)],
            [
                "node 'tf2_ros/static_transform_publisher': arguments [0, 0, 0, base, left] -> [0, 0, 2, base, left]",
                "node 'tf2_ros/static_transform_publisher' added: arguments [5, 0, 0, base, top]",
            ],
        ),
        ([(RVIZ, "")], ["node 'rviz2/rviz2' removed: name rviz2"]),
        (
            [(', remappings=[("/arm/cmd", "/cmd")]', ""), ('["arm"]', SPAWNER)],
            [
                "node 'controller_manager/ros2_control_node': remapping /arm/cmd /cmd removed",
                (
                    "node 'controller_manager/spawner' of 'arm': "
                    "arguments [arm] -> [arm, --controller-ros-args, -r /arm/cmd:=/cmd]"
                ),
            ],
        ),
    ],
)
def test_similar_launch_nodes_are_matched(repository, compare, changes, expected):
    repository.commit({"arm/launch/arm.launch.py": TRANSFORMS})
    text = TRANSFORMS
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    repository.write({"arm/launch/arm.launch.py": text})
    result = compare(repository)
    assert sorted(sentences(subject(result, "arm/launch/arm.launch.py"))) == sorted(expected)
    assert breaking(result) == []


@pytest.mark.parametrize(
    ("old", "new", "sentence", "is_breaking"),
    [
        ('value="10"', 'value="20"', "node 'arm/driver': parameter rate 10 -> 20", False),
        ('to="arm/cmd"', 'to="cmd"', "node 'arm/driver': remapping cmd arm/cmd -> cmd", True),
        ('name="a" value="1"', 'name="a" value="2"',
         "include of '$(find-pkg-share arm)/launch/other.launch.xml': a 1 -> 2", False),
        ('name="driver">', 'name="driver" namespace="left">', "node 'arm/driver': namespace left added", True),
    ],
)  # fmt: skip
def test_xml_launch_file_changes_are_reported(repository, compare, old, new, sentence, is_breaking):
    repository.commit({"arm/launch/arm.launch.xml": XML_LAUNCH})
    repository.write({"arm/launch/arm.launch.xml": XML_LAUNCH.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, "arm/launch/arm.launch.xml")) == [sentence]
    assert (breaking(result) == [sentence]) is is_breaking


def test_launch_file_is_not_executed(repository, compare, tmp_path):
    repository.commit({"arm/launch/arm.launch.py": LAUNCH})
    attack = f"open({str(tmp_path / 'stolen')!r}, 'w')\n"
    repository.write({"arm/launch/arm.launch.py": attack + LAUNCH.replace("10", "20")})
    assert compare(repository).subjects
    assert not (tmp_path / "stolen").exists()


WORLD = """<sdf version="1.9">
  <world name="yard">
    <include><uri>model://tree</uri><pose>1 0 0 0 0 0</pose></include>
    <include><uri>model://rock</uri></include>
    <model name="box"><pose>0 0 1 0 0 0</pose><link name="link"/></model>
    <plugin name="p" filename="q"><topic>/a</topic></plugin>
  </world>
</sdf>
"""


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("0 0 1 0 0 0", "0 0 2 0 0 0", ["world yard model box pose: 0 0 1 0 0 0 -> 0 0 2 0 0 0 (moved by 1 m)"], False),
        ("    <include><uri>model://tree", "    <include><uri>model://bush</uri></include>\n    <include><uri>model://tree",
         ["world yard include model://bush added"], False),
        ("<topic>/a", "<topic>/b", ["world yard plugin p topic: /a -> /b"], True),
        ('name="yard"', 'name="park"', ["world yard renamed to 'park'"], True),
    ],
)  # fmt: skip
def test_world_changes_are_reported(repository, compare, old, new, expected, is_breaking):
    repository.commit({"w/worlds/yard.sdf": WORLD})
    repository.write({"w/worlds/yard.sdf": WORLD.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, "w/worlds/yard.sdf")) == expected
    assert bool(breaking(result)) is is_breaking


REMOVED_CONTROLLER = (
    "arm_controller removed: joints [upper, lower], frame_id base_link, odom_topic odom, use_stamped true, "
    "plugins [a, b, c, d, e]"
)
PARAMETERS = """controller_manager:
  ros__parameters:
    update_rate: 100
    offset: 0.0
    arm_controller:
      type: a/B
arm_controller:
  ros__parameters:
    joints: [upper, lower]
    frame_id: base_link
    odom_topic: odom
    use_stamped: true
    plugins: [a, b, c, d, e]
"""


@pytest.mark.parametrize(
    ("old", "new", "sentence", "is_breaking"),
    [
        ("100", "200", "controller_manager.ros__parameters.update_rate 100 -> 200", False),
        ("lower]", "lower, tool]",
         "arm_controller.ros__parameters.joints [upper, lower] -> [upper, lower, tool]", False),
        ("[a, b, c, d, e]", "[a, b, c, d, e, f]", "arm_controller.ros__parameters.plugins: f added", False),
        ("[a, b, c, d, e]", "[f, b, c, d, e]", "arm_controller.ros__parameters.plugins: f added, a removed", True),
        ("lower]", "fore]", "arm_controller.ros__parameters.joints [upper, lower] -> [upper, fore]", True),
        ("frame_id: base_link", "frame_id: base", "arm_controller.ros__parameters.frame_id base_link -> base", True),
        ("stamped: true", "stamped: false", "arm_controller.ros__parameters.use_stamped true -> false", True),
        ("    arm_controller:\n      type: a/B\n", "",
         "controller_manager.ros__parameters.arm_controller.type a/B removed", True),
        (PARAMETERS[PARAMETERS.index("arm_controller:\n  ros"):], "",
         REMOVED_CONTROLLER, True),
        ("    odom_topic: odom\n", "", "arm_controller.ros__parameters.odom_topic odom removed", False),
        ("    update_rate: 100\n", "", "controller_manager.ros__parameters.update_rate 100 removed", False),
    ],
)  # fmt: skip
def test_parameter_changes_are_reported(repository, compare, old, new, sentence, is_breaking):
    repository.commit({"a/package.xml": PACKAGE_XML, "a/config/c.yaml": PARAMETERS})
    repository.write({"a/config/c.yaml": PARAMETERS.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, "a/config/c.yaml")) == [sentence]
    assert bool(breaking(result)) is is_breaking


def test_removed_controller_is_one_breaking_line(repository, compare):
    repository.commit({"a/package.xml": PACKAGE_XML, "a/config/c.yaml": PARAMETERS})
    text = PARAMETERS[: PARAMETERS.index("arm_controller:\n  ros")].replace(
        "    arm_controller:\n      type: a/B\n", ""
    )
    repository.write({"a/config/c.yaml": text})
    result = compare(repository)
    assert breaking(result) == ["controller_manager.ros__parameters.arm_controller.type a/B removed"]
    assert REMOVED_CONTROLLER in sentences(subject(result, "a/config/c.yaml"))


def test_controller_type_as_own_parameter_is_not_a_removal(repository, compare):
    repository.commit({"a/package.xml": PACKAGE_XML, "a/config/c.yaml": PARAMETERS})
    text = PARAMETERS.replace("    arm_controller:\n      type: a/B\n", "")
    text = text.replace("    joints: [upper", "    type: a/B\n    joints: [upper")
    repository.write({"a/config/c.yaml": text})
    result = compare(repository)
    assert len(sentences(subject(result, "a/config/c.yaml"))) == 2
    assert breaking(result) == []


@pytest.mark.parametrize(
    "text",
    [
        PARAMETERS.replace("offset: 0.0", "offset: 0.00"),
        "# Hz\n" + PARAMETERS,
        PARAMETERS.replace("[upper, lower]", "\n      - upper\n      - lower"),
    ],
)
def test_reformatted_parameters_are_not_reported(repository, compare, text):
    repository.commit({"a/package.xml": PACKAGE_XML, "a/config/c.yaml": PARAMETERS})
    repository.write({"a/config/c.yaml": text})
    assert compare(repository).subjects == []


ALIASES = "\n".join(["a0: &a0 [{x: 1}]", *(f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, 9))])


def test_yaml_with_too_many_values_is_a_problem(repository, compare):
    repository.commit({"a/package.xml": PACKAGE_XML, "a/config/c.yaml": PARAMETERS})
    repository.write({"a/config/c.yaml": ALIASES})
    (problem,) = subject(compare(repository), "a/config/c.yaml").problems
    assert "more than 20000 values" in problem.text


def test_file_that_can_no_longer_be_read_is_breaking(repository, compare):
    repository.commit({"a/package.xml": PACKAGE_XML, "a/config/c.yaml": PARAMETERS})
    repository.commit({"a/config/c.yaml": "a: [1"})
    (sentence,) = breaking(compare(repository, "HEAD~1..HEAD"))
    assert sentence.startswith("can no longer be read: line 1 is not valid YAML: ")
    repository.commit({"a/config/c.yaml": PARAMETERS})
    result = compare(repository, "HEAD~1..HEAD")
    (sentence,) = sentences(subject(result, "a/config/c.yaml"))
    assert sentence.startswith("can be read now; in the old version: line 1 is not valid YAML: ")
    assert breaking(result) == []


@pytest.mark.parametrize(
    ("old", "new", "sentence", "is_breaking"),
    [
        ("int32 count", "int64 count", "field 'count': int32 -> int64", True),
        ("int32 count\n", "", "field 'count' removed", True),
        ("int32 count", "int32 count\nbool done", "field 'done' of type bool added", True),
        ("KIND_A=1", "KIND_A=2", "constant 'KIND_A': 1 -> 2", True),
        ("string name", "string name 'x'", "default of field 'name': None -> x", False),
    ],
)  # fmt: skip
def test_interface_changes_are_reported(repository, compare, old, new, sentence, is_breaking):
    text = "uint8 KIND_A=1\nint32 count\nstring name\ngeometry_msgs/Point point\n"
    repository.commit({"m/package.xml": PACKAGE_XML.replace("arm_description", "m"), "m/msg/Count.msg": text})
    repository.write({"m/msg/Count.msg": text.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, "m/msg/Count.msg")) == [sentence]
    assert (breaking(result) == [sentence]) is is_breaking


def test_added_constant_is_breaking_in_ros_1(repository, compare):
    manifest = "<package><name>m</name><buildtool_depend>catkin</buildtool_depend></package>"
    repository.commit({"m/package.xml": manifest, "m/srv/Set.srv": "uint8 FAST=1\nuint8 mode\n---\n"})
    repository.write({"m/srv/Set.srv": "uint8 FAST=1\nuint8 SLOW=2\nuint8 mode\n---\n"})
    assert breaking(compare(repository)) == ["constant 'request SLOW' = 2 added"]


def test_renumbered_constants_are_one_change(repository, compare):
    text = "uint8 OFF=0\nuint8 ON=1\nuint8 FAULT=2\nuint8 UNKNOWN=3\nuint8 state\n"
    repository.commit({"m/msg/State.msg": text})
    new = "uint8 OFF=0\nuint8 IDLE=1\nuint8 ON=2\nuint8 FAULT=3\nuint8 UNKNOWN=4\nuint8 state\n"
    repository.write({"m/msg/State.msg": new})
    renumbered = "3 constants have other values: ON 1 -> 2, FAULT 2 -> 3, UNKNOWN 3 -> 4"
    result = compare(repository)
    assert sentences(subject(result, "m/msg/State.msg")) == ["constant 'IDLE' = 1 added", renumbered]
    assert breaking(result) == [renumbered]


def test_comment_in_interface_is_not_reported(repository, compare):
    repository.commit({"m/msg/Count.msg": "int32 count\n"})
    repository.write({"m/msg/Count.msg": "# How many\nint32 count\n"})
    assert compare(repository).subjects == []


def test_added_and_removed_files_are_other_files_beside_an_added_robot(package, compare):
    package.commit({"old.txt": "An arm."})
    added = {"arm_description/urdf/new.urdf": '<robot name="new"><link name="a"/></robot>', "new.txt": "Another arm."}
    package.commit({**added, "old.txt": None})
    result = compare(package, "HEAD~1..HEAD")
    assert result.other_files == ["new.txt", "old.txt"]


def test_settings_of_tools_are_other_files(package, compare):
    files = (".github/workflows/ci.yml", "mkdocs.yml", "arm_description/.clang-format.yaml")
    package.commit(dict.fromkeys(files, "a: 1\n"))
    package.write(dict.fromkeys(files, "a: 2\n"))
    result = compare(package)
    assert result.subjects == []
    assert sorted(result.other_files) == sorted(files)


def test_manifest_changes_are_reported(package, compare):
    text = PACKAGE_XML.replace("1.0.0", "1.1.0").replace("<exec_depend>xacro", "<exec_depend>urdf")
    package.write({"arm_description/package.xml": text})
    review_subject = subject(compare(package), "arm_description/package.xml")
    assert sentences(review_subject) == [
        "version: 1.0.0 -> 1.1.0",
        "exec_depend added: urdf",
        "exec_depend removed: xacro",
    ]


def test_renamed_package_is_breaking(package, compare):
    package.write({"arm_description/package.xml": PACKAGE_XML.replace("arm_description", "robot_description")})
    assert "package 'arm_description' renamed to 'robot_description'" in breaking(compare(package))


def _make_stl(height: float) -> bytes:
    import numpy as np

    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    triangles = np.zeros(2, record)
    triangles["corners"] = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [1, 0, 0], [0, 0, height]]]
    return bytes(80) + len(triangles).to_bytes(4, "little") + triangles.tobytes()


def test_mesh_size_changes_are_reported(repository, compare):
    repository.commit({"a/meshes/m.stl": _make_stl(1.0)})
    repository.write({"a/meshes/m.stl": _make_stl(2.0)})
    result = compare(repository)
    (figure,) = subject(result, "a/meshes/m.stl").figures
    assert (figure.old, figure.new) == ("1 1 1", "1 1 2")
    assert "highest corner" in figure.name
    assert as_text(result).splitlines()[-1] == "0 breaking changes, 1 change, 0 new findings, 0 fixed"


@pytest.mark.parametrize("uri", ["package://a/meshes/m.stl", "file://$(find a)/meshes/m.stl", "../meshes/m.stl"])
def test_mesh_with_other_contents_changes_the_robot(repository, compare, uri):
    robot = f'''<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base"><visual><geometry>
  <mesh filename="{uri}"/></geometry></visual></link></robot>'''
    manifest = PACKAGE_XML.replace("arm_description", "a")
    files = {"a/package.xml": manifest, "a/urdf/r.urdf.xacro": robot, "a/meshes/m.stl": _make_stl(1.0)}
    repository.commit(files)
    repository.write({"a/meshes/m.stl": _make_stl(2.0)})
    robot_subject = subject(compare(repository), "a/urdf/r.urdf.xacro")
    assert [change.location.file for change in robot_subject.changes] == ["a/meshes/m.stl"]
    assert [str(figure.name) for figure in robot_subject.figures] == ["size"]


def test_mesh_in_git_lfs_is_not_downloaded(repository, compare):
    pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:{}\nsize 12\n"
    repository.commit({"a/meshes/m.stl": pointer.format("0" * 64)})
    repository.write({"a/meshes/m.stl": pointer.format("1" * 64)})
    problems = subject(compare(repository), "a/meshes/m.stl").problems
    assert [str(problem.text) for problem in problems] == [
        "neither version can be read: the file is in Git LFS and is not downloaded",
    ]


def test_map_changes_are_reported(repository, compare):
    header = b"P5\n4 2\n255\n"
    repository.commit({"n/maps/house.pgm": header + bytes([255] * 8)})
    repository.write({"n/maps/house.pgm": header + bytes([255, 255, 0, 255, 255, 255, 0, 255])})
    assert sentences(subject(compare(repository), "n/maps/house.pgm")) == [
        "25 % of the cells changed, in columns 2 to 2 and rows 0 to 1 of the image"
    ]


def test_renamed_meshes_of_a_folder_are_one_breaking_line(repository, compare):
    names = ("wheel", "arm", "lid")
    repository.commit({f"a/meshes/{name}-1.stl": _make_stl(size) for size, name in enumerate(names, 1)})
    repository.commit(
        {f"a/meshes/{name}-1.stl": None for name in names}
        | {f"a/meshes/{name}.stl": _make_stl(size) for size, name in enumerate(names, 1)}
    )
    (review_subject,) = compare(repository, "HEAD~1..HEAD").subjects
    assert review_subject.path == "a/meshes/"
    (change,) = review_subject.changes
    assert (
        str(change.sentence) == "3 meshes renamed: arm-1.stl -> arm.stl, lid-1.stl -> lid.stl, wheel-1.stl -> wheel.stl"
    )
    assert str(change.reason) == "descriptions that name the file do not find it"
    assert not review_subject.problems


def test_removed_and_added_meshes_are_grouped(repository, compare):
    repository.commit({f"a/meshes/m{number}.stl": _make_stl(number) for number in range(MAX_NAMES + 2)})
    repository.commit({f"a/meshes/m{number}.stl": None for number in range(MAX_NAMES + 2)})
    result = compare(repository, "HEAD~1..HEAD")
    (change,) = result.subjects[0].changes
    assert str(change.sentence).endswith(" and 2 more")
    assert result.breaking_changes
    assert not compare(repository, "HEAD..HEAD~1").breaking_changes


def test_fields_have_their_lines(repository, compare):
    text = "# state\nint32 count\n---\nstring name\n---\nfloat32 count\n"
    repository.commit({"a/action/Move.action": text})
    repository.write({"a/action/Move.action": text.replace("float32 count", "float32 share\nfloat64 count")})
    review_subject = subject(compare(repository), "a/action/Move.action")
    assert [(str(change.sentence), change.location.line) for change in review_subject.changes] == [
        ("field 'feedback share' of type float32 added", 6),
        ("field 'feedback count': float32 -> float64", 7),
    ]


def test_other_kinds_of_dependencies_are_one_line(repository, compare):
    names = ("geometry_msgs", "rclcpp", "sensor_msgs")

    def manifest(tag: str) -> str:
        lines = "".join(f"  <{tag}>{name}</{tag}>\n" for name in names)
        return PACKAGE_XML.replace("</package>", f"{lines}</package>")

    repository.commit({"a/package.xml": manifest("exec_depend")})
    repository.write({"a/package.xml": manifest("depend").replace('format="3"', 'format="2"')})
    assert sentences(subject(compare(repository), "a/package.xml")) == [
        "format: 3 -> 2",
        "exec_depend -> depend: geometry_msgs, rclcpp, sensor_msgs",
    ]


def test_files_that_are_not_compared_have_their_states(package, compare):
    package.commit({"a/old.txt": "old", "a/same.txt": "same", "a/moved.txt": "a text that moves\n" * 9})
    textures = {f"a/textures/t{n}.png": "png" for n in range(5)}
    robot = {"a/usd/arm.usda": "#usda 1.0\n"}
    moved = {"a/moved.txt": None, "a/new/moved.txt": "a text that moves\n" * 9}
    package.commit({"a/old.txt": None, "a/same.txt": "other", **moved, **textures, **robot})
    lines = as_text(compare(package, "HEAD~1..HEAD")).split("\n\n")[0].splitlines()
    assert lines == [
        "other changed files",
        "  a/new/moved.txt (renamed from a/moved.txt)",
        "  a/old.txt (removed)",
        "  a/same.txt",
        "  a/textures/ (5 files, added)",
        "  a/usd/arm.usda (added, robot or world in USD, not compared)",
    ]


YARD = """<sdf version="1.9"><world name="yard"><plugin name="p" filename="gz-sim-physics-system"/>
  <model name="box"><link name="l"/></model>
  <include><uri>model://sun</uri></include><include><name>gate</name><uri>model://door</uri></include></world></sdf>"""
CAR = """<sdf version="1.9"><model name="car"><link name="body"/><link name="wheel"/>
  <joint name="axle" type="revolute"><parent>body</parent><child>wheel</child></joint></model></sdf>"""
RVIZ = """Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/Grid, Name: Grid}
    - {Class: rviz_default_plugins/LaserScan, Name: Laser, Topic: {Value: /scan}}
"""
SRDF = '<robot name="arm"><group name="arm"/><group_state name="home" group="arm"/></robot>'
BRIDGE = "- {ros_topic_name: /scan, gz_topic_name: /lidar, ros_type_name: a/msg/B, gz_type_name: gz.msgs.C}\n"
PLATE = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit meter="0.1"/><up_axis>Z_UP</up_axis></asset>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="a" count="9">0 0 0 20 0 0 0 30 0</float_array>
      <technique_common><accessor source="#a" count="3" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>
  </library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>"""
CUBE = "v 0 0 0\nv 2 0 0\nv 0 3 0\nf 1 2 3\n"


BOX = "<geometry><box><size>1 1 1</size></box></geometry>"
MODEL = f"""<sdf version="1.7"><model name="cube"><link name="body">
  <inertial><mass>3</mass></inertial>
  <visual name="a">{BOX}</visual><collision name="b">{BOX}</collision><collision name="c">{BOX}</collision>
</link></model></sdf>
"""
NO_SECTION = "without ros__parameters, so that nodes cannot load the file"


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("worlds/yard.sdf", YARD, "world added: models box, sun, gate, plugin 'p' (filename=gz-sim-physics-system)"),
        ("models/car/model.sdf", CAR, "model added: links body, wheel, joints axle"),
        ("msg/Count.msg", "uint8 MAX=3\nint32 count\nstring[] names\n",
         "interface added: int32 count, string[] names, MAX = 3"),
        ("msg/Mode.msg", "uint8 SLOW=0\nuint8 FAST=1\n", "interface added: SLOW = 0, FAST = 1"),
        ("srv/Ask.srv", "int32 a\n---\nbool b\n", "interface added: request: int32 a; response: bool b"),
        ("models/cube/model.sdf", MODEL,
         "model added: links body, visual box size 1 1 1, collision box size 1 1 1 (2 times), mass 3 kg"),
        ("config/nav.yaml", "amcl:\n  ros__parameters: {alpha1: 0.1, alpha2: 0.2}\n",
         "parameter file added: parameters of amcl (alpha1 0.1, alpha2 0.2)"),
        ("config/mixed.yaml", "amcl:\n  ros__parameters: {alpha1: 0.1}\ngrip:\n  type: Grip\n",
         f"parameter file added: parameters of amcl (alpha1 0.1); {NO_SECTION}: grip (type Grip)"),
        ("config/settings.yaml", "speed: 1\nnames: [a, b]\n", "parameter file added: speed 1, names [a, b]"),
        ("config/log.yaml", "driver.log:\n  a: 1\n", "parameter file added: driver.log (a 1)"),
        ("test/config_launch.yaml", "driver.launch: {a: 1}\n", "parameter file added: driver.launch (a 1)"),
        ("launch/start.launch.yaml", "launch:\n- arg: {name: ip, unless: $(var sim)}\n",
         "launch file added: argument 'ip' (unless $(var sim), required)"),
        ("config/bridge.yaml", BRIDGE, "parameter file added: bridged topics /scan"),
        ("rviz/arm.rviz", RVIZ, "RViz configuration added: displays Grid, Laser /scan"),
        ("srdf/arm.srdf", SRDF, "semantic description added: group 'arm', group_state 'arm/home'"),
        ("meshes/cube.obj", CUBE, "mesh added: 1 triangle, 2 x 3 x 0 in the units of the file"),
        ("meshes/plate.dae", PLATE, "mesh added: 1 triangle, 2 x 3 x 0 m"),
        ("rviz/broken.rviz", "a: [", "RViz configuration added"),
    ],
)  # fmt: skip
def test_added_file_is_described_by_its_contents(repository, compare, name, text, expected):
    repository.commit({"p/package.xml": PACKAGE_XML.replace("arm_description", "p")})
    repository.write({f"p/{name}": text})
    assert sentences(subject(compare(repository), f"p/{name}")) == [expected]


def test_corners_of_collada_are_in_meters(repository, compare):
    repository.commit({"p/package.xml": PACKAGE_XML.replace("arm_description", "p"), "p/meshes/plate.dae": PLATE})
    repository.write({"p/meshes/plate.dae": PLATE.replace('meter="0.1"', 'meter="1"')})
    figures = subject(compare(repository), "p/meshes/plate.dae").figures
    assert [(str(it.name), it.old, it.new, it.unit) for it in figures if str(it.name).endswith("corner")] == [
        ("highest corner", "2 3 0", "20 30 0", "m")
    ]


def test_values_that_tell_most_are_shown_of_a_long_file(repository, compare):
    """A recorded request of MoveIt has many zeros, and equal tolerances for all joints."""
    zeros = "\n".join(f"  stamp{number}: {{sec: 0, nanosec: 0, frame: '', names: []}}" for number in range(15))
    goals = "\n".join(f"  - {{joint_name: j{number}, position: {number}.5, tolerance: 0.01}}" for number in range(6))
    repository.commit({"p/package.xml": PACKAGE_XML.replace("arm_description", "p")})
    repository.write({"p/config/goal.yaml": f"request:\n{zeros}\n  goals:\n{goals}"})
    (line,) = sentences(subject(compare(repository), "p/config/goal.yaml"))
    assert all(f"position {number}.5" in line for number in range(6))
    assert "nanosec 0" in line.partition("tolerance 0.01")[2] or "nanosec 0" not in line


def test_messages_of_ros1_have_its_types_and_names(repository, compare):
    manifest = PACKAGE_XML.replace("arm_description", "p").replace(
        "<exec_depend>xacro</exec_depend>", "<buildtool_depend>catkin</buildtool_depend>"
    )
    text = "Header header\nHeader[] headers\ntime poseStamp\n"
    repository.commit({"p/package.xml": manifest, "p/msg/Pose.msg": text})
    repository.write({"p/msg/Pose.msg": text.replace("poseStamp", "stamp"), "p/msg/New.msg": text})
    result = compare(repository)
    assert sentences(subject(result, "p/msg/Pose.msg")) == ["field 'poseStamp' renamed to 'stamp'"]
    assert sentences(subject(result, "p/msg/New.msg")) == [
        "interface added: std_msgs/Header header, std_msgs/Header[] headers, time poseStamp"
    ]
