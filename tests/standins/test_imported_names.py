"""Names that modules offer only because ROS's modules import them.

Many programs use these names.
"""

from __future__ import annotations

import importlib
import typing

import geometry_msgs.msg
import pytest
import rclpy
import tf2_ros
from action_msgs.msg import GoalStatus
from rcl_interfaces.msg import ParameterType
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.duration import Duration
from rclpy.task import Future


@pytest.mark.parametrize(
    ("module", "name", "origin"),
    [
        ("rclpy.time", "Duration", Duration),
        ("rclpy.qos", "Duration", Duration),
        ("rclpy.executors", "Future", Future),
        ("rclpy.client", "Future", Future),
        ("rclpy.action.client", "GoalStatus", GoalStatus),
        ("rclpy.node", "MutuallyExclusiveCallbackGroup", MutuallyExclusiveCallbackGroup),
        ("rclpy.node", "Optional", typing.Optional),
        ("rclpy.parameter", "ParameterType", ParameterType),
        ("tf2_ros", "TransformStamped", geometry_msgs.msg.TransformStamped),
        ("tf2_ros", "Duration", Duration),
        ("tf2_geometry_msgs", "PoseStamped", geometry_msgs.msg.PoseStamped),
    ],
)
def test_names_imported_by_ros_modules_are_available(module, name, origin):
    assert getattr(importlib.import_module(module), name) is origin


def test_submodules_are_available_after_package_import():
    assert rclpy.qos.QoSProfile is importlib.import_module("rclpy.qos").QoSProfile
    assert tf2_ros.transform_listener.TransformListener is tf2_ros.TransformListener


@pytest.mark.parametrize("module", ["rclpy.time", "rclpy", "tf2_ros", "tf2_geometry_msgs"])
def test_unknown_and_private_names_are_missing(module):
    assert not hasattr(importlib.import_module(module), "Durations")
    assert not hasattr(importlib.import_module(module), "_private")
