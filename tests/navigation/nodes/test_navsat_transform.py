"""`navsat_transform_node`: GPS fixes to odometry and back."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import quaternion_from_rpy
from linkwright.graph import STATIC_TF_PUBLISHER_QOS
from linkwright.messages import TFMessage, Time, TransformBatch, get_message, get_service
from linkwright.navigation.estimation.geodesy import TangentPlane, degrees_from_utm, utm_from_degrees, zone_from_degrees
from linkwright.navigation.nodes.robot_localization.navsat_transform import NavsatTransformNode
from linkwright.nodes import NodeOptions
from linkwright.testing.stepped import AsyncSteppedGraph

START_LATITUDE_LONGITUDE = (48.5, 9.0)
"""The center of zone 32, where the grid is not rotated."""


@pytest.fixture
async def test():
    async with AsyncSteppedGraph() as graph:
        yield graph


def start_node(test, **parameters):
    return NavsatTransformNode(test.graph, NodeOptions(parameters=parameters))


def make_message(test, kind, frame):
    message = get_message(kind)()
    message.header.stamp, message.header.frame_id = Time.from_nanoseconds(test.clock.now_ns()), frame
    return message


def set_yaw(message, yaw):
    message.x, message.y, message.z, message.w = quaternion_from_rpy((0.0, 0.0, yaw))


async def publish_fix(test, east=0.0, north=0.0, altitude=200.0, frame="gps"):
    """Return a receiver's fix at some meters from the start, on the grid."""
    zone = zone_from_degrees(*START_LATITUDE_LONGITUDE)
    x, y = utm_from_degrees(*START_LATITUDE_LONGITUDE, zone)
    message = make_message(test, "sensor_msgs/msg/NavSatFix", frame)
    message.latitude, message.longitude = degrees_from_utm(x + east, y + north, zone)
    message.altitude = altitude
    message.position_covariance = np.diag([1.0, 4.0, 9.0]).reshape(9)
    test.publish("/gps/fix", message)
    await test.settle()


async def publish_odometry(test, x=0.0, y=0.0, yaw=0.0):
    message = make_message(test, "nav_msgs/msg/Odometry", "odom")
    message.child_frame_id = "base_link"
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    set_yaw(message.pose.pose.orientation, yaw)
    test.publish("/odometry/filtered", message)
    await test.settle()


async def publish_imu(test, yaw, frame="base_link"):
    message = make_message(test, "sensor_msgs/msg/Imu", frame)
    set_yaw(message.orientation, yaw)
    test.publish("/imu", message)
    await test.settle()


def position_of(message):
    position = message.pose.pose.position
    return position.x, position.y, position.z


async def test_fixes_become_odometry_of_robot_that_faced_north(test):
    start_node(test, broadcast_cartesian_transform=True)
    gps, tf = test.record("/odometry/gps"), test.record("/tf_static", TFMessage)
    await publish_odometry(test)
    await publish_imu(test, pi / 2)
    await publish_fix(test, frame="base_link")
    await test.advance(0.15)
    assert len(gps) == 0  # the first fix is the origin
    await publish_odometry(test)
    await publish_fix(test, east=-3.0, north=10.0, altitude=201.0, frame="base_link")
    await test.advance(0.1)
    assert position_of(gps.last) == pytest.approx((10.0, 3.0, 1.0), abs=1e-6)
    assert gps.last.header.frame_id == "odom"
    assert np.diag(np.reshape(gps.last.pose.covariance, (6, 6)))[:3] == pytest.approx([4.0, 1.0, 9.0])
    (transform,) = tf.last.transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("odom", "utm")


async def test_gps_receiver_offset_is_applied(test):
    start_node(test, zero_altitude=True)
    gps = test.record("/odometry/gps")
    pose = np.array([[1.0, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0]])
    batch = TransformBatch(("base_link",), ("gps",), 0, pose)
    test.publish("/tf_static", TFMessage(batch=batch), STATIC_TF_PUBLISHER_QOS)
    await publish_odometry(test)
    await publish_imu(test, 0.0)
    await publish_fix(test)
    await test.advance(0.15)
    await publish_odometry(test, yaw=pi / 2)  # the robot turned in place, which moved the receiver
    await publish_fix(test, east=-1.0, north=1.0)
    await test.advance(0.1)
    assert position_of(gps.last) == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


