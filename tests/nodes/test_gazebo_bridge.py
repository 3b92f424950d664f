"""parameter_bridge and image_bridge: what is written differently on the two sides is handed on."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from linkwright.nodes.gazebo.bridge import BridgedTopic, ImageBridge, ParameterBridge, topic_of_word, topics_of_file
from tests.places import GAZEBO_PACKAGE

SCAN = "/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan"


def heard(stage, kind, topic):
    messages = []
    stage.node.create_subscription(get_message(kind), topic, messages.append, 10)
    return messages


def publisher(stage, kind, topic):
    return stage.node.create_publisher(get_message(kind), topic, 10)


@pytest.mark.parametrize(
    ("word", "topic"),
    [
        (SCAN, BridgedTopic("/scan", "/scan", "sensor_msgs/msg/LaserScan", "gz.msgs.LaserScan", "GZ_TO_ROS")),
        (
            "/a@geometry_msgs/Twist]ignition.msgs.Twist",
            BridgedTopic("/a", "/a", "geometry_msgs/msg/Twist", "gz.msgs.Twist", "ROS_TO_GZ"),
        ),
        (
            "/a@std_msgs/msg/String@gz.msgs.StringMsg",
            BridgedTopic("/a", "/a", "std_msgs/msg/String", "gz.msgs.StringMsg", "BIDIRECTIONAL"),
        ),
    ],
)
def test_arguments(word, topic):
    assert topic_of_word(word) == topic


@pytest.mark.parametrize("word", ["", "/scan", "/scan@", "/scan@sensor_msgs/msg/LaserScan", "@a@b", "/scan@a["])
def test_an_argument_that_is_none(word):
    with pytest.raises(LinkwrightError, match="is no topic to bridge"):
        topic_of_word(word)


def test_the_file_of_our_own_package():
    topics = {each.gz_topic: each for each in topics_of_file(str(GAZEBO_PACKAGE / "config" / "bridge.yaml"))}
    assert topics["kinect/image"].ros_topic == "kinect/image_raw"
    assert topics["cmd_vel"].direction == "ROS_TO_GZ"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: 1", "it is no list"),
        ("- 1", "entry 1 is no mapping"),
        ("- topic_name: a\n  ros_type_name: b", "entry 1 has no 'gz_type_name'"),
        ("- ros_type_name: a\n  gz_type_name: b", "entry 1 has no 'ros_topic_name'"),
        ("- topic_name: a\n  ros_type_name: b\n  gz_type_name: c\n  direction: UP", "no such direction as 'UP'"),
        ("- [", "is no YAML"),
    ],
)
def test_a_file_that_does_not_say_it(text, message, tmp_path: Path):
    path = tmp_path / "bridge.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(LinkwrightError, match=message):
        topics_of_file(str(path))
    with pytest.raises(LinkwrightError, match="cannot read"):
        topics_of_file(str(tmp_path / "nothing.yaml"))


async def test_what_has_one_name_is_there_already(stage):
    scans = heard(stage, "sensor_msgs/msg/LaserScan", "/scan")
    ParameterBridge(stage.graph, NodeOptions(arguments=[SCAN]))
    publisher(stage, "sensor_msgs/msg/LaserScan", "/scan").publish(get_message("sensor_msgs/msg/LaserScan")())
    await stage.graph.settle()
    assert len(scans) == 1


async def test_a_remapped_name_is_bridged(stage):
    kind = "nav_msgs/msg/Odometry"
    moved = heard(stage, kind, "/odom")
    word = f"/model/mbot/odometry@{kind}[gz.msgs.Odometry"
    ParameterBridge(stage.graph, NodeOptions(arguments=[word], remappings=[("/model/mbot/odometry", "/odom")]))
    publisher(stage, kind, "/model/mbot/odometry").publish(get_message(kind)(child_frame_id="base"))
    await stage.graph.settle()
    assert [message.child_frame_id for message in moved] == ["base"]


async def test_messages_go_both_ways_and_not_round(stage):
    kind = "std_msgs/msg/String"
    ros, gz = heard(stage, kind, "/ros"), heard(stage, kind, "/gz")
    word = f"/gz@{kind}@gz.msgs.StringMsg"
    ParameterBridge(stage.graph, NodeOptions(arguments=[word], remappings=[("/gz", "/ros")]))
    to_ros, to_gz = publisher(stage, kind, "/gz"), publisher(stage, kind, "/ros")
    for number in range(3):
        to_ros.publish(get_message(kind)(data=f"up {number}"))
        to_gz.publish(get_message(kind)(data=f"down {number}"))
        await stage.graph.settle()
    expected = sorted(f"{way} {number}" for way in ("up", "down") for number in range(3))
    assert sorted(message.data for message in ros) == expected
    assert sorted(message.data for message in gz) == expected


async def test_a_twist_with_a_header_becomes_one_without(stage, tmp_path: Path):
    twists = heard(stage, "geometry_msgs/msg/Twist", "/cmd_vel")
    path = tmp_path / "bridge.yaml"
    path.write_text(
        "- topic_name: cmd_vel\n  ros_type_name: geometry_msgs/msg/TwistStamped\n"
        "  gz_type_name: gz.msgs.Twist\n  direction: ROS_TO_GZ\n",
        encoding="utf-8",
    )
    ParameterBridge(stage.graph, stage.options({"config_file": str(path)}))
    stamped = get_message("geometry_msgs/msg/TwistStamped")()
    stamped.twist.linear.x = 0.25
    publisher(stage, "geometry_msgs/msg/TwistStamped", "/cmd_vel").publish(stamped)
    await stage.graph.settle()
    assert [message.linear.x for message in twists] == [0.25]


async def test_a_type_that_is_not_known_is_named_and_the_rest_is_bridged(stage, said):
    kind = "std_msgs/msg/String"
    ros = heard(stage, kind, "/ros")
    words = ["/a@strange_msgs/msg/Thing[gz.msgs.Thing", f"/gz@{kind}[gz.msgs.StringMsg"]
    ParameterBridge(stage.graph, NodeOptions(arguments=words, remappings=[("/gz", "/ros")]))
    publisher(stage, kind, "/gz").publish(get_message(kind)(data="hello"))
    await stage.graph.settle()
    assert said("WARN") == ["/a is not bridged: there is no type strange_msgs/msg/Thing"]
    assert [message.data for message in ros] == ["hello"]


async def test_images(stage):
    kind = "sensor_msgs/msg/Image"
    images = heard(stage, kind, "/camera/color")
    bridge = ImageBridge(stage.graph, NodeOptions(arguments=["/camera"], remappings=[("/camera", "/camera/color")]))
    publisher(stage, kind, "/camera").publish(get_message(kind)(width=4))
    await stage.graph.settle()
    assert [message.width for message in images] == [4]
    bridge.close()
