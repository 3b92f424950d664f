"""Plugins that a description gains or loses in a review, with their names and topics."""

from __future__ import annotations

import pytest

from linkwright.review.reports.sentences import format_change
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "a/urdf/robot.urdf"
DRIVE = """<gazebo>
  <plugin name="drive" filename="libgazebo_ros_diff_drive.so"><odom_frame>odom</odom_frame></plugin>
</gazebo>"""
DOCK = """<gazebo>
  <plugin name="dock" filename="libdock.so"><ros><remapping>~/out:=dock</remapping></ros></plugin>
</gazebo>"""
LIGHT = '<gazebo reference="base"><turnGravityOff>true</turnGravityOff></gazebo>'
JOINT = '<joint name="{name}"><command_interface name="position"/><state_interface name="position"/></joint>'
HARDWARE = '<ros2_control name="arm" type="system"><hardware><plugin>a/B</plugin></hardware>{joint}</ros2_control>'


def robot_text(*extensions: str) -> str:
    return f'<robot name="r"><link name="base"/>{"".join(extensions)}</robot>'


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ([HARDWARE.format(joint=JOINT.format(name="a"))],
         [HARDWARE.format(joint=JOINT.format(name="/left/a")).replace('name="arm"', 'name="/left/arm"')],
         "extension 'ros2_control arm' renamed to 'ros2_control /left/arm'", True),
        ([LIGHT], [LIGHT, DOCK],
         "extension 'gazebo' added: plugin 'dock' (filename=libdock.so, ros remapping ~/out:=dock)", False),
        ([LIGHT, DRIVE], [LIGHT],
         ("extension 'gazebo' removed: plugin 'drive' (filename=libgazebo_ros_diff_drive.so, odom_frame odom, "
          "topics 'cmd_vel', 'odom')"), True),
        ([DRIVE], [DOCK],
         ("extension 'gazebo': plugin drive removed: filename=libgazebo_ros_diff_drive.so, odom_frame odom, "
          "topics 'cmd_vel', 'odom'"), True),
        ([LIGHT, DOCK], [LIGHT],
         "extension 'gazebo' removed: plugin 'dock' (filename=libdock.so, ros remapping ~/out:=dock)", True),
        (["<gazebo/>", LIGHT], ["<gazebo/>"], "extension 'gazebo base' removed: turnGravityOff true", False),
        ([HARDWARE.format(joint=JOINT.format(name="a"))], [HARDWARE.format(joint=JOINT.format(name="b"))],
         "extension 'ros2_control arm': joint a renamed to 'b'", True),
    ],
)  # fmt: skip
def test_plugins_are_named_with_their_topics(repository, compare, old, new, expected, is_breaking):
    repository.commit({PATH: robot_text(*old)})
    repository.write({PATH: robot_text(*new)})
    result = compare(repository)
    assert expected in sentences(subject(result, PATH))
    assert bool(breaking(result)) is is_breaking


def test_plugin_replaced_by_one_with_the_same_topics_is_not_breaking(repository, compare):
    other = DOCK.replace('name="dock" filename="libdock.so"', 'name="station" filename="libstation.so"')
    repository.commit({PATH: robot_text(DOCK)})
    repository.write({PATH: robot_text(other)})
    assert breaking(compare(repository)) == []


def test_equal_numbers_of_extensions_are_no_change(repository, compare):
    repository.commit({PATH: robot_text('<gazebo reference="base"><mu1>1.0</mu1></gazebo>')})
    repository.write({PATH: robot_text('<gazebo reference="base"><mu1>1</mu1></gazebo>')})
    assert compare(repository).subjects == []


def test_digits_that_a_computation_adds_are_neither_compared_nor_shown(repository, compare):
    def text(sum_text: str, friction: str) -> str:
        values = f"<mu1>{sum_text}</mu1><mu2>{friction}</mu2><dampingFactor>1234567890123456</dampingFactor>"
        robot = robot_text(f'<gazebo reference="base">{values}</gazebo>')
        return robot.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ', 1)

    path = PATH.replace(".urdf", ".urdf.xacro")
    repository.commit({path: text("${0.1 + 0.2}", "1.0")})
    repository.write({path: text("0.3", "${0.1 + 0.7}").replace("3456<", "3457<")})
    (found,) = compare(repository).subjects
    assert sentences(found) == [
        "extension 'gazebo base': mu2 1.0 -> 0.8, dampingFactor 1234567890123456 -> 1234567890123457",
    ]


