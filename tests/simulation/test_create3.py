"""Sensors of the base Create 3: cliffs, infrared intensities, bumps, dropped wheels, the optical sensor, the IMU."""

from __future__ import annotations

from math import cos, e, exp, pi, sin

import numpy as np
import pytest

from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND, box

HAZARD_BUMP, HAZARD_CLIFF, HAZARD_DROP = 1, 2, 4


def plugin(name: str, topic: str, parameters: str = "") -> str:
    return (
        f'<plugin name="{name}" filename="libgazebo_ros_create_{name}.so"><ros><remapping>~/out:={topic}</remapping>'
        f"</ros>{parameters}</plugin>"
    )


def ray(content: str, pose: str, max_range: float) -> str:
    """Return a sensor of five rays in a narrow cone along the x axis of the pose."""
    return (
        f'<sensor name="ray" type="ray"><pose>{pose}</pose><update_rate>50</update_rate><ray><scan><horizontal>'
        "<samples>5</samples><min_angle>-0.01</min_angle><max_angle>0.01</max_angle></horizontal></scan><range>"
        f"<min>0.01</min><max>{max_range}</max></range></ray>{content}</sensor>"
    )


def base(content: str, pose: str, *plugins: str) -> str:
    """Return a box of 0.4 x 0.4 x 0.1 m that keeps its pose, with sensors on its link and plugins."""
    text = box("create3", pose, size="0.4 0.4 0.1", mass=2.0).replace("</link>", f"{content}</link>")
    return text.replace("</model>", f"{''.join(plugins)}</model>")


async def record(graph, server, topic: str, seconds: float) -> Recording:
    """Return the messages on a topic in the next seconds."""
    recording = Recording(graph, server.node, topic)
    await graph.settle()
    server.advance(round(seconds * SECOND_NS))
    await graph.settle()
    return recording


CLIFF = plugin("cliff_sensor", "cliff", "<detection_threshold>0.08</detection_threshold><frame_id>front</frame_id>")


@pytest.mark.parametrize(("height", "count"), [(0.07, 0), (0.09, 10), (5.0, 10)])
async def test_cliff_is_published_while_the_floor_is_farther_than_the_threshold(height: float, count: int):
    robot = base(ray(CLIFF, f"0 0 0 0 {pi / 2} 0", 0.15), f"0 0 {height} 0 0 0")
    async with running_server(GROUND, robot, gravity="0 0 0") as (server, graph, log):
        hazards = await record(graph, server, "/cliff", 0.2)
        assert len(hazards) == count
        assert {(hazard.type, hazard.header.frame_id) for hazard in hazards} <= {(HAZARD_CLIFF, "front")}
        assert not log


@pytest.mark.parametrize("distance", [0.05, 0.12, 0.5])
async def test_intensity_falls_exponentially_with_the_distance(distance: float):
    wall = box("wall", f"{0.2 + distance + 0.05} 0 1 0 0 0", size="0.1 2 2").replace("<link", "<static>1</static><link")
    robot = base(ray(plugin("ir_intensity_sensor", "ir"), "0.2 0 0 0 0 0", 0.2), "0 0 1 0 0 0")
    async with running_server(wall, robot, gravity="0 0 0") as (server, graph, log):
        readings = await record(graph, server, "/ir", 0.1)
        assert len(readings) == 5
        assert readings.last.value == pytest.approx(3500 * exp(-2 * e * min(distance, 0.2) / 0.2), rel=0.01, abs=1.0)
        assert readings.last.header.frame_id == "link"
        assert not log


