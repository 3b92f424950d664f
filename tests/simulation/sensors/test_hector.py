"""The sensors of hector_gazebo_plugins."""

from __future__ import annotations

from math import cos, exp, pi, radians, sin, sqrt

import numpy as np
import pytest

from linkwright.messages import get_service
from linkwright.sdf.text import parse_as_gazebo
from linkwright.simulation.plugins.sensors.hector_errors import ErrorModel
from linkwright.testing import Recording
from tests.simulation.fluids.server import running_server, weightless_server
from tests.simulation.test_plugins import SECOND_NS
from tests.simulation.worlds import GROUND, box


def make_craft(kind: str, parameters: str = "", pose: str = "0 0 0.1 0 0 0") -> str:
    plugin = f'<plugin name="{kind}" filename="libhector_gazebo_ros_{kind}.so">{parameters}</plugin>'
    return box("craft", pose, "0.4 0.4 0.2", 1.0).replace("</model>", f"{plugin}</model>")


async def record_messages(running, topic: str, seconds: float = 1.0) -> list:
    server, graph, log = running
    recording = Recording(graph, server.node, topic)
    server.advance(round(seconds * SECOND_NS))
    await graph.settle()
    assert not log
    return list(recording)


def vector_components(vector) -> tuple[float, float, float]:
    return vector.x, vector.y, vector.z


async def test_imu_at_rest_measures_gravity_and_orientation():
    parameters = "<bodyName>link</bodyName><updateRate>50</updateRate>"
    async with running_server(GROUND, make_craft("imu", parameters, "0 0 0.1 0 0 0.5")) as running:
        messages = await record_messages(running, "/imu")
        assert len(messages) == 50
        message = messages[-1]
        assert message.header.frame_id == "link"
        assert vector_components(message.linear_acceleration) == pytest.approx((0.0, 0.0, 9.81), abs=0.05)
        assert message.orientation.z == pytest.approx(sin(0.25), abs=1e-3)


