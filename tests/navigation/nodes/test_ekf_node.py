"""`ekf_node`: odometry and IMU in, filtered odometry and transforms out."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import quaternion_from_rpy, rpy_from_quaternion
from linkwright.graph import STATIC_TF_PUBLISHER_QOS, TF_QOS
from linkwright.messages import TFMessage, Time, TransformBatch, get_message, get_service
from linkwright.navigation.nodes.robot_localization.ekf import EkfNode, UkfNode
from linkwright.nodes import NodeOptions
from linkwright.testing.stepped import AsyncSteppedGraph

X, Y, YAW, VX, VY, VYAW, AX = 0, 1, 5, 6, 7, 11, 12
START_S = 100.0


def sensor_config(*measured_indices):
    return [index in measured_indices for index in range(15)]


@pytest.fixture
async def test():
    async with AsyncSteppedGraph(start=START_S) as graph:
        yield graph


def start_node(test, node_type=EkfNode, **parameters):
    return node_type(test.graph, NodeOptions(parameters={"frequency": 10.0, "two_d_mode": True, **parameters}))


def log_texts(test, level):
    return [record.text for record in test.log if record.level.name == level]


def set_header(message, seconds, frame):
    message.header.stamp = Time.from_nanoseconds(round(seconds * 1e9))
    message.header.frame_id = frame
    return message


def now_s(test):
    return test.clock.now_ns() / 1e9


def make_odometry(test, x=0.0, y=0.0, yaw=0.0, vx=0.0, vyaw=0.0, variance=0.01, stamp=None, frame="odom"):
    message = set_header(get_message("nav_msgs/msg/Odometry")(), now_s(test) if stamp is None else stamp, frame)
    message.child_frame_id = "base_link"
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    orientation = message.pose.pose.orientation
    orientation.x, orientation.y, orientation.z, orientation.w = quaternion_from_rpy((0.0, 0.0, yaw))
    message.twist.twist.linear.x, message.twist.twist.angular.z = vx, vyaw
    message.pose.covariance = message.twist.covariance = np.eye(6).reshape(36) * variance
    return message


def make_imu(test, yaw=0.0, vyaw=0.0, acceleration=(0.0, 0.0, 0.0), frame="base_link", variance=0.001):
    message = set_header(get_message("sensor_msgs/msg/Imu")(), now_s(test), frame)
    orientation, acc = message.orientation, message.linear_acceleration
    orientation.x, orientation.y, orientation.z, orientation.w = quaternion_from_rpy((0.0, 0.0, yaw))
    message.angular_velocity.z = vyaw
    acc.x, acc.y, acc.z = acceleration
    for name in ("orientation", "angular_velocity", "linear_acceleration"):
        setattr(message, f"{name}_covariance", np.eye(3).reshape(9) * variance)
    return message


def publish_transform(test, parent, child, x=0.0, y=0.0, yaw=0.0, static=False):
    pose = np.array([[x, y, 0.0, *quaternion_from_rpy((0.0, 0.0, yaw))]])
    message = TFMessage(batch=TransformBatch((parent,), (child,), test.clock.now_ns(), pose))
    test.publish("/tf_static" if static else "/tf", message, STATIC_TF_PUBLISHER_QOS if static else TF_QOS)


def planar_pose(message):
    """Return x, y and yaw of an Odometry message."""
    turn = message.pose.pose.orientation
    _, _, yaw = rpy_from_quaternion((turn.x, turn.y, turn.z, turn.w))
    return message.pose.pose.position.x, message.pose.pose.position.y, yaw


async def test_odometry_and_gyroscope_are_fused(test):
    start_node(
        test,
        odom0="wheels",
        odom0_config=sensor_config(VX, VY),
        imu0="imu",
        imu0_config=sensor_config(VYAW),
        frequency=30.0,
    )
    filtered, tf = test.record("/odometry/filtered"), test.record("/tf")
    for _ in range(200):
        test.publish("/wheels", make_odometry(test, vx=1.0, vyaw=9.0, variance=1e-4))
        test.publish("/imu", make_imu(test, yaw=2.0, vyaw=0.5, variance=1e-6))
        await test.advance(0.01)
    turned = 0.5 * (filtered.last.header.stamp.nanoseconds / 1e9 - START_S)
    x, y, yaw = planar_pose(filtered.last)
    assert yaw == pytest.approx(turned, abs=1e-2)
    assert (x, y) == pytest.approx((2.0 * sin(turned), 2.0 * (1.0 - cos(turned))), abs=2e-2)
    assert filtered.last.header.frame_id == "odom"
    assert filtered.last.child_frame_id == "base_link"
    assert filtered.last.twist.twist.linear.x == pytest.approx(1.0, abs=1e-3)
    assert 55 <= len(filtered) <= 60
    (transform,) = tf.last.transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("odom", "base_link")
    assert transform.transform.translation.x == x
    assert transform.header.stamp == filtered.last.header.stamp


async def test_publishing_starts_with_first_measurement_and_continues(test):
    start_node(test, odom0="wheels", odom0_config=sensor_config(VX))
    filtered = test.record("/odometry/filtered")
    await test.advance(1.0)
    assert len(filtered) == 0
    test.publish("/wheels", make_odometry(test, vx=1.0))
    await test.advance(1.0)
    assert planar_pose(filtered.last)[0] == pytest.approx(1.0, abs=1e-6)
    assert filtered.last.pose.covariance[0] > filtered[0].pose.covariance[0]


async def test_outlier_is_rejected(test):
    parameters = {"odom0": "wheels", "odom0_config": sensor_config(X, Y, YAW), "odom0_pose_rejection_threshold": 4.0}
    start_node(test, **parameters)
    filtered = test.record("/odometry/filtered")
    for step in range(50):
        test.publish("/wheels", make_odometry(test, x=100.0 if step == 40 else 0.0))
        await test.advance(0.1)
    assert max(abs(planar_pose(message)[0]) for message in filtered) < 1e-6


async def test_imu_with_rotation_and_offset_is_transformed(test):
    start_node(test, imu0="imu", imu0_config=sensor_config(YAW, VYAW, AX), publish_acceleration=True)
    filtered, acceleration = test.record("/odometry/filtered"), test.record("/accel/filtered")
    publish_transform(test, "base_link", "imu_link", x=0.3, yaw=pi / 2, static=True)
    await test.settle()
    for _ in range(30):
        test.publish("/imu", make_imu(test, yaw=0.4 + pi / 2, acceleration=(0.7, 0.0, 0.0), frame="imu_link"))
        await test.advance(0.1)
    assert planar_pose(filtered.last)[2] == pytest.approx(0.4, abs=1e-3)
    assert acceleration.last.accel.accel.linear.y == pytest.approx(0.7, abs=1e-3)
    assert acceleration.last.header.frame_id == "base_link"


async def test_gravity_is_removed_if_configured(test):
    flags = {"imu0": "imu", "imu0_config": sensor_config(AX, 14), "two_d_mode": False, "publish_acceleration": True}
    start_node(test, **flags, imu0_remove_gravitational_acceleration=True)
    acceleration = test.record("/accel/filtered")
    for _ in range(5):
        test.publish("/imu", make_imu(test, acceleration=(0.2, 0.0, 9.80665)))
        await test.advance(0.1)
    linear = acceleration.last.accel.accel.linear
    assert (linear.x, linear.z) == pytest.approx((0.2, 0.0), abs=1e-6)


async def test_missing_frame_is_reported(test):
    start_node(test, imu0="imu", imu0_config=sensor_config(VYAW))
    filtered = test.record("/odometry/filtered")
    for _ in range(3):
        test.publish("/imu", make_imu(test, frame="nowhere"))
        await test.advance(0.1)
    assert len(filtered) == 0
    (text,) = log_texts(test, "WARN")
    assert text.startswith('Could not obtain transform: "base_link"')


async def test_map_world_frame_publishes_odom_transform(test):
    start_node(test, pose0="fix", pose0_config=sensor_config(X, Y, YAW), world_frame="map", transform_time_offset=0.5)
    tf = test.record("/tf", TFMessage)
    publish_transform(test, "odom", "base_link", x=2.0)
    pose = set_header(get_message("geometry_msgs/msg/PoseWithCovarianceStamped")(), now_s(test), "map")
    pose.pose.pose.position.x, pose.pose.pose.orientation.w = 5.0, 1.0
    test.publish("/fix", pose)
    await test.advance(0.1)
    (transform,) = tf.last.transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("map", "odom")
    assert transform.transform.translation.x == pytest.approx(3.0)
    assert transform.header.stamp.nanoseconds == round((START_S + 0.5) * 1e9)


async def test_differential_and_relative_poses_are_fused(test):
    start_node(test, odom0="wheels", odom0_config=sensor_config(X, Y, YAW), odom0_differential=True)
    start_node(test, odom0="wheels", odom0_config=sensor_config(X, Y, YAW), odom0_relative=True, publish_tf=False)
    filtered = test.record("/odometry/filtered")
    for step in range(30):
        test.publish("/wheels", make_odometry(test, x=7.0, y=0.05 * step, yaw=pi / 2, variance=1e-6))
        await test.advance(0.1)
    # The differential filter starts at the second pose, which gives the first velocity. The relative one starts at the
    # first pose.
    assert planar_pose(filtered[-2]) == pytest.approx((1.40, 0.0, 0.0), abs=0.01)
    assert planar_pose(filtered[-1]) == pytest.approx((1.45, 0.0, 0.0), abs=0.01)


async def test_pose_is_set_by_topic_and_service(test):
    start_node(test, odom0="wheels", odom0_config=sensor_config(VX))
    filtered = test.record("/odometry/filtered")
    test.publish("/wheels", make_odometry(test))
    await test.advance(0.2)
    message_type = get_message("geometry_msgs/msg/PoseWithCovarianceStamped")
    pose = set_header(message_type(), now_s(test), "odom")
    pose.pose.pose.position.x, pose.pose.pose.orientation.w = 4.0, 1.0
    test.publish("/set_pose", pose)
    await test.advance(0.2)
    assert planar_pose(filtered.last)[0] == pytest.approx(4.0)
    pose = set_header(message_type(), now_s(test), "odom")
    pose.pose.pose.position.x, pose.pose.pose.orientation.w = 5.0, 1.0
    await test.call("/set_pose", get_service("robot_localization/srv/SetPose").Request(pose=pose))
    test.publish("/wheels", make_odometry(test, vx=3.0, stamp=now_s(test) - 0.1))
    await test.advance(0.2)
    assert planar_pose(filtered.last)[0] == pytest.approx(5.0)


async def test_toggle_and_enable_services_control_filter(test):
    start_node(test, odom0="wheels", odom0_config=sensor_config(X), disabled_at_startup=True)
    filtered = test.record("/odometry/filtered")
    test.publish("/wheels", make_odometry(test, x=1.0))
    await test.advance(0.5)
    assert len(filtered) == 0
    assert log_texts(test, "INFO") == ["Filter is disabled. To enable it call the /enable service"]
    await test.call("/enable", get_service("std_srvs/srv/Empty").Request())
    await test.advance(0.2)
    assert planar_pose(filtered.last)[0] == pytest.approx(1.0)
    toggle = get_service("robot_localization/srv/ToggleFilterProcessing").Request
    assert (await test.call("/toggle", toggle(on=False))).status
    assert not (await test.call("/toggle", toggle(on=False))).status
    test.publish("/wheels", make_odometry(test, x=9.0))
    await test.advance(0.5)
    assert planar_pose(filtered.last)[0] == pytest.approx(1.0)


async def test_filter_resets_when_simulated_time_jumps_back(test):
    clock = get_message("rosgraph_msgs/msg/Clock")

    async def run(first, last, x):
        for tenth in range(first, last):
            test.publish("/clock", clock(clock=Time.from_nanoseconds(tenth * 100_000_000)))
            await test.settle()
            test.publish("/wheels", make_odometry(test, x=x, stamp=tenth / 10.0))
            await test.settle()

    start_node(test, odom0="wheels", odom0_config=sensor_config(X), use_sim_time=True)
    filtered = test.record("/odometry/filtered")
    await run(300, 320, 5.0)
    assert planar_pose(filtered.last)[0] == pytest.approx(5.0)
    await run(1, 20, 0.0)
    assert planar_pose(filtered.last)[0] == pytest.approx(0.0)
    assert filtered.last.header.stamp.nanoseconds < 2e9
    assert log_texts(test, "WARN") == ["Time has jumped: the filter restarts."]


async def test_old_message_is_ignored(test):
    start_node(test, odom0="wheels", odom0_config=sensor_config(X))
    filtered = test.record("/odometry/filtered")
    test.publish("/wheels", make_odometry(test, x=1.0))
    await test.advance(0.2)
    test.publish("/wheels", make_odometry(test, x=9.0, stamp=START_S - 5.0))
    await test.advance(0.2)
    assert planar_pose(filtered.last)[0] == pytest.approx(1.0)
    assert len(log_texts(test, "WARN")) == 1


async def test_velocity_commands_move_estimate(test):
    flags = [True, False, False, False, False, True]
    limits = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    start_node(
        test,
        odom0="wheels",
        odom0_config=sensor_config(VX),
        use_control=True,
        control_config=flags,
        acceleration_limits=limits,
        control_timeout=10.0,
    )
    filtered = test.record("/odometry/filtered")
    test.publish("/wheels", make_odometry(test))
    twist = get_message("geometry_msgs/msg/Twist")()
    twist.linear.x = 2.0
    test.publish("/cmd_vel", twist)
    await test.advance(1.0)
    assert 0.5 < filtered.last.twist.twist.linear.x <= 1.0


async def test_ukf_node_publishes_estimate(test):
    node = start_node(test, UkfNode, odom0="wheels", odom0_config=sensor_config(X, VX))
    filtered = test.record("/odometry/filtered")
    for step in range(50):
        test.publish("/wheels", make_odometry(test, x=0.1 * step, vx=1.0))
        await test.advance(0.1)
    assert node.node.get_name() == "ukf_filter_node"
    assert planar_pose(filtered.last)[0] == pytest.approx(4.9, abs=0.1)


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ({"frequency": 0.0}, "parameter 'frequency' of 'ekf_filter_node' cannot be '0.0'"),
        (
            {"process_noise_covariance": [1.0, 2.0]},
            "'process_noise_covariance' must have 225 / 15 values, but it has 2",
        ),
        ({"odom0": "a", "odom0_config": [True]}, "parameter 'odom0_config' must have 15 values, but it has 1"),
        (
            {"map_frame": "odom"},
            "map_frame 'odom', odom_frame 'odom' and base_link_frame 'base_link' must be different frames",
        ),
        ({"world_frame": "earth"}, "parameter 'world_frame' of 'ekf_filter_node' cannot be 'earth'"),
    ],
)
async def test_invalid_parameters_are_rejected(test, parameters, text):
    with pytest.raises(LinkwrightError) as error:
        start_node(test, **parameters)
    assert text in str(error.value)


async def test_unknown_sensor_parameters_are_reported(test):
    start_node(
        test, odom0="wheels", odom0_config=sensor_config(X), odom0_diferential=True, odom2_config=sensor_config(X)
    )
    (misspelled,) = log_texts(test, "WARN")
    assert misspelled.startswith(
        "'odom0_diferential' is not a parameter of this node; did you mean 'odom0_differential'"
    )
    assert "parameters that this node does not have are ignored: odom2_config" in log_texts(test, "INFO")


async def test_sensor_without_enabled_values_is_reported(test):
    start_node(test, odom0="wheels")
    assert log_texts(test, "WARN") == [
        "wheels is listed as an input topic (odom0), but odom0_config enables none of its values"
    ]
