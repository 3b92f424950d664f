"""Robots made for measuring."""

from __future__ import annotations

from pathlib import Path


def tree_robot(links: int, branching: int = 8) -> str:
    """A URDF with that many links, each with a box, joined by continuous joints into a tree."""
    parts = ['<?xml version="1.0"?>', '<robot name="tree">']
    for number in range(links):
        parts.append(
            f'<link name="link_{number}"><visual><geometry><box size="0.04 0.04 0.04"/></geometry></visual></link>'
        )
        if number:
            parent = (number - 1) // branching
            angle = number % branching
            parts.append(
                f'<joint name="joint_{number}" type="continuous"><parent link="link_{parent}"/>'
                f'<child link="link_{number}"/><origin xyz="{0.1 + 0.02 * angle:.2f} {0.05 * angle - 0.2:.2f} 0.08"/>'
                '<axis xyz="0 0 1"/></joint>'
            )
    parts.append("</robot>")
    return "\n".join(parts)


SWEEP_LAUNCH = """
from launch import LaunchDescription
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

def generate_launch_description():
    description = open({model!r}).read()
    return LaunchDescription([
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[{{"robot_description": ParameterValue(description, value_type=str),
                          "publish_frequency": 100.0}}]),
        Node(package="joint_state_publisher", executable="joint_state_publisher",
             parameters=[{{"rate": {rate}, "delta": 0.01}}]),
        Node(package="rviz2", executable="rviz2", arguments=["-d", {rviz!r}]),
    ])
"""
"""A launch file in which every joint moves at a rate."""

TREE_RVIZ = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Description Topic: {Value: /robot_description}
      Enabled: true
      Name: RobotModel
      Value: true
    - Class: rviz_default_plugins/TF
      Enabled: true
      Name: TF
      Value: true
  Global Options: {Fixed Frame: link_0, Frame Rate: 30}
"""


def write_sweep(folder: Path, links: int, rate: int) -> Path:
    """Write a tree robot, its .rviz file and a launch file that sweeps all joints; returns the launch file."""
    model = folder / "tree.urdf"
    model.write_text(tree_robot(links), encoding="utf-8")
    rviz = folder / "tree.rviz"
    rviz.write_text(TREE_RVIZ, encoding="utf-8")
    launch = folder / "sweep.launch.py"
    launch.write_text(SWEEP_LAUNCH.format(model=str(model), rate=rate, rviz=str(rviz)), encoding="utf-8")
    return launch
