"""The TurtleSim panel: pages receive turtles, and the lines that they lack."""

from __future__ import annotations

from base64 import b64decode
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from linkwright.nodes import NodeOptions
from linkwright.nodes.turtlesim.canvas import SIZE_PX, Canvas
from linkwright.nodes.turtlesim.simulator import Turtlesim
from linkwright.panels.turtlesim import TurtlesimFeature
from tests.viewer.scene import World, open_page, open_world

RED = (255, 0, 0)


def start_turtlesim(world: World, namespace: str = "/") -> Turtlesim:
    simulator = Turtlesim(world.graph, NodeOptions(namespace=namespace))
    world.viewer.add_feature(TurtlesimFeature).show(simulator)
    return simulator


def read_png(data: bytes) -> np.ndarray:
    return np.asarray(Image.open(BytesIO(data)))


def draw(pixels: np.ndarray, lines: dict) -> None:
    """Draw the lines of a message as the page does."""
    image = read_png(b64decode(lines["image"]))
    left, top = lines["left"], lines["top"]
    pixels[top : top + image.shape[0], left : left + image.shape[1]] = image


@pytest.mark.parametrize("starts_late", [False, True])
async def test_page_knows_the_nodes_that_run(starts_late: bool) -> None:
    async with open_world() as world:
        simulator = None if starts_late else start_turtlesim(world, "/sea")
        async with open_page(world.viewer) as client:
            if simulator is None:
                await client.opened()
                simulator = start_turtlesim(world, "/sea")
            names = [entry["name"] for entry in (await client.until("turtle_simulators"))["simulators"]]
            assert names == ["/sea/turtlesim"]
            simulator.close()
            assert (await client.until("turtle_simulators"))["simulators"] == []


async def test_watching_page_receives_turtles_and_background() -> None:
    async with open_world() as world:
        simulator = start_turtlesim(world, "/sea")
        async with open_page(world.viewer) as client:
            await client.send("watch_turtles", is_watched=True)
            scene = await client.until("turtle_scene")
            (turtle,) = scene["turtles"]
            assert (scene["background"], turtle["name"], turtle["topic"]) == (
                "#4556ff",
                "turtle1",
                "/sea/turtle1/cmd_vel",
            )
            assert (turtle["x"], turtle["theta"]) == (pytest.approx(499 / 90), 0.0)
            simulator.turtles["turtle1"].x = 3.0
            assert (await client.until("turtle_scene"))["turtles"][0]["x"] == 3.0
        simulator.close()


async def test_pages_have_all_lines_whenever_they_watch() -> None:
    async with open_world() as world:
        simulator = start_turtlesim(world)
        canvas = simulator.canvas
        canvas.draw_line((1.0, 1.0), (3.0, 2.0), RED, 3)
        async with open_page(world.viewer) as client:
            await client.send("watch_turtles", is_watched=True)
            pixels = np.empty((SIZE_PX, SIZE_PX, 4), np.uint8)
            pixels[:] = (255, 255, 255, 0)
            draw(pixels, await client.until("turtle_lines"))
            assert (pixels == canvas.pixels).all()
            canvas.draw_line((8.0, 8.0), (8.1, 8.0), RED, 3)
            lines = await client.until("turtle_lines")
            assert read_png(b64decode(lines["image"])).shape[:2] < (10, 20)
            draw(pixels, lines)
            assert (pixels == canvas.pixels).all()
            canvas.clear()
            draw(pixels, await client.until("turtle_lines"))
            assert not pixels[..., 3].any()
        simulator.close()


def test_changed_area_is_everything_if_the_version_is_old() -> None:
    canvas = Canvas()
    first = canvas.version
    canvas.draw_line((1.0, 1.0), (1.0, 1.0), RED, 3)
    left, top, right, bottom = canvas.find_changed_area(first)
    assert (left, top) < (45, SIZE_PX - 45) < (right, bottom)
    assert (right - left) * (bottom - top) <= 36
    for _ in range(1000):
        canvas.draw_line((1.0, 1.0), (1.0, 1.0), RED, 3)
    assert canvas.find_changed_area(first) == (0, 0, SIZE_PX, SIZE_PX)
    assert canvas.find_changed_area(canvas.version - 1).right < 60
