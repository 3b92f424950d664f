"""Sensors of uuv_simulator: values, units, axes, noise and switching."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np
import pytest

from linkwright.graph.transforms.broadcaster import StaticTransformBroadcaster
from linkwright.messages import Header, Time, TransformStamped, get_message
from linkwright.simulation.server.server import ServerOptions
from linkwright.testing import Recording
from tests.simulation.px4.test_px4_sensors import SWISS
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND, box

TURNED = "1 2 -10 0 0 1.5707963267948966"
SENSORS = "uuv_sensor_ros_plugins_msgs"
ENU = "<enable_local_ned_frame>false</enable_local_ned_frame>"


def plugin(kind: str, parameters: str = "") -> str:
    return (
        f'<plugin name="{kind}" filename="libuuv_gazebo_ros_{kind}_plugin.so"><robot_namespace>uuv</robot_namespace>'
        f"<link_name>link</link_name><sensor_topic>out</sensor_topic>{parameters}</plugin>"
    )


def body(*plugins: str, pose: str = TURNED) -> str:
    return box("uuv", pose).replace("</model>", "".join(plugins) + "</model>")


def moving(x: float = 0.0, y: float = 0.0, z: float = 0.0, turning: float = 0.0):
    """Return a function that gives the model velocities."""
    return lambda simulation: simulation.set_model_velocity("uuv", (x, y, z), (0.0, 0.0, turning))


async def record(
    *parts: str,
    topics=("/uuv/out",),
    seconds: float = 1.0,
    prepare=lambda _: None,
    mistakes: bool = False,
    gravity="0 0 0",
):
    options = ServerOptions(gazebo_mistakes=mistakes)
    async with running_server(*parts, gravity=gravity, options=options) as (server, graph, log):
        recordings = [Recording(graph, server.node, topic) for topic in topics]
        await graph.settle()
        prepare(server.simulation)
        for _ in range(4):
            server.advance(round(seconds * SECOND_NS / 4))
            await graph.settle()
        assert not log, [entry.text for entry in log]
        return recordings


def numbers(vector) -> tuple[float, float, float]:
    return vector.x, vector.y, vector.z


@pytest.mark.parametrize(
    ("height", "mistakes", "expected"),
    [
        (-10.0, False, (101.325 + 98.0638) * 1000),
        (10.0, False, 101325.0),
        (-10.0, True, 101.325 + 98.0638),
        (10.0, True, 101.325 + 98.0638),
    ],
)
async def test_pressure_rises_with_depth(height, mistakes, expected):
    (recording,) = await record(body(plugin("subsea_pressure"), pose=f"0 0 {height} 0 0 0"), mistakes=mistakes)
    assert len(recording) == 30
    assert recording.last.fluid_pressure == pytest.approx(expected, abs=1e-6)
    assert recording.last.header.frame_id == "link"


async def test_pressure_has_noise_of_amplitude_and_sigma():
    noise = "<noise_sigma>3</noise_sigma><noise_amplitude>0.5</noise_amplitude><update_rate>100</update_rate>"
    (recording,) = await record(body(plugin("subsea_pressure", noise)), seconds=20)
    assert np.std([message.fluid_pressure for message in recording]) == pytest.approx(1500, rel=0.06)
    assert recording.last.variance == pytest.approx(9e6)


@pytest.mark.parametrize(("parameters", "frame", "sign"), [(ENU, "link", 1.0), ("", "link_ned", -1.0)])
async def test_magnetometer_measures_field_of_its_parameters(parameters, frame, sign):
    values = "<intensity>2</intensity><reference_heading>0.5</reference_heading><declination>0.1</declination>"
    recording, transforms = await record(body(plugin("magnetometer", parameters + values)), topics=("/uuv/out", "/tf"))
    north, east = 2 * cos(pi / 3) * cos(0.4), 2 * cos(pi / 3) * sin(0.4)
    field = numbers(recording.last.magnetic_field)
    assert field == pytest.approx((east, -north * sign, -2 * sin(pi / 3) * sign))
    assert list(recording.last.magnetic_field_covariance[::4]) == pytest.approx([1.0, 1.0, 1.96])
    assert recording.last.header.frame_id == frame
    assert (len(transforms) > 0) == (sign < 0)
    if sign < 0:
        transform = transforms.last.transforms[0]
        assert (transform.header.frame_id, transform.child_frame_id) == ("link", "link_ned")
        assert (transform.transform.rotation.x, transform.transform.rotation.w) == (1.0, 0.0)


async def test_position_is_in_frame_of_static_transform_once_it_is_known():
    frame = "<static_reference_frame>world_ned</static_reference_frame>"
    async with running_server(body(plugin("rpt", frame)), gravity="0 0 0") as (server, graph, log):
        recording = Recording(graph, server.node, "/uuv/out")
        await graph.settle()
        server.advance(SECOND_NS)
        await graph.settle()
        assert len(recording) == 0
        transform = TransformStamped(header=Header(stamp=Time(), frame_id="world"), child_frame_id="world_ned")
        rotation = transform.transform.rotation
        rotation.x = rotation.y = np.sqrt(0.5)  # x to the north, y to the east, z down
        rotation.w = 0.0
        StaticTransformBroadcaster(graph.create_node("frames")).sendTransform(transform)
        await graph.settle()
        server.advance(SECOND_NS)
        await graph.settle()
        assert not log
        assert numbers(recording.last.pos.pos) == pytest.approx((2.0, 1.0, 10.0))
        assert recording.last.header.frame_id == "world_ned"


async def test_pose_has_offset_and_velocity_in_axes_of_world():
    offset = "<position_offset>0 0 1</position_offset><publish_ned_odom>true</publish_ned_odom>"
    pose, ned = await record(
        body(plugin("pose_gt", offset)), topics=("/uuv/out", "/uuv/out_ned"), prepare=moving(0.5, 1.0, 0.1, 0.2)
    )
    age = pose.last.header.stamp.sec + pose.last.header.stamp.nanosec * 1e-9
    assert numbers(pose.last.pose.pose.position) == pytest.approx((1 + 0.5 * age, 2 + age, -9 + 0.1 * age), abs=1e-6)
    assert numbers(pose.last.twist.twist.linear) == pytest.approx((0.5, 1.0, 0.1))
    assert pose.last.twist.twist.angular.z == pytest.approx(0.2)
    yaw = pi / 2 + 0.2 * age
    assert pose.last.pose.pose.orientation.z == pytest.approx(sin(yaw / 2), abs=1e-4)
    orientation = ned.last.pose.pose.orientation  # half a turn about x, before the yaw
    assert (orientation.x, orientation.y) == pytest.approx((cos(yaw / 2), sin(yaw / 2)), abs=1e-4)
    assert ned.last.child_frame_id == "link_ned"


@pytest.mark.parametrize(("parameters", "sign"), [(ENU, 1.0), ("", -1.0)])
async def test_imu_measures_reaction_to_gravity_and_rates(parameters, sign):
    quiet = parameters + "<orientation_noise>0</orientation_noise>"
    (recording,) = await record(GROUND, body(plugin("imu", quiet), pose="0 0 0.5 0 0 0"), gravity="0 0 -9.81")
    assert recording.last.linear_acceleration.z == pytest.approx(9.81 * sign, abs=0.01)
    assert recording.last.angular_velocity_covariance[0] == pytest.approx(radians(70 / 3600) ** 2)
    (recording,) = await record(body(plugin("imu", quiet)), prepare=moving(turning=0.5))
    assert recording.last.angular_velocity.z == pytest.approx(0.5 * sign)
    assert recording.last.orientation.z == pytest.approx(sin((pi / 2 + 0.5) / 2), abs=0.01)


@pytest.mark.parametrize(("mistakes", "deviation"), [(False, 0.02), (True, 0.02**2)])
async def test_orientation_of_imu_has_noise_and_rates_only_with_amplitude(mistakes, deviation):
    noise = "<orientation_noise>0.02</orientation_noise><update_rate>200</update_rate>"
    (recording,) = await record(body(plugin("imu", noise), pose="0 0 0 0 0 0"), seconds=10, mistakes=mistakes)
    assert np.std([2 * message.orientation.x for message in recording]) == pytest.approx(deviation, rel=0.06)
    assert np.std([message.angular_velocity.x for message in recording]) < 1e-6
    loud = "<noise_amplitude>1</noise_amplitude><gyroscope_noise_density>0.01</gyroscope_noise_density>"
    (recording,) = await record(body(plugin("imu", noise + loud)), seconds=10)
    assert np.std([message.angular_velocity.x for message in recording]) == pytest.approx(0.01 * 200**0.5, rel=0.06)


@pytest.mark.parametrize(("mistakes", "sign"), [(False, 1.0), (True, -1.0)])
async def test_receiver_publishes_position_on_earth(mistakes, sign):
    sensor = f'<sensor name="gps" type="gps"><update_rate>5</update_rate>{plugin("gps")}</sensor>'.replace(
        "<link_name>link</link_name>", "<horizontal_pos_std_dev>2</horizontal_pos_std_dev>"
    )
    model = box("uuv", "0 0 0 0 0 0").replace("</link>", f"{sensor}</link>")
    (recording,) = await record(SWISS, model, mistakes=mistakes)
    fix = recording.last
    assert len(recording) == 5
    assert (fix.latitude, fix.longitude, fix.altitude) == pytest.approx((46 * sign, 8 * sign, 1200), abs=1e-6)
    assert fix.header.frame_id == "uuv/gps_link"
    assert list(fix.position_covariance[::4]) == [4.0, 4.0, 0.0]


def log_with_beams(parameters: str = "", height: float = 9.5, farthest: float = 81.0) -> str:
    """Return a vehicle with a Doppler velocity log, whose four beams point down."""
    links, names = "", ""
    for number in range(4):
        angles = "<samples>1</samples><min_angle>0</min_angle><max_angle>0</max_angle>"
        scan = f"<scan><horizontal>{angles}</horizontal></scan>"
        links += (
            f'<link name="beam{number}"><pose>{0.1 * number} 0 0 0 1.5707963267948966 0</pose>'
            f'<sensor name="s" type="ray"><update_rate>10</update_rate><ray>{scan}'
            f"<range><min>0.55</min><max>{farthest}</max></range></ray>"
            f'<plugin name="r{number}" filename="libgazebo_ros_range.so"><robotNamespace>uuv</robotNamespace>'
            f"<topicName>beam{number}</topicName><frameName>beam{number}</frameName></plugin></sensor></link>"
            f'<joint name="j{number}" type="fixed"><parent>link</parent><child>beam{number}</child></joint>'
        )
        names += f"<beam_link_name_{number}>beam{number}</beam_link_name_{number}>"
        names += f"<beam_topic_{number}>beam{number}</beam_topic_{number}>"
    return body(links, plugin("dvl", names + parameters), pose=f"0 0 {height} 0 0 1.5707963267948966")


@pytest.mark.parametrize(("parameters", "sign"), [(ENU, 1.0), ("", -1.0)])
async def test_dvl_measures_velocity_over_ground_and_altitude(parameters, sign):
    log, twists = await record(
        GROUND, log_with_beams(parameters), topics=("/uuv/out", "/uuv/out_twist"), prepare=moving(1.0, 2.0, 0.0)
    )
    assert log.last.altitude == pytest.approx(9.5, abs=1e-4)
    assert numbers(log.last.velocity) == pytest.approx((2.0, -sign, 0.0), abs=1e-6)
    assert numbers(twists.last.twist.twist.linear) == numbers(log.last.velocity)
    assert list(twists.last.twist.covariance[::7]) == [0, 0, 0, -1, -1, -1]
    beam = log.last.beams[2]
    assert beam.range == pytest.approx(9.5, abs=1e-4)
    assert numbers(beam.pose.pose.position) == pytest.approx((0.2, 0.0, 0.0), abs=1e-6)


async def test_dvl_out_of_range_has_altitude_of_minus_one():
    (log,) = await record(GROUND, log_with_beams(farthest=5.0))
    assert log.last.altitude == -1.0


async def test_service_switches_sensor_off_and_on():
    async with running_server(body(plugin("subsea_pressure")), gravity="0 0 0") as (server, graph, _):
        recording, states = (Recording(graph, server.node, topic) for topic in ("/uuv/out", "/uuv/out/state"))
        service_type = f"{SENSORS}/srv/ChangeSensorState"
        client = graph.create_node("pilot").create_client(service_type, "/uuv/out/change_state")
        await graph.settle()
        for is_on, count in ((False, 0), (True, 30)):
            future = client.call_async(get_message(f"{service_type}_Request")(on=is_on))
            await graph.settle()
            server.advance(SECOND_NS)
            await graph.settle()
            assert future.result().success
            assert len(recording) == count
            assert states.last.data == is_on
