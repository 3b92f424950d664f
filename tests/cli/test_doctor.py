"""``linkwright doctor``: problems of a running graph are found and explained."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from linkwright.cli import main
from linkwright.graph import STATIC_TF_PUBLISHER_QOS, TF_QOS, Graph, QoSProfile, ReliabilityPolicy
from linkwright.messages import Header, JointState, TFMessage, Time, TransformStamped, get_message
from linkwright.nodes import NodeOptions
from linkwright.nodes.joint_state_publisher import JointStatePublisher
from linkwright.nodes.robot_state_publisher import RobotStatePublisher
from linkwright.wire import dds

ROBOT = """\
<robot name="mbot">
  <link name="base"/><link name="wheel"/><link name="mast"/>
  <joint name="spin" type="continuous"><parent link="base"/><child link="wheel"/></joint>
  <joint name="stand" type="fixed"><parent link="base"/><child link="mast"/></joint>
</robot>
"""
DESCRIBED: dict[str, Any] = {"robot_description": ROBOT}


def create_robot(graph: Graph) -> None:
    RobotStatePublisher(graph, NodeOptions(parameters=DESCRIBED))
    JointStatePublisher(graph, NodeOptions(parameters=DESCRIBED))


def run_doctor(capsys, *words: str, status: int) -> str:
    assert main(["doctor", "--seconds", "1", *words]) == status
    captured = capsys.readouterr()
    return captured.out + captured.err


def test_healthy_robot_has_no_problems(add_to_graph, capsys):
    add_to_graph(create_robot)
    assert "No problems found: 2 nodes, 6 topics, 3 frames" in run_doctor(capsys, status=0)


def test_missing_joint_states_publisher_is_reported(add_to_graph, capsys):
    add_to_graph(lambda graph: RobotStatePublisher(graph, NodeOptions(parameters=DESCRIBED)))
    output = run_doctor(capsys, status=1)
    assert "[DOC401]: no node publishes joint states, so there is no transform of frame 'wheel'" in output
    assert "start joint_state_publisher" in output


def test_doctor_output_is_translated_to_chinese(add_to_graph, capsys):
    add_to_graph(lambda graph: RobotStatePublisher(graph, NodeOptions(parameters=DESCRIBED)))
    output = run_doctor(capsys, "--lang", "zh", status=1)
    assert "正在观察运行中的计算图，1 秒……\n" in output
    assert "没有节点发布关节状态，所以坐标系“wheel”没有变换" in output
    assert "1 个问题；1 个节点、" in output


def test_misspelled_joint_name_is_reported(add_to_graph, capsys):
    def make(graph: Graph) -> None:
        RobotStatePublisher(graph, NodeOptions(parameters=DESCRIBED))
        node = graph.create_node("driver")
        publisher = node.create_publisher(JointState, "joint_states", 10)

        def publish() -> None:
            stamp = node.get_clock().now().to_msg()
            publisher.publish(JointState(header=Header(stamp=stamp), name=["spinn"], position=[0.0]))

        node.create_timer(0.05, publish)

    add_to_graph(make)
    output = run_doctor(capsys, status=1)
    assert "joint 'spin' is not in the joint states, so there is no transform of frame 'wheel'" in output
    assert "did you mean 'spinn'?" in output


def make_transform(parent: str, child: str, stamp: Time | None = None) -> TransformStamped:
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.transform.rotation.w = 1.0
    if stamp is not None:
        message.header.stamp = stamp
    return message


def create_second_publisher(graph: Graph) -> None:
    create_robot(graph)
    node = graph.create_node("odometry")
    publisher = node.create_publisher(TFMessage, "/tf", TF_QOS)
    node.create_timer(
        0.05,
        lambda: publisher.publish(
            TFMessage(transforms=[make_transform("base", "wheel", node.get_clock().now().to_msg())])
        ),
    )


def test_two_publishers_of_same_transform_are_reported(add_to_graph, capsys):
    add_to_graph(create_second_publisher)
    output = run_doctor(capsys, status=1)
    assert "2 nodes publish the transform of frame 'wheel': '/odometry', '/robot_state_publisher'" in output


def test_disconnected_trees_and_missing_fixed_frame_are_reported(add_to_graph, capsys, tmp_path: Path):
    def make(graph: Graph) -> None:
        create_robot(graph)
        publisher = graph.create_node("camera").create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)
        publisher.publish(TFMessage(transforms=[make_transform("camera", "lens")]))

    add_to_graph(make)
    rviz = tmp_path / "robot.rviz"
    rviz.write_text("Visualization Manager:\n  Global Options:\n    Fixed Frame: map\n", encoding="utf-8")
    output = run_doctor(capsys, "--rviz", str(rviz), status=1)
    assert "the frames form 2 separate trees" in output
    assert "the fixed frame 'map' of '" in output
    assert "robot.rviz' does not exist, so nothing is shown" in output


def test_fixed_frame_of_viewer_is_checked(add_to_graph, capsys):
    def make(graph: Graph) -> None:
        create_robot(graph)
        viewer = graph.create_node("rviz2", parameters={"fixed_frame": "odom"})
        viewer.declare_parameter("fixed_frame", "map")
        viewer.create_subscription(TFMessage, "/tf", print, TF_QOS)

    add_to_graph(make)
    assert "the fixed frame 'odom' of '/rviz2' does not exist" in run_doctor(capsys, status=1)


def test_stamps_far_from_clock_are_reported(add_to_graph, capsys):
    def make(graph: Graph) -> None:
        node = graph.create_node("lidar")
        publisher = node.create_publisher("sensor_msgs/msg/LaserScan", "scan", 5)
        message = get_message("sensor_msgs/msg/LaserScan")()
        message.header.stamp.sec = 1000
        node.create_timer(0.05, lambda: publisher.publish(message))

    add_to_graph(make)
    assert "the stamps of '/lidar' on '/scan' are" in run_doctor(capsys, status=1)


def test_twist_type_qos_and_unserved_client_problems_are_reported(add_to_graph, capsys):
    def make(graph: Graph) -> None:
        graph.create_node("teleop").create_publisher("geometry_msgs/msg/Twist", "cmd_vel", 10)
        base = graph.create_node("base")
        base.create_subscription("geometry_msgs/msg/TwistStamped", "cmd_vel", print, 10)
        best_effort = QoSProfile(5, ReliabilityPolicy.BEST_EFFORT)
        graph.create_node("lidar").create_publisher("sensor_msgs/msg/LaserScan", "scan", best_effort)
        base.create_subscription("sensor_msgs/msg/LaserScan", "scan", print, 10)
        base.create_client("std_srvs/srv/Empty", "reset")

    add_to_graph(make)
    output = run_doctor(capsys, status=1)
    assert "topic '/cmd_vel' carries Twist for some nodes and TwistStamped for others" in output
    reports_mismatch = "reliability: '/lidar' offers BEST_EFFORT, '/base' requests RELIABLE" in output
    assert reports_mismatch is dds.is_available()  # over Zenoh, reliability does not prevent a connection
    assert "no node provides service '/reset', which '/base' calls" in output


def test_mixed_use_sim_time_is_reported(add_to_graph, capsys):
    def make(graph: Graph) -> None:
        graph.create_node("one", parameters={"use_sim_time": True})
        graph.create_node("two")

    add_to_graph(make)
    output = run_doctor(capsys, status=1)
    assert "use_sim_time is true for '/one', but no node publishes /clock" in output
    assert "use_sim_time is true for '/one', but false for '/two'" in output


def test_empty_graph_is_reported(add_to_graph, capsys):
    add_to_graph(lambda graph: None)
    assert "no running nodes were found" in run_doctor(capsys, status=1)


@pytest.mark.parametrize("form", ["json", "concise"])
def test_json_and_other_formats_are_printed(add_to_graph, capsys, form):
    add_to_graph(create_second_publisher)
    assert main(["doctor", "--seconds", "1", "--format", form]) == 1
    printed = capsys.readouterr().out
    if form == "json":
        assert [diagnostic["code"] for diagnostic in json.loads(printed)["diagnostics"]] == ["DOC302"]
    else:
        assert "DOC302" in printed


def test_report_has_sections_of_ros2_doctor(add_to_graph, capsys):
    add_to_graph(create_robot)
    output = run_doctor(capsys, "--report", status=0)
    for title in ("PLATFORM INFORMATION", "RMW MIDDLEWARE", "PACKAGE VERSIONS", "NETWORK CONFIGURATION"):
        assert f"\n   {title}\n" in output
    assert re.search(r"^topic \[type\] +: /joint_states \[sensor_msgs/msg/JointState\]$", output, re.MULTILINE)
    assert re.search(r"^compatibility status +: OK$", output, re.MULTILINE)
    assert re.search(r"^publisher count +: 1$", output, re.MULTILINE)


def test_report_failed_prints_only_with_problems(add_to_graph, capsys):
    add_to_graph(create_robot)
    assert "PLATFORM" not in run_doctor(capsys, "--report-failed", status=0)


def test_parameter_file_sections_without_nodes_are_reported(add_to_graph, capsys, tmp_path):
    add_to_graph(create_robot)
    path = tmp_path / "params.yaml"
    sections = ("/**", "robot_state_publisher", "joint_state_publsher", "/left/*")
    path.write_text("".join(f"{section}: {{ros__parameters: {{a: 1}}}}\n" for section in sections))
    output = run_doctor(capsys, "--params-file", str(path), status=1)
    assert output.count("DOC702") == 2
    assert "section '/joint_state_publsher' of" in output
    assert "did you mean '/joint_state_publisher'" in output
    assert "section '/left/*' of" in output