@pytest.mark.parametrize(
    ("direction", "zone"),
    [
        (-1.25, "bump_right"),
        (-0.6, "bump_front_right"),
        (0.0, "bump_front_center"),
        (0.6, "bump_front_left"),
        (1.25, "bump_left"),
        (3.0, None),
    ],
)
async def test_bump_is_published_in_its_zone_of_a_turned_robot(direction: float, zone: str | None):
    heading, x, y = 0.5, 2.0, -1.0
    bearing = heading + direction
    post = (
        f'<model name="post"><static>true</static><pose>{x + 0.299 * cos(bearing)} {y + 0.299 * sin(bearing)} 1 0 0 0'
        '</pose><link name="l"><collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry>'
        "</collision></link></model>"
    )
    sensor = (
        '<sensor name="bumper" type="contact"><update_rate>50</update_rate><contact><collision>collision</collision>'
        f"</contact>{plugin('bumper', 'bump')}</sensor>"
    )
    robot = base(sensor, f"{x} {y} 1 0 0 {heading}").replace(
        "<box><size>0.4 0.4 0.1</size></box>", "<cylinder><radius>0.2</radius><length>0.1</length></cylinder>"
    )
    async with running_server(post, robot, gravity="0 0 0") as (server, graph, log):
        hazards = await record(graph, server, "/bump", 0.05)
        assert {(hazard.type, hazard.header.frame_id) for hazard in hazards} == (
            set() if zone is None else {(HAZARD_BUMP, zone)}
        )
        assert not log


WHEEL = (
    '<link name="wheel"><pose>0 0 -0.1 0 0 0</pose><inertial><mass>0.1</mass></inertial></link>'
    '<joint name="spring" type="prismatic"><parent>link</parent><child>wheel</child><axis><xyz>0 0 -1</xyz><limit>'
    "<lower>0</lower><upper>0.1</upper></limit></axis></joint>"
)


async def test_dropped_wheel_is_published_until_it_is_clearly_back():
    parameters = (
        "<joint_name>spring</joint_name><detection_threshold>0.02</detection_threshold><frame_id>left</frame_id>"
        "<update_rate>50</update_rate>"
    )
    robot = base("", "0 0 1 0 0 0", WHEEL, plugin("wheel_drop", "drop", parameters))
    async with running_server(robot, gravity="0 0 0") as (server, graph, log):
        for position, count in ((0.018, 0), (0.0195, 5), (0.016, 5), (0.014, 0), (0.016, 0)):
            server.simulation.set_joint_position("create3::spring", position)
            hazards = await record(graph, server, "/drop", 0.1)
            assert len(hazards) == count, position
            assert {(hazard.type, hazard.header.frame_id) for hazard in hazards} <= {(HAZARD_DROP, "left")}
        assert not log


async def test_optical_sensor_sums_up_motion_in_the_directions_of_its_link():
    parameters = "<link_name>link</link_name><update_rate>100</update_rate>"
    robot = base("", "0 0 1 0 0 1.2", plugin("optical_mouse", "mouse", parameters))
    async with running_server(robot, gravity="0 0 0") as (server, graph, log):
        forward, left = np.array((cos(1.2), sin(1.2), 0.0)), np.array((-sin(1.2), cos(1.2), 0.0))
        server.simulation.set_model_velocity("create3", tuple(0.3 * forward + 0.1 * left), (0.0, 0.0, 0.0))
        motions = await record(graph, server, "/mouse", 1.0)
        assert len(motions) == 100
        assert motions.last.integrated_x == pytest.approx(0.3, abs=0.005)
        assert motions.last.integrated_y == pytest.approx(0.1, abs=0.005)
        assert (motions.last.header.frame_id, motions.last.last_squal) == ("link", 90)
        assert not log


async def test_acceleration_of_imu_does_not_contain_gravity():
    sensor = f'<sensor name="imu" type="imu"><update_rate>100</update_rate>{plugin("imu", "imu")}</sensor>'
    async with running_server(GROUND, base(sensor, "0 0 0.05 0 0 0.7")) as (server, graph, log):
        measurements = await record(graph, server, "/imu", 0.5)
        acceleration = measurements.last.linear_acceleration
        assert (acceleration.x, acceleration.y, acceleration.z) == pytest.approx((0.0, 0.0, 0.0), abs=0.05)
        assert measurements.last.header.frame_id == "link"
        assert not log


async def test_falling_imu_measures_gravity_in_its_own_axes():
    sensor = f'<sensor name="imu" type="imu"><update_rate>100</update_rate>{plugin("imu", "imu")}</sensor>'
    async with running_server(base(sensor, f"0 0 9 {pi / 2} 0 0")) as (server, graph, _):
        measurements = await record(graph, server, "/imu", 0.2)
        acceleration = measurements.last.linear_acceleration
        assert (acceleration.x, acceleration.y, acceleration.z) == pytest.approx((0.0, -9.81, 0.0), abs=0.05)