async def test_imu_has_noise_offset_and_bias_that_calibration_removes():
    parameters = (
        "<rateDrift>0.1 0.2 0.3</rateDrift><rateDriftFrequency>0</rateDriftFrequency><accelOffset>0.5 0 0</accelOffset>"
        "<gaussianNoise>0.02</gaussianNoise><yawOffset>0.2</yawOffset><topicName>raw</topicName>"
    )
    async with weightless_server(make_craft("imu", parameters)) as running:
        server, graph, _ = running
        rates = np.array(
            [vector_components(message.angular_velocity) for message in await record_messages(running, "/raw", 5.0)]
        )
        (bias, *_) = await record_messages(running, "/raw/bias", 0.1)
        assert rates.std(axis=0) == pytest.approx([0.02] * 3, rel=0.2)
        assert rates.mean(axis=0) == pytest.approx(vector_components(bias.angular_velocity), abs=0.004)
        assert bias.linear_acceleration.x == 0.5
        client = graph.create_node("operator").create_client("std_srvs/srv/Empty", "/raw/calibrate")
        client.call_async(get_service("std_srvs/srv/Empty").Request())
        await graph.settle()
        server.advance(SECOND_NS // 100)
        *_, bias = await record_messages(running, "/raw/bias", 0.1)
        assert vector_components(bias.angular_velocity) == (0.0, 0.0, 0.0)
    async with running_server(GROUND, make_craft("imu", parameters)) as running:
        *_, message = await record_messages(running, "/raw")
        half_yaw = 0.1
        assert message.orientation.z == pytest.approx(sin(half_yaw), abs=0.01)
        assert message.orientation.y == pytest.approx(-0.5 * 0.5 / 9.81, abs=0.01)
        assert message.orientation_covariance[0] == pytest.approx((0.02 / 9.81) ** 2)


async def test_gps_converts_position_north_and_west_of_reference():
    parameters = "<referenceLatitude>50</referenceLatitude><referenceLongitude>10</referenceLongitude>"
    extra = "<referenceAltitude>100</referenceAltitude><status>2</status><service>1</service>"
    async with weightless_server(make_craft("gps", parameters + extra, "1000 2000 30 0 0 0")) as running:
        running[0].simulation.set_model_velocity("craft", (1.0, 2.0, 3.0), (0.0, 0.0, 0.0))
        velocities = Recording(running[1], running[0].node, "/fix_velocity")
        messages = await record_messages(running, "/fix")
        assert len(messages) == 4
        message = messages[0]
        assert message.latitude == pytest.approx(50.0 + 1000.25 / 111_229.0, abs=1e-5)
        assert message.longitude == pytest.approx(10.0 - 2000.5 / (111_320.0 * cos(radians(50.0)) * 1.00197), abs=1e-4)
        assert message.altitude == pytest.approx(130.75, abs=0.05)
        assert (message.status.status, message.status.service, message.header.frame_id) == (2, 1, "world")
        assert vector_components(velocities.last.vector) == pytest.approx((1.0, 2.0, 3.0))


async def test_gps_of_world_with_heading_and_drift():
    world = (
        "<spherical_coordinates><latitude_deg>20</latitude_deg><longitude_deg>30</longitude_deg><elevation>5</elevation>"
        "<heading_deg>0</heading_deg></spherical_coordinates>"
    )
    parameters = "<useWorldSphericalCoordinates>1</useWorldSphericalCoordinates><drift>3</drift>"
    noise = "<gaussianNoise>0.5</gaussianNoise><topicName>gps</topicName>"
    async with weightless_server(world, make_craft("gps", parameters + noise, "0 10000 0 0 0 0")) as running:
        (message, *_) = await record_messages(running, "/gps")
        assert message.latitude == pytest.approx(20.0 + 10_000 / 110_700, abs=1e-3)  # y points north
        assert message.longitude == pytest.approx(30.0, abs=1e-3)
        assert message.position_covariance[0] == pytest.approx(9.25)


async def test_magnetometer_measures_inclined_field_in_frame_of_link():
    parameters = "<magnitude>2</magnitude><inclination>30</inclination><declination>0</declination>"
    async with weightless_server(make_craft("magnetic", parameters, f"0 0 0 0 0 {pi / 2}")) as running:
        message = (await record_messages(running, "/magnetic", 0.1))[-1]
        assert vector_components(message.vector) == pytest.approx((0.0, -2.0 * cos(pi / 6), -1.0), abs=1e-6)
    parameters += "<useMagneticFieldMsgs>true</useMagneticFieldMsgs><referenceHeading>90</referenceHeading>"
    async with weightless_server(make_craft("magnetic", parameters)) as running:
        message = (await record_messages(running, "/magnetic", 0.1))[-1]
        assert vector_components(message.magnetic_field) == pytest.approx((0.0, 2.0 * cos(pi / 6), -1.0), abs=1e-6)


async def test_barometer_publishes_height_with_scale_and_offset():
    parameters = "<scaleError>1.1</scaleError><offset>0.5</offset><frameId>/base</frameId>"
    async with weightless_server(make_craft("baro", parameters, "0 0 20 0 0 0")) as running:
        messages = await record_messages(running, "/pressure_height")
        assert len(messages) == 10
        assert messages[0].point.z == pytest.approx(22.5)
        assert messages[0].header.frame_id == "base"


async def test_sonar_measures_least_distance_with_errors():
    sensor = (
        '<sensor name="sonar" type="ray"><pose>0 0 0 0 1.5707963 0</pose><ray><scan><horizontal><samples>3</samples>'
        "<min_angle>-0.1</min_angle><max_angle>0.1</max_angle></horizontal></scan><range><min>0.03</min><max>3</max>"
        '</range></ray><plugin name="s" filename="libhector_gazebo_ros_sonar.so"><topicName>height</topicName>'
        "<offset>0.1</offset></plugin></sensor>"
    )
    text = box("craft", "0 0 2 0 0 0", "0.1 0.1 0.1", 1.0).replace("</link>", f"{sensor}</link>")
    async with weightless_server(GROUND, text) as running:
        messages = await record_messages(running, "/height")
        assert len(messages) == 10
        message = messages[-1]
        assert message.range == pytest.approx(2.1, abs=0.01)
        assert (message.header.frame_id, message.radiation_type) == ("sonar_link", 0)


def test_error_parameters_have_one_or_three_numbers():
    text = "<offset>0.5</offset><scaleError>1 2 3</scaleError><drift>much</drift><gaussianNoise>1 2</gaussianNoise>"
    document, _ = parse_as_gazebo(f"<plugin>{text}</plugin>".encode(), "robot.sdf")
    model = ErrorModel(document.root, "", np.random.default_rng(1))
    assert model.apply(np.ones(3), 1.0) == pytest.approx([1.5, 2.5, 3.5])
    assert ErrorModel(None, "rate", np.random.default_rng(1)).apply(np.ones(3), 1.0) == pytest.approx(np.ones(3))


def test_drift_keeps_its_deviation():
    text = b"<plugin><rateDrift>2</rateDrift><rateDriftFrequency>0.5</rateDriftFrequency></plugin>"
    document, _ = parse_as_gazebo(text, "robot.sdf")
    model = ErrorModel(document.root, "rate", np.random.default_rng(1))
    drifts = []
    for _ in range(3000):
        model.advance(1.0)
        drifts.append(model.bias)
    # a step of 1 s adds noise with the variance 2 f d2, and the drift decays by exp(-f)
    assert np.std(drifts) == pytest.approx(sqrt(2 * 0.5 * 4.0 / (1.0 - exp(-1.0))), rel=0.1)
