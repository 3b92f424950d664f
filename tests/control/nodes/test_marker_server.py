"""marker_server: an interactive marker that drives a robot when it is dragged."""

from __future__ import annotations

from math import cos, sin

import pytest

from linkwright.control.nodes.teleop.marker_server import MarkerServer
from linkwright.messages import get_message, get_service
from linkwright.nodes import NodeOptions
from linkwright.testing import SteppedGraph

FEEDBACK = get_message("visualization_msgs/msg/InteractiveMarkerFeedback")


@pytest.fixture
def test():
    with SteppedGraph() as graph:
        yield graph


def start_node(test, **parameters):
    MarkerServer(test.graph, NodeOptions(parameters=parameters))
    return test.record("/cmd_vel"), test.record("/twist_server/update")


def drag(test, name, x=0.0, y=0.0, z=0.0, yaw=0.0):
    message = FEEDBACK(marker_name=name)
    message.pose.position.x, message.pose.position.y, message.pose.position.z = x, y, z
    message.pose.orientation.z, message.pose.orientation.w = sin(yaw / 2), cos(yaw / 2)
    test.publish("/twist_server/feedback", message)
    test.settle()


def test_marker_has_controls_of_the_axes_that_drive(test):
    start_node(test, link_name="base_footprint", robot_name="rover", linear_scale={"x": 1.0, "y": 0.5})
    answer = test.call(
        "/twist_server/get_interactive_markers", get_service("visualization_msgs/srv/GetInteractiveMarkers").Request()
    )
    (marker,) = answer.markers
    assert (marker.header.frame_id, marker.name) == ("base_footprint", "rover_twist_marker")
    assert [control.name for control in marker.controls] == ["move_x", "move_y", "rotate_z"]
    assert [control.interaction_mode for control in marker.controls] == [3, 3, 5]
    for control in marker.controls:
        orientation = control.orientation
        assert orientation.x**2 + orientation.y**2 + orientation.z**2 + orientation.w**2 == pytest.approx(1.0)


def test_dragging_drives_within_the_limits_and_the_marker_returns(test):
    velocities, updates = start_node(test)
    drag(test, "robot_twist_marker", x=0.4, y=0.7, yaw=0.2)
    twist = velocities.last
    assert (twist.linear.x, twist.linear.y) == (pytest.approx(0.4), 0.0)
    assert twist.angular.z == pytest.approx(0.44)
    drag(test, "robot_twist_marker", x=-9.0, yaw=-2.0)
    assert (velocities.last.linear.x, velocities.last.angular.z) == (-1.0, -2.2)
    (pose,) = updates.last.poses
    assert (pose.name, pose.pose.position.x, pose.pose.orientation.w) == ("robot_twist_marker", 0.0, 1.0)
    numbers = [update.seq_num for update in updates]
    assert numbers == sorted(set(numbers))
    drag(test, "marker_of_others", x=0.1)
    assert len(velocities) == 2


def test_axes_have_scales_and_limits_of_their_own(test):
    velocities, _ = start_node(
        test,
        linear_scale={"x": 2.0, "z": 1.0},
        max_positive_linear_velocity={"x": 0.5, "z": 3.0},
        max_negative_linear_velocity={"x": -0.2, "z": -3.0},
    )
    drag(test, "robot_twist_marker", x=1.0, y=1.0, z=-2.0)
    linear = velocities.last.linear
    assert (linear.x, linear.y, linear.z) == (0.5, 0.0, -2.0)
