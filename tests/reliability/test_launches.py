"""Simultaneous launches, large launches, and their visibility to other processes."""

from __future__ import annotations

from pathlib import Path

import psutil
import pytest

from tests.reliability.running import Machine, launch_file_text
from tests.waiting import wait_until

ROBOT = Path(__file__).parents[2] / "robots" / "my_robot_description"


@pytest.mark.slow
def test_two_equal_launches_warn_and_both_work(machine: Machine) -> None:
    actions = (
        "Node(package='demo_nodes_cpp', executable='talker')",
        "Node(package='demo_nodes_cpp', executable='listener')",
    )
    path = machine.write("a.launch.py", launch_file_text(*actions))
    launches = [machine.launch(path), machine.launch(path)]
    for launch in launches:
        launch.wait_for("has nodes with the same names")
        launch.wait_for("I heard: ", times=4)
    for launch in launches:
        assert launch.count("Another process has a node") == 0
    assert machine.verb("node", "list").count("/talker") == 2
    assert launches[0].interrupt() == 130
    before = launches[1].count("I heard: ")
    launches[1].wait_for("I heard: ", times=before + 2)
    assert machine.verb("node", "list").count("/talker") == 1


@pytest.mark.slow
def test_launch_starts_five_hundred_nodes(machine: Machine) -> None:
    path = machine.write(
        "a.launch.py",
        "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n\n\n"
        "def generate_launch_description():\n    return LaunchDescription([\n"
        "        Node(package='tf2_ros', executable='static_transform_publisher', name=f'frames_{number}',\n"
        "             arguments=['--frame-id', 'base', '--child-frame-id', f'frame_{number}'])\n"
        "        for number in range(500)])\n",
    )
    launch = machine.launch(path)
    launch.wait_for("started in the launcher's process", times=500)
    names = {f"/frames_{number}" for number in range(500)}
    wait_until(lambda: set(machine.verb("node", "list", seconds=30.0).split()) >= names)
    late_program = machine.program(
        """
        from tf2_msgs.msg import TFMessage

        class Program(Node):
            def __init__(self):
                super().__init__("late")
                self.frames = set()
                lasting = QoSProfile(
                    depth=0, history=HistoryPolicy.KEEP_ALL, durability=DurabilityPolicy.TRANSIENT_LOCAL
                )
                self.create_subscription(TFMessage, "/tf_static", self.hear, lasting)

            def hear(self, message):
                self.frames.update(transform.child_frame_id for transform in message.transforms)
                say("frames", len(self.frames))
        """
    )
    late_program.wait_for("frames 500")
    assert launch.interrupt() == 130
    wait_until(lambda: not launch.left_behind())


def test_late_subscriber_receives_description_and_static_transforms(machine: Machine) -> None:
    model = ROBOT / "urdf" / "mbot_with_laser.urdf"
    launch = machine.launch(ROBOT / "launch" / "display.launch.py", f"model:={model}")
    launch.wait_for("Robot initialized")
    late_program = machine.program(
        """
        from rclpy.time import Time
        from tf2_ros import Buffer, TransformListener

        class Program(Node):
            def __init__(self):
                super().__init__("late")
                lasting = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
                self.create_subscription(String, "robot_description", self.hear, lasting)
                self.buffer = Buffer()
                self.listener = TransformListener(self.buffer, self, spin_thread=True)
                self.create_timer(0.1, self.look)

            def hear(self, message):
                say("described", message.data.count("<link "))

            def look(self):
                for name in self.buffer.all_frames_as_yaml().splitlines():
                    if name.startswith("laser_link"):
                        say("frame", name)
        """
    )
    late_program.wait_for("described")
    late_program.wait_for("frame laser_link")
    assert late_program.count("described") == 1
    echoed = machine.verb("topic", "echo", "/tf_static", "--once")
    assert "child_frame_id: laser_link" in echoed


def test_process_without_dds_works_in_isolation(machine: Machine) -> None:
    """A process with LINKWRIGHT_DDS=0 works in isolation.

    It has no socket for other processes, and discovers no nodes.
    """
    path = machine.write(
        "a.launch.py",
        launch_file_text(
            "Node(package='demo_nodes_cpp', executable='talker')",
            "Node(package='demo_nodes_cpp', executable='listener')",
        ),
    )
    isolated, connected = machine.launch(path, LINKWRIGHT_DDS="0"), machine.launch(path)
    for process in (isolated, connected):
        process.wait_for("I heard: ", times=3)
    sockets = psutil.Process(isolated.process.pid).net_connections("udp")
    assert sockets == []
    assert machine.verb("node", "list").split() == ["/listener", "/talker"]
    deaf = machine.command("node", "list", LINKWRIGHT_DDS="0")
    assert deaf.wait() == 1
    assert "unset LINKWRIGHT_DDS" in deaf.text
    assert not isolated.count("Another process")
    assert isolated.interrupt() == connected.interrupt() == 130


def test_launch_leaves_no_threads_or_processes(machine: Machine) -> None:
    """An interrupted launch leaves no threads or processes.

    They are seen from outside.
    """
    program = machine.write("p.py", "import time\nprint('up', flush=True)\ntime.sleep(60)\n")
    path = machine.write(
        "a.launch.py",
        launch_file_text(
            "Node(package='demo_nodes_cpp', executable='talker')",
            "Node(package='rviz2', executable='rviz2')",
            f"ExecuteProcess(cmd=[sys.executable, {str(program)!r}], output='screen')",
            f"ExecuteProcess(cmd=[sys.executable + ' ' + {str(program)!r}], shell=True, output='screen')",
        ),
    )
    launch = machine.launch(path, "--isolate")
    launch.wait_for("up", times=2)
    launch.wait_for("Publishing")
    assert "/talker" in machine.verb("node", "list").split()
    assert len(launch.left_behind()) >= 5
    status = launch.interrupt()
    assert status == 130
    assert launch.left_behind() == []