@pytest.mark.parametrize(
    ("plugin", "is_breaking"),
    [
        ("filename='libgazebo_ros_dock.so'><robotNamespace></robotNamespace>", False),
        ("filename='libgazebo_ros_dock.so'><robotNamespace>/</robotNamespace>", False),
        ("filename='libgazebo_ros_dock.so'><robotNamespace>left</robotNamespace>", True),
        ("filename='libgazebo_ros_dock.so'>", True),
        ("filename='libgazebo_ros_dock.so'><ros/>", False),
        ("filename='libgazebo_ros_dock.so'><ros><namespace>left</namespace></ros>", True),
        ("filename='gz-sim-diff-drive-system'>", False),
    ],
)
@pytest.mark.parametrize(("old", "new"), [("/drive", "drive"), ("drive", "/drive")])
def test_relative_topic_of_a_plugin_in_the_root_namespace_has_the_same_name(
    repository, compare, plugin, is_breaking, old, new
):
    text = f"<gazebo><plugin name='dock' {plugin}<commandTopic>{{}}</commandTopic></plugin></gazebo>"
    repository.commit({PATH: robot_text(text.format(old))})
    repository.write({PATH: robot_text(text.format(new))})
    result = compare(repository)
    assert [sentences(found) for found in result.subjects] == [
        [f"extension 'gazebo': plugin dock commandTopic {old} -> {new}"]
    ]
    assert bool(breaking(result)) is is_breaking


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("<mu1>1</mu1><kp>5</kp><kd>2</kd>", "<mu1>2</mu1><kd>2</kd><maxVel>0.1</maxVel>",
         ["extension 'gazebo base': mu1 1 -> 2, maxVel 0.1 added, kp 5 removed"]),
        ("<sensor name='s'><rate>1</rate><ray><max>5</max></ray><topic>a</topic></sensor>",
         "<sensor name='s'><rate>2</rate><ray><max>6</max></ray><topic>b</topic></sensor>",
         ["extension 'gazebo base': sensor s: rate 1 -> 2, ray max 5 -> 6",
          "extension 'gazebo base': sensor s topic a -> b"]),
        ("<mu1>1</mu1><material>Red</material>", "<mu1>2</mu1><material>Blue</material>",
         ["extension 'gazebo base': mu1 1 -> 2", "extension 'gazebo base': material Red -> Blue"]),
    ],
)  # fmt: skip
def test_numbers_of_a_plugin_or_sensor_are_one_line(repository, compare, old, new, expected):
    text = "<gazebo reference='base'>{}</gazebo>"
    repository.commit({PATH: robot_text(text.format(old))})
    repository.write({PATH: robot_text(text.format(new))})
    assert sorted(sentences(subject(compare(repository), PATH))) == sorted(expected)


def test_topics_and_frames_of_a_long_plugin_come_first(repository, compare):
    values = "".join(f"<gain{letter}>1</gain{letter}>" for letter in "abcdefghijklm")
    names = "<topicName>imu</topicName><frameName>base</frameName>"
    repository.commit({PATH: robot_text()})
    repository.write(
        {PATH: robot_text(f"<gazebo><plugin name='p' filename='libp.so'>{values}{names}</plugin></gazebo>")}
    )
    (line,) = sentences(subject(compare(repository), PATH))
    assert line.startswith(
        "extension 'gazebo' added: plugin 'p' (filename=libp.so, topicName imu, frameName base, gaina 1"
    )


BLOCKS = """
    <gazebo reference="base"><collision/></gazebo>
    <gazebo reference="base">
      <material>Gazebo/Red</material>
      <sensor name="lidar" type="ray"><update_rate>10</update_rate></sensor>
    </gazebo>"""
NEW_BLOCKS = """
    <gazebo reference="base"><sensor name="camera" type="camera"/></gazebo>
    <gazebo reference="base"><collision/><mu1>0.5</mu1></gazebo>
    <gazebo reference="base"><sensor name="lidar" type="ray"><update_rate>20</update_rate></sensor></gazebo>
    <gazebo reference="base"><material>Gazebo/Red</material></gazebo>"""


