"""Thermal cameras: the temperatures of visuals and of the surroundings, as gray values."""

from __future__ import annotations

import numpy as np
import pytest

from tests.simulation.sensors.rooms import block
from tests.simulation.sensors.test_topics import CAMERA, last_messages, robot_with, running_server, sensor

AMBIENT_K = 288.15
SYSTEM = '<plugin filename="gz-sim-thermal-system" name="gz::sim::systems::Thermal">{}</plugin>'


def warm_block(name: str, pose: str, settings: str) -> str:
    return block(name, pose, "0.1 0.4 0.4").replace("</visual>", SYSTEM.format(settings) + "</visual>")


def thermal(image_format: str = "L16", settings: str = "", kind: str = "thermal_camera") -> str:
    camera = CAMERA.replace("</image>", f"<format>{image_format}</format></image>")
    plugin = (
        f'<plugin filename="gz-sim-thermal-sensor-system" name="gz::sim::systems::ThermalSensor">{settings}</plugin>'
    )
    return robot_with(sensor(kind, f"<topic>heat</topic>{camera}{plugin if settings else ''}"))


def pixels(message) -> np.ndarray:
    kind = {"mono8": np.uint8, "mono16": "<u2"}[message.encoding]
    return np.frombuffer(bytes(message.data), kind).reshape(message.height, message.width)


async def measure(robot: str, *parts: str) -> tuple[np.ndarray, list[str]]:
    async with running_server(*parts, robot) as (server, graph, log):
        image, info = await last_messages(server, graph, "/heat", "/camera_info")
        assert (info.width, info.header.frame_id) == (image.width, image.header.frame_id)
        return pixels(image), [record.text for record in log if "rendered by" not in record.text]


CUP = warm_block("cup", "2 0.5 0 0 0 0", "<temperature>310</temperature>")
ICE = warm_block("ice", "2 -0.5 0 0 0 0", "<temperature>270.5</temperature>")
WALL = block("wall", "4 0 0 0 0 0", "0.1 2 2")


@pytest.mark.parametrize("kind", ["thermal", "thermal_camera"])
async def test_pixels_are_temperatures_in_hundredths_of_a_kelvin(kind: str):
    image, log = await measure(thermal(kind=kind), CUP, ICE, WALL)
    assert set(image.reshape(-1).tolist()) == {31000, 27050, round(AMBIENT_K * 100)}
    assert image[24, 24 - 2] == 31000  # to the left
    assert image[24, 40] == 27050
    assert image[0, 0] == round(AMBIENT_K * 100)  # nothing is there
    assert not log


async def test_surroundings_have_the_temperature_of_the_atmosphere():
    image, _ = await measure(
        thermal(), WALL, "<atmosphere type='adiabatic'><temperature>300</temperature></atmosphere>"
    )
    assert set(image.reshape(-1).tolist()) == {30000}


@pytest.mark.parametrize(("settings", "resolution"), [("", 3.0), ("<resolution>2</resolution>", 2.0)])
async def test_images_of_8_bits_have_a_coarse_resolution(settings: str, resolution: float):
    image, _ = await measure(thermal("L8", settings), CUP, WALL)
    assert set(image.reshape(-1).tolist()) == {round(310 / resolution), round(AMBIENT_K / resolution)}


async def test_temperatures_are_limited_to_those_that_the_sensor_measures():
    settings = "<min_temp>280</min_temp><max_temp>300</max_temp><resolution>0.02</resolution>"
    image, _ = await measure(thermal(settings=settings), CUP, ICE, WALL)
    assert set(image.reshape(-1).tolist()) == {15000, 14000, round(AMBIENT_K / 0.02)}


async def test_values_do_not_overflow():
    image, _ = await measure(thermal(), warm_block("sun", "2 0 0 0 0 0", "<temperature>6000</temperature>"))
    assert image.max() == 65535


async def test_heat_signature_has_the_middle_of_its_temperatures():
    signature = "<heat_signature>body.png</heat_signature><min_temp>300</min_temp><max_temp>310</max_temp>"
    image, _ = await measure(thermal(), warm_block("body", "2 0 0 0 0 0", signature))
    assert image[24, 32] == 30500
