"""The lines of a review about files that still name a frame or joint which a robot has lost."""

from __future__ import annotations

import pytest

MANIFEST = "<package><name>{}</name><version>1.0.0</version></package>\n"
ROBOT = """<robot name="arm">
  <link name="base_link"/><link name="upper"/><link name="{link}"/>
  <joint name="{joint}" type="revolute">
    <parent link="base_link"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="fixed" type="fixed"><parent link="upper"/><child link="{link}"/></joint>
</robot>
"""
LOOKUP = 'class A:\n    def f(self):\n        self.buffer.lookup_transform("map", "{}", 0)\n'
LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import Node
def generate_launch_description():
    return LaunchDescription([Node(package="driver", executable="driver", parameters=[{"frame_id": "camera"}])])
"""
SEMANTIC = '<robot name="arm"><group name="g">{}</group></robot>\n'
PART = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="sim" default="false"/>{call}
  <xacro:if value="$(arg sim)"><gazebo reference="{reference}"><material>Red</material></gazebo>
    <link name="mark"/><joint name="m" type="fixed"><parent link="upper"/><child link="mark"/></joint></xacro:if>
</robot>
"""
FRAME = "names the frame 'camera', which 'arm/arm.urdf' no longer has"
JOINT = "names the joint 'shoulder', which 'arm/arm.urdf' no longer has"


def find_users(repository, compare, files):
    """Return the lines about a frame and a joint that the files still name after both have other names."""
    manifest = {"arm/package.xml": MANIFEST.format("arm")}
    repository.commit({**manifest, "arm/arm.urdf": ROBOT.format(link="camera", joint="shoulder"), **files})
    repository.write({"arm/arm.urdf": ROBOT.format(link="lens", joint="swivel")})
    return [
        (subject.path, change.location.line, str(change.sentence))
        for subject, change in compare(repository).breaking_changes
        if str(change.sentence).startswith("names the")
    ]


@pytest.mark.parametrize(
    ("path", "text", "line", "sentence"),
    [
        ("a.py", LOOKUP.format("camera"), 3, FRAME),
        ("a.py", LOOKUP.format("base_link"), 0, ""),
        ("a.rviz", "Visualization Manager:\n  Global Options:\n    Fixed Frame: camera\n", 3, FRAME),
        ("a.yaml", "driver:\n  ros__parameters:\n    frame_id: camera\n", 3, FRAME),
        ("a.yaml", "driver:\n  ros__parameters:\n    name: camera\n", 0, ""),
        ("a.launch.py", LAUNCH, 4, FRAME),
        ("a.yaml", "controller:\n  ros__parameters:\n    joints: [elbow, shoulder]\n", 3, JOINT),
        ("a.yaml", "controller:\n  ros__parameters:\n    words: [elbow, shoulder]\n", 0, ""),
        ("a.srdf", SEMANTIC.format('<joint name="shoulder"/>'), 1, JOINT),
        ("a.srdf", SEMANTIC.format('<chain base_link="base_link" tip_link="camera"/>'), 1, FRAME),
        ("a.srdf", SEMANTIC.format('<!-- <joint name="shoulder"/> -->'), 0, ""),
        ("a.xacro", PART.format(call="", reference="camera"), 3, FRAME),
        ("a.xacro", PART.format(call="", reference="upper"), 0, ""),
        ("a.xacro", PART.format(call="", reference="lens").replace("upper", "camera"), 4, FRAME),
        ("a.xacro", PART.format(call='<xacro:sensor name="cam"/>', reference="camera"), 0, ""),
        ("test/a.yaml", "driver:\n  ros__parameters:\n    frame_id: camera\n", 0, ""),
    ],
)
def test_a_file_that_names_a_lost_frame_or_joint(repository, compare, path, text, line, sentence):
    path = f"arm/{path}"
    assert find_users(repository, compare, {path: text}) == ([(path, line, sentence)] if line else [])


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("other.urdf", '<robot name="o"><link name="camera"/></robot>\n'),
        ("camera.xacro", '<robot><xacro:macro name="c" params="p"><link name="${p}camera"/></xacro:macro></robot>\n'),
        ("robot.xacro", '<robot><xacro:camera name="camera"/></robot>\n'),
        ("robot.xacro", '<robot><link name="${p}era"/><xacro:camera p="cam"/></robot>\n'),
        (
            "b.py",
            'import tf\nclass B:\n    def f(self):\n        self.b.sendTransform((0,), (0,), t, "camera", "map")\n',
        ),
        ("c.py", 'import tf2_ros\nsender = tf2_ros.TransformBroadcaster()\nt.header.frame_id = "camera"\n'),
        ("b.launch", '<launch><node pkg="tf" type="static_transform_publisher" args="0 map camera"/></launch>\n'),
        ("b.yaml", "odometry:\n  ros__parameters:\n    child_frame_id: camera\n"),
    ],
)
def test_a_frame_that_another_file_may_define(repository, compare, path, text):
    assert find_users(repository, compare, {f"arm/{path}": text, "arm/a.py": LOOKUP.format("camera")}) == []


@pytest.mark.parametrize(("mention", "is_found"), [("arm", True), ("leg", False)])
def test_a_package_counts_if_it_mentions_the_one_of_the_robot(repository, compare, mention, is_found):
    files = {
        "user/package.xml": MANIFEST.format("user").replace("</package>", f"<depend>{mention}</depend></package>"),
        "user/a.py": LOOKUP.format("camera"),
    }
    assert find_users(repository, compare, files) == ([("user/a.py", 3, FRAME)] if is_found else [])


def test_a_frame_that_a_macro_would_define_with_another_argument(repository, compare):
    text = '<robot><xacro:macro name="c" params="p"><link name="${p}era"/></xacro:macro><xacro:c p="op"/></robot>\n'
    files = {"arm/camera.xacro": text, "arm/a.py": LOOKUP.format("camera")}
    assert find_users(repository, compare, files) == [("arm/a.py", 3, FRAME)]


