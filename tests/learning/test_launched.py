"""Checks of a launch.

They find nodes, messages and transforms, and report missing ones after a short wait.
"""

import shutil
import time

import pytest

from linkwright.learning import NotYet, Work
from tests.domains import own_domain
from tests.places import PACKAGE

PROGRAM = """import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("talker")
node.declare_parameter("greeting", "hello")
publisher = node.create_publisher(String, "greeting", 10)
node.create_timer(0.1, lambda: publisher.publish(String(data="hello")))
rclpy.spin(node)
"""

LAUNCH = """from launch import LaunchDescription
from launch.actions import ExecuteProcess
import sys

def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=[sys.executable, {program!r}])])
"""


@pytest.fixture
def package(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", str(own_domain()))
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    shutil.copytree(PACKAGE, tmp_path / "src" / PACKAGE.name)
    return Work(tmp_path, lesson=tmp_path).package(PACKAGE.name)


def test_launch_check_waits_for_nodes_messages_and_transforms(package):
    with package.launch("display.launch.py") as running:
        running.expect_node("/robot_state_publisher")
        assert "left_wheel_joint" in running.wait_for_message("/joint_states").name
        assert "<robot" in running.wait_for_message("/robot_description").data
        running.expect_transform("base_link", "left_wheel_link", (0, 0.19, -0.05))
        assert "/robot_state_publisher" in running.nodes()
        assert running.subscribers("/joint_states") == ["/robot_state_publisher"]
        assert running.wait_for_parameter("/robot_state_publisher", "publish_frequency") > 0
        begin = time.monotonic()
        with pytest.raises(NotYet, match="'/robot_state_publisher' has no parameter 'color'"):
            running.wait_for_parameter("/robot_state_publisher", "color")
        with pytest.raises(NotYet, match="no node '/robot_state_publishr'; there is '/robot_state_publisher'"):
            running.expect_node("/robot_state_publishr")
        with pytest.raises(NotYet, match="no topic '/jont_states'; there is '/joint_states'"):
            running.wait_for_message("/jont_states")
        with pytest.raises(NotYet, match=r"is at 0 0\.19 -0\.05 in 'base_link', but should be at 0 1 0"):
            running.expect_transform("base_link", "left_wheel_link", (0, 1, 0))
        with pytest.raises(NotYet, match="no transform from 'base_link' to 'arm'"):
            running.expect_transform("base_link", "arm")
        with pytest.raises(NotYet, match="no message with the expected values arrived on '/joint_states'"):
            running.wait_for_message("/joint_states", lambda message: not message.name)
        assert time.monotonic() - begin < 60


def test_failing_and_missing_launch_files_are_reported(package):
    (package.folder / "launch" / "bad.launch.py").write_text("import nonsense_module\n")
    with pytest.raises(NotYet, match=r"bad\.launch\.py"), package.launch("bad.launch.py"):
        pass
    with pytest.raises(NotYet, match=r"has no file 'launch/displai\.launch\.py'"):
        package.launch("displai.launch.py")


BEST_EFFORT = """import rclpy
from rclpy.qos import qos_profile_sensor_data
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("sensor")
publisher = node.create_publisher(String, "measured", qos_profile_sensor_data)
node.create_timer(0.1, lambda: publisher.publish(String(data="1 m")))
rclpy.spin(node)
"""


def test_best_effort_messages_are_received(package):
    program = package.folder / "sensor.py"
    program.write_text(BEST_EFFORT)
    (package.folder / "launch" / "sensor.launch.py").write_text(LAUNCH.format(program=str(program)))
    with package.launch("sensor.launch.py") as running:
        assert running.wait_for_message("/measured").data == "1 m"


VOICE = """from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    commands = {{'commands_file': {commands!r}, 'engine': ''}}
    return LaunchDescription([
        Node(package='demo_nodes_cpp', executable='listener'),
        Node(package='my_robot_voice', executable='voice_commander', parameters=[commands]),
    ])
"""


def test_unpublished_topic_and_launch_error_are_reported(package):
    launch = package.folder / "launch" / "voice.launch.py"
    launch.write_text(VOICE.format(commands=""))
    with (
        package.launch("voice.launch.py") as running,
        pytest.raises(NotYet, match=r"^no node publishes '/voice/text_input'; the running nodes are '/"),
    ):
        running.wait_for_message("/voice/text_input")
    launch.write_text(VOICE.format(commands="missing.yaml"))
    with (
        package.launch("voice.launch.py") as running,
        pytest.raises(NotYet, match=r"no node publishes '/voice/text'; the launch says: .*missing\.yaml"),
    ):
        running.wait_for_message("/voice/text")


DYING = """from launch import LaunchDescription
from launch.actions import ExecuteProcess
import sys

def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=[sys.executable, {program!r}], name='talker')])
"""


def test_last_line_of_traceback_stands_for_process_that_has_died(package):
    program = package.folder / "talker.py"
    program.write_text("raise Exception('the value is a text')")
    (package.folder / "launch" / "dying.launch.py").write_text(DYING.format(program=str(program)))
    with pytest.raises(NotYet, match="Exception: the value is a text"), package.launch("dying.launch.py") as running:
        running.expect_node("/talker")


@pytest.mark.slow
def test_node_of_learner_is_discovered_over_network(package, tmp_path):
    program = tmp_path / "talker.py"
    program.write_text(PROGRAM)
    (package.folder / "launch" / "talk.launch.py").write_text(LAUNCH.format(program=str(program)))
    with package.launch("talk.launch.py") as running:
        running.expect_node("/talker")
        assert running.wait_for_parameter("/talker", "greeting") == "hello"
        assert running.wait_for_message("/greeting").data == "hello"
