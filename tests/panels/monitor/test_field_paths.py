"""Paths to numeric fields of messages."""

from __future__ import annotations

import pytest

from linkwright.messages import get_message
from linkwright.panels.monitor.field_paths import FieldPath, FieldPathError, find_plot_fields

JOINT_STATE = get_message("sensor_msgs/msg/JointState")
ODOMETRY = get_message("nav_msgs/msg/Odometry")
TF = get_message("tf2_msgs/msg/TFMessage")
DIAGNOSTICS = get_message("diagnostic_msgs/msg/DiagnosticArray")


def make_joint_state():
    message = JOINT_STATE(name=["elbow", "wrist"], position=[0.5, -1.5], velocity=[2.0])
    message.header.stamp.sec, message.header.stamp.nanosec = 12, 500_000_000
    return message


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("position[1]", -1.5),
        ("position[elbow]", 0.5),
        ("header.stamp", 12.5),
        ("header.stamp.sec", 12.0),
        ("position[7]", None),
        ("position[shoulder]", None),
        ("velocity[wrist]", None),
    ],
)
def test_field_path_returns_number_or_none(path, value):
    field_path = FieldPath(path)
    field_path.check(JOINT_STATE)
    assert field_path.value(make_joint_state()) == value


def test_field_path_reads_nested_messages():
    message = ODOMETRY()
    message.twist.twist.linear.x = 0.25
    message.pose.covariance[35] = 3.0
    for path, value in (("twist.twist.linear.x", 0.25), ("pose.covariance[35]", 3.0)):
        field_path = FieldPath(path)
        field_path.check(ODOMETRY)
        assert field_path.value(message) == value


def test_array_elements_are_selected_by_frame_id():
    message = TF(transforms=[get_message("geometry_msgs/msg/TransformStamped")() for _ in range(2)])
    message.transforms[1].child_frame_id = "base_link"
    message.transforms[1].transform.translation.x = 4.0
    field_path = FieldPath("transforms[base_link].transform.translation.x")
    field_path.check(TF)
    assert field_path.value(message) == 4.0


def test_trajectory_points_are_selected_by_joint_name():
    point = get_message("trajectory_msgs/msg/JointTrajectoryPoint")(positions=[1.0, 2.0])
    message = get_message("trajectory_msgs/msg/JointTrajectory")(joint_names=["a", "b"], points=[point])
    assert FieldPath("points[0].positions[b]").value(message) == 2.0


def test_booleans_and_bytes_are_numbers():
    assert FieldPath("data").value(get_message("std_msgs/msg/Bool")(data=True)) == 1.0
    status = get_message("diagnostic_msgs/msg/DiagnosticStatus")(name="motor", level=b"\x02")
    field_path = FieldPath("status[motor].level")
    field_path.check(DIAGNOSTICS)
    assert field_path.value(DIAGNOSTICS(status=[status])) == 2.0


@pytest.mark.parametrize("text", ["", ".x", "x.", "x..y", "x[", "x[]", "x[1]y", "1x", "x y"])
def test_malformed_field_path_is_rejected(text):
    with pytest.raises(FieldPathError, match="is not a field"):
        FieldPath(text)


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("positon[0]", "did you mean 'position'"),
        ("position", "select an element"),
        ("header[0]", "'header' is not an array"),
        ("name[0]", "is not a number"),
        ("header", "is not a number"),
        ("position[0].x", "has no fields"),
    ],
)
def test_field_path_to_non_number_is_rejected(path, message):
    with pytest.raises(FieldPathError, match=r".*" + message.replace("[", r"\[")):
        FieldPath(path).check(JOINT_STATE)


def test_field_path_beyond_fixed_array_is_rejected():
    with pytest.raises(FieldPathError, match="has 36 elements"):
        FieldPath("pose.covariance[36]").check(ODOMETRY)


def test_plot_fields_of_type_include_first_array_elements():
    assert [field.path for field in find_plot_fields(JOINT_STATE)] == [
        "header.stamp",
        "position[0]",
        "velocity[0]",
        "effort[0]",
    ]


def test_plot_fields_of_message_include_named_elements():
    fields = find_plot_fields(JOINT_STATE, make_joint_state())
    assert [field.path for field in fields] == ["header.stamp", "position[elbow]", "position[wrist]", "velocity[0]"]
    assert [field.kind for field in fields] == ["seconds", "double", "double", "double"]
    for field in fields:
        FieldPath(field.path).check(JOINT_STATE)
        assert FieldPath(field.path).value(make_joint_state()) is not None


def test_duplicate_names_are_not_used_in_plot_fields():
    message = JOINT_STATE(name=["a", "a", "5"], position=[1.0, 2.0, 3.0])
    paths = [field.path for field in find_plot_fields(JOINT_STATE, message)]
    assert "position[2]" in paths


def test_plot_fields_of_large_message_are_limited():
    image = get_message("sensor_msgs/msg/Image")(data=bytes(10_000))
    paths = [field.path for field in find_plot_fields(type(image), image)]
    assert paths[:3] == ["header.stamp", "height", "width"]
    assert sum(path.startswith("data[") for path in paths) == 64