async def test_odometry_is_published_as_fixes(test):
    start_node(test, use_odometry_yaw=True)
    filtered = test.record("/gps/filtered")
    await publish_odometry(test, x=5.0, yaw=pi / 2)
    await publish_fix(test, frame="base_link")
    await test.advance(0.15)
    await publish_odometry(test, x=5.0, y=100.0)
    await test.advance(0.1)
    zone = zone_from_degrees(*START_LATITUDE_LONGITUDE)
    x, y = utm_from_degrees(*START_LATITUDE_LONGITUDE, zone)
    east, north = utm_from_degrees(filtered.last.latitude, filtered.last.longitude, zone)
    assert (east - x, north - y, filtered.last.altitude) == pytest.approx((0.0, 100.0, 200.0), abs=1e-4)


async def test_datum_is_used_by_conversion_services(test):
    start_node(test, wait_for_datum=True, datum=[*START_LATITUDE_LONGITUDE, 0.0])
    request = get_service("robot_localization/srv/FromLL").Request()
    zone = zone_from_degrees(*START_LATITUDE_LONGITUDE)
    x, y = utm_from_degrees(*START_LATITUDE_LONGITUDE, zone)
    request.ll_point.latitude, request.ll_point.longitude = degrees_from_utm(x + 20.0, y - 7.0, zone)
    converted_point = (await test.call("/fromLL", request)).map_point
    assert (converted_point.x, converted_point.y) == pytest.approx((20.0, -7.0), abs=1e-6)
    ll_point = (
        await test.call("/toLL", get_service("robot_localization/srv/ToLL").Request(map_point=converted_point))
    ).ll_point
    assert (ll_point.latitude, ll_point.longitude) == pytest.approx(
        (request.ll_point.latitude, request.ll_point.longitude), abs=1e-9
    )
    several = get_service("robot_localization/srv/FromLLArray").Request(ll_points=[request.ll_point] * 2)
    assert [map_point.x for map_point in (await test.call("/fromLLArray", several)).map_points] == pytest.approx(
        [20.0, 20.0]
    )
    datum = get_service("robot_localization/srv/SetDatum").Request()
    datum.geo_pose.position = request.ll_point
    set_yaw(datum.geo_pose.orientation, 0.0)
    await test.call("/datum", datum)
    converted_point = (await test.call("/fromLL", request)).map_point
    assert (converted_point.x, converted_point.y) == pytest.approx((0.0, 0.0), abs=1e-6)
    zone_request = get_service("robot_localization/srv/SetUTMZone").Request
    assert (await test.call("/setUTMZone", zone_request(utm_zone="31U"))).status
    assert not (await test.call("/setUTMZone", zone_request(utm_zone="99"))).status


async def test_local_cartesian_mode_uses_tangent_plane(test):
    start_node(test, wait_for_datum=True, datum=[*START_LATITUDE_LONGITUDE, pi / 2], use_local_cartesian=True)
    request = get_service("robot_localization/srv/FromLL").Request()
    ll_point = request.ll_point
    ll_point.latitude, ll_point.longitude, ll_point.altitude = TangentPlane(
        *START_LATITUDE_LONGITUDE, 0.0
    ).geodetic_from_point((3.0, 50.0, 2.0))
    map_point = (await test.call("/fromLL", request)).map_point
    assert (map_point.x, map_point.y, map_point.z) == pytest.approx((50.0, -3.0, 2.0), abs=1e-5)


async def test_nothing_is_published_without_all_inputs(test):
    start_node(test)
    gps = test.record("/odometry/gps")
    for _ in range(3):
        await publish_odometry(test)
        await publish_fix(test)
        await test.advance(0.1)
    assert len(gps) == 0
    response = await test.call("/fromLL", get_service("robot_localization/srv/FromLL").Request())
    assert response.map_point.x == 0.0
    assert [record.text for record in test.log if record.level.name == "ERROR"] == ["No transform available (yet)"]


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ({"datum": [1.0, 2.0]}, "parameter 'datum' must have 3 values, but it has 2"),
        ({"datum": [200.0, 2.0, 0.0]}, "parameter 'datum' of 'navsat_transform_node' cannot be '[200.0, 2.0, 0.0]'"),
        ({"frequency": 0.0}, "parameter 'frequency' of 'navsat_transform_node' cannot be '0.0'"),
    ],
)
async def test_invalid_parameters_are_rejected(test, parameters, text):
    with pytest.raises(LinkwrightError) as error:
        start_node(test, **parameters)
    assert text in str(error.value)
