"""The nodes that a launch file or a command can name: package and executable to what starts one in this process.

A node's module is imported when the first of its kind is started.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module

from linkwright.graph import Graph
from linkwright.nodes.options import Factory, NodeOptions, RunningNode


def _lazy(module: str, name: str) -> Factory:
    def start(graph: Graph, options: NodeOptions) -> RunningNode:
        factory: Factory = getattr(import_module(f"linkwright.nodes.{module}"), name)
        return factory(graph, options)

    return start


EXECUTABLES: Mapping[tuple[str, str], Factory] = {
    ("robot_state_publisher", "robot_state_publisher"): _lazy("robot_state_publisher", "RobotStatePublisher"),
    ("joint_state_publisher", "joint_state_publisher"): _lazy("joint_state_publisher", "JointStatePublisher"),
    ("joint_state_publisher_gui", "joint_state_publisher_gui"): _lazy(
        "joint_state_publisher_gui", "JointStatePublisherGui"
    ),
    ("tf2_ros", "static_transform_publisher"): _lazy("static_transform_publisher", "StaticTransformPublisher"),
    ("tf2_ros", "tf2_echo"): _lazy("tf2_echo", "Tf2Echo"),
    ("tf2_ros", "tf2_monitor"): _lazy("tf2_monitor", "Tf2Monitor"),
    ("tf2_ros", "buffer_server"): _lazy("tf2_buffer_server", "Tf2BufferServer"),
    ("tf2_tools", "view_frames"): _lazy("view_frames", "ViewFrames"),
    ("rclcpp_components", "component_container"): _lazy("component_container", "ComponentContainer"),
    ("rclcpp_components", "component_container_mt"): _lazy("component_container", "ComponentContainer"),
    ("rclcpp_components", "component_container_isolated"): _lazy("component_container", "ComponentContainer"),
    ("demo_nodes_cpp", "talker"): _lazy("demo_talker", "Talker"),
    ("demo_nodes_cpp", "listener"): _lazy("demo_listener", "Listener"),
    ("demo_nodes_py", "talker"): _lazy("demo_talker", "Talker"),
    ("demo_nodes_py", "listener"): _lazy("demo_listener", "Listener"),
    ("demo_nodes_py", "talker_qos"): _lazy("demo_talker_qos", "TalkerQos"),
    ("demo_nodes_py", "listener_qos"): _lazy("demo_talker_qos", "ListenerQos"),
    ("demo_nodes_py", "add_two_ints_server"): _lazy("add_two_ints", "AddTwoIntsServer"),
    ("demo_nodes_py", "add_two_ints_client"): _lazy("add_two_ints", "AddTwoIntsClient"),
    ("demo_nodes_cpp", "add_two_ints_server"): _lazy("add_two_ints", "AddTwoIntsServer"),
    ("demo_nodes_cpp", "add_two_ints_client"): _lazy("add_two_ints", "AddTwoIntsClient"),
    ("foxglove_bridge", "foxglove_bridge"): _lazy("foxglove", "FoxgloveBridge"),
    ("image_tools", "cam2image"): _lazy("demo_camera", "DemoCamera"),
}
