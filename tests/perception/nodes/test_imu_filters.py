"""The IMU filter nodes: orientation, transforms and parameters."""

from __future__ import annotations

from math import pi

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import quaternion_from_rpy, quaternion_inverse, rotate, rpy_from_quaternion
from linkwright.messages import Time, get_message
from linkwright.nodes import NodeOptions
from linkwright.perception.nodes.imu_filters import ComplementaryNode, MadgwickNode
from linkwright.testing.stepped import AsyncSteppedGraph

GRAVITY = 9.80665


@pytest.fixture
async def test():
    async with AsyncSteppedGraph() as graph:
        yield graph


def start_filter(test, kind, **parameters):
    return kind(test.graph, NodeOptions(parameters=parameters))


async def publish_measurements(test, rpy=(0.0, 0.0, 0.0), rates=(0.0, 0.0, 0.0), magnetic=False, acceleration=None):
    """Publish a rotated IMU's measurements every hundredth of a second."""
    back = quaternion_inverse(quaternion_from_rpy(rpy))
    if magnetic:
        field = get_message("sensor_msgs/msg/MagneticField")()
        magnetic_field = field.magnetic_field
        magnetic_field.x, magnetic_field.y, magnetic_field.z = rotate(back, (0.0, 2e-5, -4e-5))
        test.publish("/imu/mag", field)
        await test.settle()
    message = get_message("sensor_msgs/msg/Imu")()
    message.header.stamp, message.header.frame_id = Time.from_nanoseconds(test.clock.now_ns()), "imu_link"
    measured_acceleration, turn = message.linear_acceleration, message.angular_velocity
    measured_acceleration.x, measured_acceleration.y, measured_acceleration.z = acceleration or rotate(
        back, (0.0, 0.0, GRAVITY)
    )
    turn.x, turn.y, turn.z = rates
    test.publish("/imu/data_raw", message)
    await test.advance(0.01)


def rpy_angles(message):
    turn = message.orientation
    return rpy_from_quaternion((turn.x, turn.y, turn.z, turn.w))


async def test_madgwick_publishes_orientation_and_transform(test):
    start_filter(test, MadgwickNode, orientation_stddev=0.1)
    data, tf = test.record("/imu/data"), test.record("/tf")
    await publish_measurements(test)
    assert len(data) == 0  # no message of the magnetometer has arrived
    for _ in range(20):
        await publish_measurements(test, (0.3, -0.2, 1.0), magnetic=True)
    assert rpy_angles(data.last) == pytest.approx((0.3, -0.2, 1.0), abs=0.01)
    assert list(data.last.orientation_covariance)[::4] == pytest.approx([0.01] * 3)
    (transform,) = tf.last.transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("odom", "imu_link")
    assert transform.transform.rotation.w == pytest.approx(data.last.orientation.w)


async def test_madgwick_applies_offset_gravity_removal_and_reverse_tf(test):
    parameters = {"use_mag": False, "yaw_offset": pi / 2, "declination": 0.1, "remove_gravity_vector": True}
    start_filter(test, MadgwickNode, **parameters, reverse_tf=True, publish_debug_topics=True)
    data, tf, rpy = test.record("/imu/data"), test.record("/tf"), test.record("/imu/rpy/filtered")
    for _ in range(3):
        await publish_measurements(test, (0.2, 0.1, 0.0))
    assert rpy_angles(data.last)[2] == pytest.approx(pi / 2 - 0.1)
    measured_acceleration = data.last.linear_acceleration
    assert (measured_acceleration.x, measured_acceleration.y, measured_acceleration.z) == pytest.approx(
        (0.0, 0.0, 0.0), abs=1e-3
    )
    (transform,) = tf.last.transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("imu_link", "odom")
    assert rpy.last.vector.z == pytest.approx(pi / 2 - 0.1)


async def test_stateless_madgwick_restarts_at_each_measurement(test):
    start_filter(test, MadgwickNode, use_mag=False, stateless=True, publish_tf=False)
    data = test.record("/imu/data")
    for roll in (0.1, 0.5, -0.4):
        await publish_measurements(test, (roll, 0.0, 0.0))
        await publish_measurements(test, (roll, 0.0, 0.0))
        assert rpy_angles(data.last)[0] == pytest.approx(roll, abs=1e-6)


async def test_complementary_filter_follows_gyroscope(test):
    start_filter(test, ComplementaryNode, do_bias_estimation=False)
    data = test.record("/imu/data")
    for _ in range(101):
        await publish_measurements(test, rates=(0.0, 0.0, 0.5))
    assert rpy_angles(data.last)[2] == pytest.approx(0.5, abs=0.01)
    assert test.graph.count_publishers("/tf") == 0


async def test_falling_imu_publishes_nothing(test):
    start_filter(test, ComplementaryNode)
    data = test.record("/imu/data")
    for _ in range(3):
        await publish_measurements(test, acceleration=(0.0, 0.0, 0.0))
    assert len(data) == 0
    (text,) = [record.text for record in test.log if record.level.name == "WARN"]
    assert text == "The IMU seems to be in free fall, cannot determine gravity direction!"


@pytest.mark.parametrize(
    ("kind", "parameters", "text"),
    [
        (MadgwickNode, {"world_frame": "esd"}, "parameter 'world_frame' of 'imu_filter_madgwick' cannot be 'esd'"),
        (MadgwickNode, {"constant_dt": -1.0}, "parameter 'constant_dt' of 'imu_filter_madgwick' cannot be '-1.0'"),
        (ComplementaryNode, {"gain_acc": 2.0}, "'gain_acc' of 'complementary_filter_gain_node' cannot be '2.0'"),
    ],
)
async def test_invalid_parameters_are_rejected(test, kind, parameters, text):
    with pytest.raises(LinkwrightError) as caught:
        start_filter(test, kind, **parameters)
    assert text in str(caught.value)
