"""IMUs, contacts, joint forces and geodetic positions, compared with mechanics and geodesy."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.sensors import ForceTorque
from linkwright.sdf.worlds import SphericalCoordinates
from linkwright.simulation.sensors.contact import ContactSensor
from linkwright.simulation.sensors.earth import (
    AltimeterSensor,
    Globe,
    MagnetometerSensor,
    NavsatSensor,
    standard_pressure,
)
from linkwright.simulation.sensors.force_torque import ForceTorqueSensor
from linkwright.simulation.sensors.imu import ImuSensor
from linkwright.simulation.sensors.mount import Mount
from linkwright.simulation.simulation import Simulation
from tests.simulation.sensors.rooms import sensor
from tests.simulation.worlds import GROUND, box, make_simulation, mbot

GENERATOR = np.random.default_rng(0)


def make_imu(simulation: Simulation, link: str, text: str = "", *, seed: int = 0, initial: bool = False) -> ImuSensor:
    element = sensor(f"<imu>{text}</imu>", "imu").imu
    return ImuSensor(Mount(simulation, link), element, generator=np.random.default_rng(seed), initial_reference=initial)


def test_imu_at_rest_measures_gravity_reaction():
    simulation = make_simulation(GROUND, mbot(), gravity="0 0 -9.8")
    sensor = make_imu(simulation, "mbot::base_link")
    simulation.advance(NANOSECONDS_PER_SECOND)
    measurement = sensor.measure()
    assert measurement.linear_acceleration == pytest.approx([0, 0, 9.8], abs=1e-3)
    assert measurement.angular_velocity == pytest.approx([0, 0, 0], abs=1e-4)
    assert measurement.orientation == pytest.approx([0, 0, 0, 1], abs=1e-4)


def test_falling_imu_measures_no_acceleration():
    simulation = make_simulation(box("box", "0 0 9 0.3 0.2 0.1"))
    simulation.advance(NANOSECONDS_PER_SECOND // 10)
    assert make_imu(simulation, "box::link").measure().linear_acceleration == pytest.approx([0, 0, 0], abs=1e-9)


def test_imu_on_curve_measures_centripetal_acceleration():
    simulation = make_simulation(GROUND, mbot())
    motors = [simulation.add_velocity_motor(f"mbot::{side}_joint", 20.0, 5.0) for side in ("left", "right")]
    speed, yaw_rate = 0.3, 0.5
    for hundredth in range(1, 101):
        for motor, side in zip(motors, (-0.19, 0.19), strict=True):
            motor.target = hundredth / 100 * (speed + yaw_rate * side) / 0.06
        simulation.advance(NANOSECONDS_PER_SECOND // 100)
    simulation.advance(NANOSECONDS_PER_SECOND)
    measurement = make_imu(simulation, "mbot::base_link").measure()
    assert measurement.angular_velocity == pytest.approx([0, 0, yaw_rate], abs=1e-3)
    assert measurement.linear_acceleration == pytest.approx([0, speed * yaw_rate, 9.81], abs=2e-3)
    mount = Mount(simulation, "mbot::base_link", (0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
    acceleration = ImuSensor(mount, None, generator=GENERATOR).measure().linear_acceleration
    assert acceleration[0] - measurement.linear_acceleration[0] == pytest.approx(-0.1 * yaw_rate**2, abs=1e-3)


def test_imu_orientation_is_relative_to_world_or_start():
    simulation = make_simulation(box("box", f"0 0 9 0 0 {pi / 2}"))
    assert make_imu(simulation, "box::link").measure().orientation == pytest.approx([0, 0, 0.5**0.5, 0.5**0.5])
    assert make_imu(simulation, "box::link", initial=True).measure().orientation == pytest.approx([0, 0, 0, 1])


def test_imu_noise_has_configured_deviation_and_bias():
    text = (
        '<angular_velocity><x><noise type="gaussian"><stddev>0.2</stddev></noise></x></angular_velocity>'
        '<linear_acceleration><z><noise type="gaussian"><bias_mean>5</bias_mean></noise></z></linear_acceleration>'
    )
    sensor = make_imu(make_simulation(box("box", "0 0 9 0 0 0")), "box::link", text)
    rates = np.array([sensor.measure().angular_velocity for _ in range(2000)])
    assert np.std(rates[:, 0]) == pytest.approx(0.2, rel=0.1)
    assert not rates[:, 1:].any()
    assert list(sensor.angular_velocity_noise.variances) == pytest.approx([0.04, 0, 0])
    assert abs(sensor.measure().linear_acceleration[2] - 9.81) == pytest.approx(5.0)


def test_dynamic_bias_stays_within_its_deviation():
    text = (
        '<angular_velocity><x><noise type="gaussian"><dynamic_bias_stddev>0.5</dynamic_bias_stddev>'
        "<dynamic_bias_correlation_time>0.02</dynamic_bias_correlation_time></noise></x></angular_velocity>"
    )
    simulation = make_simulation(box("box", "0 0 9 0 0 0"))
    sensor, rates = make_imu(simulation, "box::link", text), []
    for _ in range(1000):
        simulation.advance(NANOSECONDS_PER_SECOND // 1000)
        rates.append(sensor.measure().angular_velocity[0])
    assert len(set(rates)) == 1000
    assert 0 < np.std(rates) < 0.5


def test_contact_force_equals_weight():
    simulation = make_simulation(GROUND, box("box", "0 0 0.5 0 0 0", mass=2.0))
    sensor = ContactSensor(Mount(simulation, "box::link"), ["collision"])
    simulation.advance(NANOSECONDS_PER_SECOND)
    (contact,) = sensor.measure()
    assert (contact.collision1, contact.collision2) == ("box::link::collision", "ground::link::collision")
    assert contact.forces.sum(axis=0) == pytest.approx([0, 0, 2 * 9.81], abs=0.05)
    assert contact.torques.sum(axis=0) == pytest.approx([0, 0, 0], abs=0.05)
    assert contact.normals == pytest.approx(np.tile([0.0, 0.0, 1.0], (len(contact.normals), 1)))
    assert contact.positions[:, 2] == pytest.approx(0.0, abs=1e-3)
    assert (contact.depths >= 0).all()


def test_contact_sensor_ignores_flying_links_and_other_collisions():
    simulation = make_simulation(GROUND, box("box", "0 0 5 0 0 0"), box("low", "9 0 0.5 0 0 0"))
    simulation.advance(NANOSECONDS_PER_SECOND // 10)
    assert ContactSensor(Mount(simulation, "box::link")).measure() == []
    assert ContactSensor(Mount(simulation, "low::link"), ["another"]).measure() == []


ARM = """
<model name="arm"><link name="post"><inertial><mass>1</mass></inertial></link>
  <link name="bob"><pose>1 0 0 0 0 0</pose><inertial><mass>2</mass></inertial></link>
  <joint name="held" type="fixed"><parent>world</parent><child>post</child></joint>
  <joint name="wrist" type="fixed"><pose>-1 0 0 0 0 0</pose><parent>post</parent><child>bob</child></joint>
