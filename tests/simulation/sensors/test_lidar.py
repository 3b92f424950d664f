"""Lidars in front of walls at known distances."""

from __future__ import annotations

from math import cos, pi, sin, sqrt

import numpy as np
import pytest

from linkwright.simulation.sensors.lidar import LidarSensor
from linkwright.simulation.sensors.mount import Mount
from linkwright.simulation.simulation import Simulation
from tests.simulation.sensors.rooms import block, carrier, carrier_mount, lidar, room, single_row_lidar
from tests.simulation.worlds import GROUND, box, make_simulation, model

GAUSSIAN = '<noise type="gaussian"><mean>0</mean><stddev>0.01</stddev></noise>'


def make_lidar_sensor(simulation: Simulation, element, *, visuals: bool = False, seed: int = 0) -> LidarSensor:
    return LidarSensor(carrier_mount(simulation), element, sees_visuals=visuals, generator=np.random.default_rng(seed))


def distance_in_room(angle: float) -> float:
    """Return the distance from the origin to the walls of `room` in a direction."""
    x, y = cos(angle), sin(angle)
    distance_along_x = 3 / x if x > 0 else -2 / x if x < 0 else float("inf")
    distance_along_y = 4 / y if y > 0 else -5 / y if y < 0 else float("inf")
    return min(distance_along_x, distance_along_y)


@pytest.mark.parametrize("visuals", [False, True])
def test_ranges_in_room_are_exact(visuals: bool):
    scan = make_lidar_sensor(
        make_simulation(room(), carrier()), single_row_lidar(720, -3.0, 3.0), visuals=visuals
    ).measure()
    expected = [distance_in_room(angle) for angle in np.linspace(-3.0, 3.0, 720)]
    assert np.abs(scan.ranges[0] - expected).max() < 1e-6


def test_rays_rotate_with_link():
    scan = make_lidar_sensor(
        make_simulation(room(), carrier(f"1 0 0 0 0 {pi / 2}")), single_row_lidar(1, 0.0, 0.0)
    ).measure()
    assert scan.ranges == pytest.approx(np.array([[4.0]]), abs=1e-9)


def test_vertical_rings_are_angled_up_and_down():
    element = lidar(
        "<scan><horizontal><samples>1</samples></horizontal><vertical><samples>3</samples>"
        f"<min_angle>{-pi / 4}</min_angle><max_angle>{pi / 4}</max_angle></vertical></scan>"
        "<range><min>0.1</min><max>30</max></range>"
    )
    scan = make_lidar_sensor(make_simulation(GROUND, room(), carrier("0 0 1 0 0 0")), element).measure()
    assert scan.ranges[:, 0] == pytest.approx([sqrt(2), 3.0, 3 * sqrt(2)], abs=1e-9)


def test_out_of_range_values_are_infinite_as_in_rep_117():
    world = block("far", "9 0 0 0 0 0", "1 1 1"), block("near", "0 0.55 0 0 0 0", "1 1 1")
    scan = make_lidar_sensor(make_simulation(*world, carrier()), single_row_lidar(3, 0.0, pi, max_range=8.0)).measure()
    assert list(scan.ranges[0]) == [np.inf, -np.inf, np.inf]


def test_retro_reflectivity_sets_intensity():
    simulation = make_simulation(block("shiny", "3 0 0 0 0 0", "1 1 1", retro=200.0), carrier())
    scan = make_lidar_sensor(simulation, single_row_lidar(2, 0.0, pi)).measure()
    assert list(scan.intensities[0]) == [200.0, 0.0]


def test_lidar_detects_collisions_or_visuals():
    invisible = box("invisible", "3 0 0 0 0 0")
    for visuals, expected in ((False, 2.5), (True, np.inf)):
        assert (
            make_lidar_sensor(make_simulation(invisible, carrier()), single_row_lidar(1, 0, 0), visuals=visuals)
            .measure()
            .ranges[0, 0]
            == expected
        )


ROBOT = """
<model name="robot"><static>true</static>
  <link name="base"><collision name="c"><geometry><cylinder><radius>0.3</radius><length>1</length></cylinder></geometry>
  </collision></link>
  <link name="laser"><collision name="c"><geometry><sphere><radius>0.5</radius></sphere></geometry></collision></link>
</model>"""


@pytest.mark.parametrize(("min_range", "expected"), [(0.1, 0.3), (0.35, 3.0)])
def test_lidar_sees_its_robot_but_not_its_own_link(min_range: float, expected: float):
    simulation = make_simulation(room(), ROBOT)
    sensor = LidarSensor(
        Mount(simulation, "robot::laser"),
        single_row_lidar(1, 0, 0, min_range=min_range),
        sees_visuals=False,
        generator=np.random.default_rng(0),
    )
    assert sensor.measure().ranges[0, 0] == pytest.approx(expected, abs=1e-9)


def test_noise_depends_on_seed_and_stays_in_range():
    simulation = make_simulation(room(), carrier())
    parameters = single_row_lidar(2000, -1.0, 1.0, GAUSSIAN, max_range=3.4)
    first, repeated, second = (
        make_lidar_sensor(simulation, parameters, seed=seed).measure().ranges[0] for seed in (1, 1, 2)
    )
    assert (first == repeated).all()
    assert not (first == second).all()
    exact = make_lidar_sensor(simulation, single_row_lidar(2000, -1.0, 1.0, max_range=3.4)).measure().ranges[0]
    finite = np.isfinite(exact)
    assert (np.isfinite(first) == finite).all()
    assert first[finite].max() <= 3.4
    is_inside = exact < 3.35
    assert np.std(first[is_inside] - exact[is_inside]) == pytest.approx(0.01, rel=0.1)


def test_spawned_models_are_detected():
    simulation = make_simulation(room(), carrier())
    sensor = make_lidar_sensor(simulation, single_row_lidar(1, 0, 0))
    assert sensor.measure().ranges[0, 0] == pytest.approx(3.0)
    simulation.spawn(model(box("box", "0 0 0 0 0 0")), "box", (2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
    assert sensor.measure().ranges[0, 0] == pytest.approx(1.5)


def test_ray_angles_match_gazebo():
    parameters = single_row_lidar(360, 0.0, 6.28)
    angles = parameters.horizontal
    assert (angles.count, angles.step) == (360, pytest.approx(6.28 / 359))
    assert single_row_lidar(1, 0.5, 0.7).horizontal.step == 0.0
