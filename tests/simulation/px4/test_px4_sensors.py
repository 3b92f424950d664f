"""Sensors of PX4's models: values, units, noise and delay."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from linkwright.simulation.plugins.px4.noise import BiasedNoise, BiasedNoiseSource
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND, box

TURNED = "0 0 100 0 0 1.5707963267948966"
SWISS = (
    "<spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>46</latitude_deg>"
    "<longitude_deg>8</longitude_deg><elevation>1200</elevation><heading_deg>0</heading_deg></spherical_coordinates>"
)


def plugin(name: str, parameters: str = "") -> str:
    return f'<plugin name="{name}" filename="libgazebo_{name}_plugin.so"><robotNamespace/>{parameters}</plugin>'


def body(*plugins: str, pose: str = "0 0 100 0 0 0") -> str:
    return box("uav", pose).replace("</model>", "".join(plugins) + "</model>")


def moving(x: float = 0.0, y: float = 0.0, z: float = 0.0, turning: float = 0.0):
    """Return a function that gives the model velocities."""
    return lambda simulation: simulation.set_model_velocity("uav", (x, y, z), (0.0, 0.0, turning))


async def record(*parts: str, topics: tuple[str, ...], seconds: float = 2.0, prepare=lambda _: None, gravity="0 0 0"):
    async with running_server(*parts, gravity=gravity) as (server, graph, log):
        recordings = [Recording(graph, server.node, topic) for topic in topics]
        await graph.settle()
        prepare(server.simulation)
        server.advance(round(seconds * SECOND_NS))
        await graph.settle()
        assert not log, [entry.text for entry in log]
        return recordings


def test_noise_has_density_and_bias_of_gauss_markov_process():
    source = BiasedNoiseSource(BiasedNoise(0.1, 0.5, 2.0), np.random.default_rng(3))
    biases, values = [], []
    for _ in range(40_000):
        value = source.apply(np.zeros(3), 0.05)
        values.append(value - source.bias)
        biases.append(source.bias)
    biases = np.array(biases)
    assert np.std(values) == pytest.approx(0.1 / sqrt(0.05), rel=0.02)
    assert biases.std() == pytest.approx(0.5 * sqrt(2.0 / 2.0), rel=0.1)
    later = (biases[40:] * biases[:-40]).mean() / biases.var()
    assert later == pytest.approx(np.exp(-1), abs=0.08)


def test_initial_bias_remains_without_random_walk():
    source = BiasedNoiseSource(BiasedNoise(0.0, 0.0, 1e9, 2.0), np.random.default_rng(1))
    first = source.bias
    assert np.abs(first).max() > 0.1
    assert source.apply(np.ones(3), 0.01) == pytest.approx(1.0 + first)


async def test_imu_measures_rates_and_reaction_to_gravity():
    quiet = (
        "<linkName>link</linkName><imuTopic>/imu</imuTopic><gyroscopeNoiseDensity>0</gyroscopeNoiseDensity>"
        "<accelerometerNoiseDensity>0</accelerometerNoiseDensity>"
    )
    recordings = await record(
        GROUND, body(plugin("imu", quiet), pose="0 0 0.5 0 0 0"), topics=("/uav/imu",), gravity="0 0 -9.81"
    )
    message = recordings[0].last
    assert message.linear_acceleration.z == pytest.approx(9.81, abs=0.01)
    assert message.header.frame_id == "link"
    assert len(recordings[0]) == 2000

    recordings = await record(body(plugin("imu", quiet)), topics=("/uav/imu",), prepare=moving(turning=0.5))
    assert recordings[0].last.angular_velocity.z == pytest.approx(0.5, abs=1e-6)


async def test_imu_has_noise_of_its_densities():
    (recording,) = await record(
        body(
            plugin(
                "imu",
                "<linkName>link</linkName><gyroscopeNoiseDensity>0.001</gyroscopeNoiseDensity>"
                "<accelerometerNoiseDensity>0.02</accelerometerNoiseDensity>",
            )
        ),
        topics=("/uav/imu",),
    )
    assert np.std([message.angular_velocity.x for message in recording]) == pytest.approx(0.001 / sqrt(1e-3), rel=0.1)
    assert np.std([message.linear_acceleration.y for message in recording]) == pytest.approx(0.02 / sqrt(1e-3), rel=0.1)
    assert recording.last.angular_velocity_covariance[0] == pytest.approx(1e-6)


async def test_magnetometer_measures_field_of_world_in_tesla_in_axes_of_link():
    parameters = "<pubRate>20</pubRate><noiseDensity>0.001</noiseDensity><magTopic>/mag</magTopic>"
    (recording,) = await record(
        "<magnetic_field>2e-5 0 -4e-5</magnetic_field>",
        body(
            plugin("magnetometer", parameters),
            pose=TURNED,
        ),
        topics=("/uav/mag",),
        seconds=50,
    )
    field = np.array([(m.magnetic_field.x, m.magnetic_field.y, m.magnetic_field.z) for m in recording])
    assert len(field) == 1000
    assert field.mean(axis=0) == pytest.approx((0.0, -2e-5, -4e-5), abs=1e-6)
    assert field[:, 0].std() == pytest.approx(0.001e-4 * sqrt(20), rel=0.1)


@pytest.mark.parametrize(("coordinates", "altitude"), [("", 488.0), (SWISS, 1200.0)])
async def test_barometer_measures_standard_atmosphere_and_drifts(coordinates, altitude):
    (recording,) = await record(
        coordinates,
        body(plugin("barometer", "<pubRate>50</pubRate><baroDriftPaPerSec>0.5</baroDriftPaPerSec>")),
        topics=("/uav/baro",),
        seconds=20,
        prepare=moving(0.0, 0.0, 10.0),
    )
    pressures = np.array([message.fluid_pressure for message in recording])
    times = np.array([message.header.stamp.sec + message.header.stamp.nanosec * 1e-9 for message in recording])
    expected = 101325 * (1 - 0.0065 * (altitude + 10.0 * times) / 288.15) ** 5.256 + 0.5 * times
    assert len(pressures) == 1000
    assert (pressures - expected).mean() == pytest.approx(0.0, abs=4.0)  # geopotential height: 0.02 % of the altitude
    assert np.std(pressures - expected) == pytest.approx(1.0, abs=0.3)


async def test_groundtruth_is_true_pose_and_position_on_earth():
    odometry, fixes = await record(
        SWISS,
        body(plugin("groundtruth"), pose=TURNED),
        topics=("/uav/groundtruth", "/uav/groundtruth/fix"),
        prepare=moving(1.0, 2.0, 0.5),
    )
    pose, twist = odometry.last.pose.pose, odometry.last.twist.twist
    assert (pose.position.x, pose.position.y, pose.position.z) == pytest.approx((2.0, 4.0, 101.0))
    assert (twist.linear.x, twist.linear.y, twist.linear.z) == pytest.approx((2.0, -1.0, 0.5))
    meters_per_degree = 6378137.0 * pi / 180
    assert fixes.last.latitude == pytest.approx(46 + 4.0 / meters_per_degree, abs=1e-6)
    assert fixes.last.longitude == pytest.approx(8 + 2.0 / (meters_per_degree * np.cos(np.radians(46))), abs=1e-6)
    assert fixes.last.altitude == pytest.approx(1301.0, abs=0.01)


async def test_groundtruth_of_world_without_coordinates_is_at_home():
    home = "<homeLatitude>10</homeLatitude><homeLongitude>20</homeLongitude><homeAltitude>30</homeAltitude>"
    for parameters, expected in (("", (47.397742, 8.545594, 588.0)), (home, (10.0, 20.0, 130.0))):
        (fixes,) = await record(body(plugin("groundtruth", parameters)), topics=("/uav/groundtruth/fix",), seconds=0.1)
        assert (fixes.last.latitude, fixes.last.longitude, fixes.last.altitude) == pytest.approx(expected, abs=1e-6)


def receiver(parameters: str = "") -> str:
    """Return a model with a receiver."""
    sensor = f'<sensor name="gps" type="gps"><pose>0 0 0 0 0 0</pose>{plugin("gps", parameters)}</sensor>'
    return box("uav", "0 0 100 0 0 0").replace("</link>", f"{sensor}</link>")


async def test_receiver_is_late_and_publishes_five_times_a_second():
    fixes, velocities = await record(
        SWISS, receiver("<topic>gps0</topic>"), topics=("/uav/link/gps0", "/uav/link/gps0/vel"), prepare=moving(10.0)
    )
    assert len(fixes) == len(velocities) == 10
    meters_per_degree = 6378137.0 * pi / 180 * np.cos(np.radians(46))
    assert (fixes.last.longitude - 8) * meters_per_degree == pytest.approx(10.0 * (2.0 - 0.12), rel=0.01)
    assert velocities.last.vector.x == pytest.approx(10.0)


async def test_receiver_has_noise_if_asked_and_names_its_topic_after_the_model():
    for noise, deviation in (("false", 0.0), ("true", 0.2 * sqrt(1e-3))):
        (velocities,) = await record(
            receiver(f"<gpsNoise>{noise}</gpsNoise><update_rate>50</update_rate>"),
            topics=("/uav/link/uav/vel",),
            seconds=10,
        )
        assert np.std([message.vector.y for message in velocities]) == pytest.approx(deviation, rel=0.1)


async def test_receiver_of_an_older_model_is_a_plugin_of_the_model():
    model = box("uav", "0 0 100 0 0 0").replace("</model>", f"{plugin('gps', '')}</model>")
    (fixes,) = await record(SWISS, model, topics=("/uav/gps",))
    assert fixes.last.header.frame_id == "link"
    assert fixes.last.latitude == pytest.approx(46.0, abs=1e-3)