</model>"""


@pytest.mark.parametrize(("direction", "sign"), [("parent_to_child", 1), ("child_to_parent", -1)])
def test_force_torque_sensor_measures_suspended_weight(direction: str, sign: int):
    simulation = make_simulation(ARM)
    simulation.advance(NANOSECONDS_PER_SECOND // 100)
    element = ForceTorque(measure_direction=direction)
    force, torque = ForceTorqueSensor(simulation, "arm::wrist", element, GENERATOR).measure()
    assert sign * force == pytest.approx([0, 0, 2 * 9.81], abs=1e-6)
    assert sign * torque == pytest.approx([0, -2 * 9.81, 0], abs=1e-6)


def test_geodetic_positions_match_wgs_84():
    globe = Globe(SphericalCoordinates(latitude_deg=0.0, longitude_deg=0.0))
    assert globe.to_geodetic(np.zeros(3)) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    # At the equator, a degree is 110 574.3 m to the north and 111 319.5 m to the east. Over 10 m the arc is straight.
    assert globe.to_geodetic(np.array([0.0, 10.0, 5.0])) == pytest.approx((10 / 110574.276, 0.0, 5.0), abs=1e-5)
    assert globe.to_geodetic(np.array([10.0, 0.0, 0.0])) == pytest.approx((0.0, 10 / 111319.491, 0.0), abs=1e-5)
    high = Globe(SphericalCoordinates(latitude_deg=47.5, longitude_deg=8.5, elevation=430.0))
    assert high.to_geodetic(np.zeros(3)) == pytest.approx((47.5, 8.5, 430.0), abs=1e-8)


def test_heading_rotates_world_on_earth():
    globe = Globe(SphericalCoordinates(latitude_deg=10.0, heading_deg=90.0))
    assert globe.to_east_north_up(np.array([1.0, 0.0, 0.0])) == pytest.approx([0, 1, 0])
    latitude, longitude, _ = globe.to_geodetic(np.array([100.0, 0.0, 0.0]))
    assert latitude > 10.0
    assert longitude == pytest.approx(0.0)


def test_navsat_measures_altitude_and_velocity():
    simulation = make_simulation(box("box", "0 0 500 0 0 0"))
    simulation.advance(NANOSECONDS_PER_SECOND)
    fix = NavsatSensor(Mount(simulation, "box::link"), None, SphericalCoordinates(elevation=100.0), GENERATOR).measure()
    assert fix.altitude == pytest.approx(600 - 9.81 / 2, abs=0.01)
    assert fix.velocity == pytest.approx([0, 0, -9.81], abs=1e-6)


@pytest.mark.parametrize(("altitude", "pressure"), [(0.0, 101325.0), (1000.0, 89876.3), (11000.0, 22699.9)])
def test_air_pressure_matches_standard_atmosphere(altitude: float, pressure: float):
    assert standard_pressure(altitude) == pytest.approx(pressure, rel=1e-5)


def test_altimeter_is_relative_to_start():
    simulation = make_simulation(box("box", "0 0 500 0 0 0"))
    altimeter = AltimeterSensor(Mount(simulation, "box::link"), None, GENERATOR)
    simulation.advance(NANOSECONDS_PER_SECOND)
    assert altimeter.measure() == pytest.approx((-9.81 / 2, -9.81), abs=0.01)


def test_magnetometer_measures_field_in_its_axes():
    simulation = make_simulation(box("box", f"0 0 9 0 0 {pi / 2}"))
    field = MagnetometerSensor(Mount(simulation, "box::link"), None, GENERATOR, (1.0, 2.0, 3.0)).measure()
    assert field == pytest.approx([2.0, -1.0, 3.0])