def test_blocks_of_gazebo_for_a_link_are_compared_as_one(repository, compare):
    repository.commit({PATH: robot_text(BLOCKS)})
    repository.write({PATH: robot_text(NEW_BLOCKS)})
    assert sorted(sentences(subject(compare(repository), PATH))) == [
        "extension 'gazebo base': mu1 added: 0.5",
        "extension 'gazebo base': sensor camera added: type=camera",
        "extension 'gazebo base': sensor lidar update_rate 10 -> 20",
    ]


def test_other_division_into_blocks_of_gazebo_is_no_change(repository, compare):
    repository.commit({PATH: robot_text(BLOCKS)})
    repository.write(
        {PATH: robot_text(BLOCKS.replace('<collision/></gazebo>\n    <gazebo reference="base">', "<collision/>"))}
    )
    assert compare(repository).subjects == []


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("/", "", None),
        ("left", "/left", None),
        ("/left", "/right", "programs do not find the topics and services of the plugin in the namespace '/left'"),
        ("", "/right", "programs do not find the topics and services of the plugin in the namespace '/'"),
    ],
)
def test_namespace_of_a_plugin_is_compared_as_gazebo_ros_completes_it(repository, compare, old, new, reason):
    plugin = "<gazebo><plugin name='dock' filename='libdock.so'><ros><namespace>%s</namespace></ros></plugin></gazebo>"
    repository.commit({PATH: robot_text(plugin % old)})
    repository.write({PATH: robot_text(plugin % new)})
    reasons = [str(change.reason) for found in compare(repository).subjects for change in found.changes]
    assert reasons == ([] if reason is None else [reason])


LIDAR = """<gazebo reference="base"><sensor name="{}" type="gpu_lidar"><topic>scan</topic>
<{}><range><max>10</max></range></{}>{}</sensor></gazebo>"""


@pytest.mark.parametrize(
    ("new", "expected", "reason"),
    [
        (("front", "ray", "ray", "<gz_frame_id>base</gz_frame_id><pose>0 0 1 0 0 0</pose>"),
         "sensor 'lidar' renamed to 'front': pose 0 0 1 0 0 0 added", None),
        (("front", "ray", "ray", ""), "sensor 'lidar' renamed to 'front': gz_frame_id base removed",
         "programs that look for the frame 'base' in the messages do not find it"),
    ],
)  # fmt: skip
def test_sensor_with_another_name_in_the_same_place_is_compared(repository, compare, new, expected, reason):
    old = "lidar", "lidar", "lidar", "<gz_frame_id>base</gz_frame_id>"
    repository.commit({PATH: robot_text(LIDAR.format(*old))})
    repository.write({PATH: robot_text(LIDAR.format(*new))})
    (change,) = subject(compare(repository), PATH).changes
    assert str(change.sentence) == f"extension 'gazebo base': {expected}"
    assert str(change.reason) == str(reason)


@pytest.mark.parametrize(
    ("old", "new", "topic", "is_breaking"),
    [
        ([LIGHT], [LIGHT, DRIVE], "cmd_vel", False),
        (["<gazebo/>", DOCK], ["<gazebo/>", DOCK, DRIVE], "/cmd_vel", False),
        ([LIGHT], [LIGHT, DRIVE], "speed", True),
        ([LIGHT, DRIVE], [LIGHT], "cmd_vel", True),
    ],
)
def test_topic_of_a_source_that_an_added_plugin_has_is_not_lost(repository, compare, old, new, topic, is_breaking):
    source = f'void Drive::Load() {{ sub_ = node_->create_subscription<Twist>("{topic}", 10, f); }}\n'
    files = {"a/package.xml": PACKAGE_XML, "a/src/drive.cpp": source}
    repository.commit({**files, PATH: robot_text(*old)})
    repository.commit({"a/src/drive.cpp": None, PATH: robot_text(*new)})
    found = breaking(compare(repository, "HEAD~1..HEAD"))
    assert (f"subscriptions removed: '{topic}' (Twist)" in found) is is_breaking


