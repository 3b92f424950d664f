"""Air speed and distance sensors of PX4's models."""

from __future__ import annotations

import numpy as np
import pytest

from tests.simulation.px4.test_px4_sensors import moving, plugin, record
from tests.simulation.worlds import GROUND, box

WIND = "<wind><linear_velocity>-3 0 0</linear_velocity></wind>"


def with_sensor(sensor: str, pose: str) -> str:
    """Return a model with a sensor on its link."""
    return box("uav", pose).replace("</link>", f"{sensor}</link>")


def pitot(parameters: str = "") -> str:
    """Return a sensor that measures the speed of the air."""
    return f'<sensor name="airspeed" type="gps">{plugin("airspeed", parameters)}</sensor>'


def distance_sensor(parameters: str = "", pose: str = "0 0 0 0 1.5707963267948966 0") -> str:
    """Return a sensor with a ray, which points down by default."""
    scan = "<scan><horizontal><samples>1</samples><min_angle>0</min_angle><max_angle>0</max_angle></horizontal></scan>"
    ray = f"<ray>{scan}<range><min>0.06</min><max>35</max></range></ray>"
    rate = "<update_rate>20</update_rate>"
    return f'<sensor name="laser" type="ray"><pose>{pose}</pose>{rate}{ray}{plugin("lidar", parameters)}</sensor>'


@pytest.mark.parametrize(
    ("world", "yaw", "speed", "expected_speed"),
    [("", 0.0, 15.0, 15.0), (WIND, 0.0, 15.0, 18.0), ("", np.pi, 15.0, -15.0), ("", np.pi / 2, 15.0, 0.0)],
)
async def test_airspeed_is_dynamic_pressure_of_the_air_along_x(world, yaw, speed, expected_speed):
    quiet = "<DiffPressureStdev>0</DiffPressureStdev>"
    (recording,) = await record(
        world,
        with_sensor(pitot(quiet), f"0 0 100 0 0 {yaw}"),
        topics=("/uav/link/uav",),
        prepare=moving(speed),
    )
    assert len(recording) == 20
    density = 1.225 * ((288.15 - 0.0065 * (488 + 100)) / 288.15) ** 4.256
    expected = 0.5 * density * expected_speed * abs(expected_speed)
    assert recording.last.fluid_pressure == pytest.approx(expected, abs=1e-6)
    assert recording.last.header.frame_id == "link"


async def test_airspeed_has_noise_of_one_hundredth_of_a_hectopascal():
    (recording,) = await record(
        with_sensor(pitot("<topic>pitot</topic>"), "0 0 100 0 0 0"), topics=("/uav/link/pitot",), seconds=60
    )
    assert np.std([message.fluid_pressure for message in recording]) == pytest.approx(1.0, rel=0.15)
    assert recording.last.variance == 1.0


@pytest.mark.parametrize(
    ("height", "parameters", "expected"),
    [
        (4.0, "", 4.0),
        (20.0, "", 0.0),  # beyond the maximum
        (20.0, "<max_distance>50</max_distance>", 20.0),
        (34.0, "<max_distance>50</max_distance>", 34.0),
        (40.0, "<max_distance>50</max_distance>", 0.0),  # the sensor never sees farther than 35 m
        (1.0, "<min_distance>1.5</min_distance>", 1.5),
    ],
)
async def test_distance_is_limited_as_by_the_plugin(height, parameters, expected):
    (recording,) = await record(
        GROUND, with_sensor(distance_sensor(parameters), f"0 0 {height} 0 0 0"), topics=("/uav/link/uav",)
    )
    message = recording.last
    assert len(recording) == 40
    assert message.range == pytest.approx(expected, abs=1e-4)
    assert message.field_of_view == pytest.approx(np.radians(3))
    assert message.max_range == pytest.approx(35.0 if "max" in parameters else 15.0)


async def test_distance_sensor_has_an_older_name():
    older = distance_sensor().replace("libgazebo_lidar_plugin.so", "librotors_gazebo_lidar_plugin.so")
    (recording,) = await record(GROUND, with_sensor(older, "0 0 3 0 0 0"), topics=("/uav/link/uav",))
    assert recording.last.range == pytest.approx(3.0, abs=1e-4)


async def test_fog_hides_everything_beyond_two_meters():
    for height, expected, deviation in ((1.5, 1.5, 0.0), (10.0, 2.0, 0.1)):
        (recording,) = await record(
            GROUND,
            with_sensor(distance_sensor("<simulate_fog>true</simulate_fog>"), f"0 0 {height} 0 0 0"),
            topics=("/uav/link/uav",),
            seconds=20,
        )
        distances = [message.range for message in recording]
        assert np.mean(distances) == pytest.approx(expected, abs=0.02)
        assert np.std(distances) == pytest.approx(deviation, abs=0.02)