def test_several_frames_that_a_source_loses_are_looked_for(repository, compare):
    send = 't{0} = TransformStamped()\nt{0}.child_frame_id = "{1}"\nTransformBroadcaster(None).sendTransform(t{0})\n'
    imports = "from geometry_msgs.msg import TransformStamped\nfrom tf2_ros import TransformBroadcaster\n"
    files = {
        "arm/package.xml": MANIFEST.format("arm"),
        "arm/a.yaml": "driver:\n  ros__parameters:\n    frame_id: lamp\n",
    }
    repository.commit({**files, "arm/frames.py": imports + send.format(1, "lamp") + send.format(2, "lens")})
    repository.write({"arm/frames.py": imports})
    lines = [str(change.sentence) for _, change in compare(repository).breaking_changes]
    assert "names the frame 'lamp', which 'arm/frames.py' no longer has" in lines


SENDER = """#include <ros/ros.h>
void run(ros::NodeHandle& nh) {{
  std::string frame;
  nh.param<std::string>(ros::this_node::getName() + "/{key}", frame, "base");
  geometry_msgs::TransformStamped transform;
  transform.child_frame_id = {child};
  broadcaster.sendTransform(transform);
}}
"""
GIVEN = '<launch><node pkg="{}" type="sender" name="s"><param name="child_frame" value="/{}"/></node></launch>\n'


@pytest.mark.parametrize(
    ("package", "old", "is_found"), [("arm", "base", False), ("other", "base", True), ("arm", "boom/lamp", True)]
)
def test_a_frame_that_a_launch_file_newly_gives_to_the_package(repository, compare, package, old, is_found):
    path = "arm/start.launch"
    files = {"arm/package.xml": MANIFEST.format("arm"), path: GIVEN.format(package, old)}
    repository.commit({**files, "arm/sender.cpp": SENDER.format(key="rate", child='"boom/lamp"')})
    repository.write({"arm/sender.cpp": SENDER.format(key="child_frame", child="frame")})
    repository.write({path: GIVEN.format(package, "boom/lamp") + "<!-- -->\n"})
    lines = [str(change.sentence) for _, change in compare(repository).breaking_changes]
    assert ("names the frame 'boom/lamp', which 'arm/sender.cpp' no longer has" in lines) is is_found


PAIRS = '<robot name="{robot}"><disable_collisions link1="base_link" link2="{link}" reason="Never"/></robot>\n'
OTHER_ROBOT = '<robot name="{}"><link name="camera"/></robot>\n'


@pytest.mark.parametrize(
    ("files", "found"),
    [
        ({"arm.srdf": PAIRS.format(robot="arm", link="camera")}, ["arm.srdf"]),
        ({"arm.srdf": PAIRS.format(robot="arm", link="camera"), "b/b.urdf": OTHER_ROBOT.format("b")}, ["arm.srdf"]),
        ({"arm.srdf": PAIRS.format(robot="arm", link="camera"), "b/b.urdf": OTHER_ROBOT.format("arm")}, []),
        ({"arm.srdf": PAIRS.format(robot="arm", link="lens")}, []),
        ({"arm.srdf": PAIRS.format(robot="other", link="camera")}, []),
    ],
)
def test_disabled_collisions_of_a_renamed_link_belong_to_the_robot_of_the_name(repository, compare, files, found):
    repository.commit({"arm/arm.urdf": ROBOT.format(link="camera", joint="shoulder"), **files})
    repository.write({"arm/arm.urdf": ROBOT.format(link="lens", joint="shoulder")})
    changes = [
        (subject.path, str(change.sentence), str(change.reason))
        for subject, change in compare(repository).breaking_changes
        if subject.path.endswith(".srdf")
    ]
    assert changes == [
        (
            path,
            "disables collisions of 'camera', which 'arm/arm.urdf' no longer has",
            "MoveIt also checks the disabled collisions of the link, which is 'lens' now",
        )
        for path in found
    ]


def test_a_static_transform_that_a_configuration_of_rviz_still_names(repository, compare):
    node = '<node pkg="tf2_ros" exec="static_transform_publisher" args="0 0 0 0 0 0 base $(var name)_link"/>'
    launch = '<launch><arg name="name" default="camera"/>{}<node pkg="driver" exec="driver"/></launch>\n'
    path = "arm/launch/camera.launch.xml"
    rviz = "Visualization Manager:\n  Global Options:\n    Fixed Frame: camera_link\n"
    manifest = {"arm/package.xml": MANIFEST.format("arm")}
    repository.commit({**manifest, path: launch.format(node), "arm/etc/camera.rviz": rviz})
    repository.write({path: launch.format("")})
    lines = [str(change.sentence) for subject, change in compare(repository).breaking_changes if "rviz" in subject.path]
    assert lines == [f"names the frame 'camera_link', which '{path}' no longer has"]


def test_a_frame_that_two_robots_lose_has_one_line_for_each_user(repository, compare):
    robots = ("arm/arm.urdf", "arm/mobile.urdf")
    rviz = {"arm/a.rviz": "Visualization Manager:\n  Global Options:\n    Fixed Frame: camera\n"}
    old = dict.fromkeys(robots, ROBOT.format(link="camera", joint="shoulder"))
    repository.commit({"arm/package.xml": MANIFEST.format("arm"), **old, **rviz})
    repository.write(dict.fromkeys(robots, ROBOT.format(link="lens", joint="shoulder")))
    texts = [str(change.sentence) for _, change in compare(repository).breaking_changes]
    assert texts.count(FRAME) == len([text for text in texts if text.startswith("names the")]) == 1