@pytest.mark.parametrize(
    ("added", "names", "is_breaking"),
    [
        (DRIVE, ("odom",), False),
        (DRIVE, ("odom", "state"), True),
        (
            '<gazebo reference="base"><sensor name="s" type="lidar"><topic>/scan</topic></sensor></gazebo>',
            ("scan",),
            False,
        ),
        (DRIVE, (*(f"wheel_{number}" for number in range(9)), "odom"), True),
        (
            '<gazebo><plugin name="p" filename="libp.so"><odom_frame>odom</odom_frame></plugin></gazebo>',
            ("odom",),
            True,
        ),
    ],
)
def test_topics_of_a_source_that_an_added_plugin_has_are_not_lost(repository, compare, added, names, is_breaking):
    source = "import rclpy\n\n\ndef start(node):\n    node.create_publisher(Odometry, 'rate', 1)\n"
    lost = "".join(f"    node.create_publisher(Odometry, '{name}', 1)\n" for name in names)
    repository.commit({PATH: robot_text(LIGHT), "arm_description/driver.py": source + lost})
    repository.write({PATH: robot_text(LIGHT, added), "arm_description/driver.py": source})
    assert bool(breaking(compare(repository))) is is_breaking


@pytest.mark.parametrize(("new", "is_breaking"), [("scan", False), ("front/scan", True)])
@pytest.mark.parametrize("form", ["{}", "<xacro:macro name='scan' params='side'>{}</xacro:macro>"])
def test_topic_of_a_sensor_without_its_slash_is_the_same(repository, compare, form, new, is_breaking):
    sensor = "<gazebo reference='base'><sensor name='s' type='gpu_lidar'><topic>{}</topic></sensor></gazebo>"
    path = PATH.replace(".urdf", ".urdf.xacro")
    for topic in ("/scan", new):
        text = robot_text(form.format(sensor.format(topic)))
        repository.write({path: text.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')})
        if topic == "/scan":
            repository.commit({})
    result = compare(repository)
    assert [f"/scan -> {new}" in line for line in sentences(subject(result, path))] == [True]
    assert bool(breaking(result)) is is_breaking


SPACE = """<gazebo><plugin name="{}" filename="lib{}.so"><ros><namespace>{}</namespace>
  <remapping>~/out:={}</remapping></ros></plugin></gazebo>"""


def test_another_namespace_of_several_plugins_is_one_change(repository, compare):
    for space in ("arm", ""):
        plugins = [SPACE.format(name, name, space, name) for name in ("camera", "laser", "drive")]
        repository.write({PATH: robot_text(*plugins)})
        if space:
            repository.commit({PATH: robot_text(*plugins)})
    (change,) = subject(compare(repository), PATH).changes
    line = "extension 'gazebo': plugin camera ros namespace arm -> ''; also 'laser', 'drive'"
    assert str(format_change(change)) == line
    assert change.reason is not None


@pytest.mark.parametrize(("old", "new"), [("//scan", "/scan"), ("//scan", "/laser")])
def test_names_that_ros_2_refuses_break_nothing(repository, compare, old, new):
    """An empty prefix in ``/$(arg prefix)/scan`` gives such a name."""
    repository.commit({PATH: robot_text(SPACE.format("laser", "laser", "arm", old))})
    repository.write({PATH: robot_text(SPACE.format("laser", "laser", "arm", new))})
    result = compare(repository)
    assert len(subject(result, PATH).changes) == 1
    assert breaking(result) == []


@pytest.mark.parametrize(("new", "is_breaking"), [("/scan", False), ("/laser", True)])
def test_repeated_slashes_count_as_one(repository, compare, new, is_breaking):
    drive = '<gazebo><plugin name="laser" filename="liblaser.so"><topicName>{}</topicName></plugin></gazebo>'
    repository.commit({PATH: robot_text(drive.format("//scan"))})
    repository.write({PATH: robot_text(drive.format(new))})
    assert bool(breaking(compare(repository))) is is_breaking


def test_plugins_that_move_into_a_gazebo_element_are_matched_by_name(repository, compare):
    plugin = '<plugin name="{}" filename="libmimic.so"><joint>{}</joint></plugin>'
    old = [plugin.format(name, "j") for name in ("a", "b")]
    new = [plugin.format(name, "k") for name in ("b", "c", "a")]
    repository.commit({PATH: robot_text(DOCK, *old), "a/package.xml": PACKAGE_XML})
    repository.write({PATH: robot_text(DOCK.replace("libdock", "libbay"), "<gazebo>", *new, "</gazebo>")})
    lines = sentences(subject(compare(repository), PATH))
    replaced = [line for line in lines if "replaced by" in line]
    assert [line.count(f"plugin '{name}'") for line, name in zip(sorted(replaced), "ab", strict=True)] == [2, 2]
