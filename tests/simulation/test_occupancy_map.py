"""Maps of worlds at a height."""

from __future__ import annotations

import numpy as np

from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND, box

WALLS = (
    box("north", "0 1.97 0.5 0 0 0", "3.84 0.1 1"),
    box("south", "0 -1.97 0.5 0 0 0", "3.84 0.1 1"),
    box("east", "1.97 0 0.5 0 0 0", "0.1 4.04 1"),
    box("west", "-1.97 0 0.5 0 0 0", "0.1 4.04 1"),
)
CRATE, LOW = box("crate", "1.03 0.53 0.5 0 0 0", "0.8 0.8 1"), box("low", "-1 -1 0.1 0 0 0", "0.4 0.4 0.2")


async def generate(parameters: str, *parts: str):
    plugin = f'<plugin name="map" filename="libgazebo_2Dmap_plugin.so">{parameters}</plugin>'
    async with running_server(GROUND, *parts, plugin) as (server, graph, log):
        node = graph.create_node("navigator")
        maps = Recording(graph, node, "/map2d")
        client = node.create_client("std_srvs/srv/Empty", "/gazebo_2Dmap_plugin/generate_map")
        request = client.call_async(get_message("std_srvs/srv/Empty_Request")())
        await graph.settle()
        server.advance(SECOND_NS // 100)
        await graph.settle()
        assert request.done()
        assert not log
        return maps.last


async def test_map_shows_what_a_robot_reaches_at_a_height():
    size = "<map_size_x>5</map_size_x><map_size_y>6</map_size_y>"
    grid = await generate(size, *WALLS, CRATE, LOW)
    cells = np.array(grid.data).reshape(grid.info.height, grid.info.width)

    def value(x: float, y: float) -> int:
        return int(cells[int((y + 3) / 0.1), int((x + 2.5) / 0.1)])

    assert (grid.info.width, grid.info.height, grid.info.resolution) == (50, 60, np.float32(0.1))
    assert (grid.info.origin.position.x, grid.info.origin.position.y) == (-2.5, -3.0)
    assert value(0.05, 0.05) == value(-1.05, -1.05) == 0  # the low box is below the map
    assert value(0.65, 0.55) == value(0.05, 1.92) == 100
    assert value(1.05, 0.55) == value(0.05, 2.55) == -1  # inside of the crate, and outside of the room
    inside = cells == 0
    room, crate = 3.8**2, 0.8**2
    assert abs(inside.sum() * 0.01 - (room - crate)) < 0.1 * room


async def test_map_starts_at_the_initial_position_with_its_resolution():
    parameters = "<map_resolution>0.2</map_resolution><init_robot_x>3</init_robot_x>"
    grid = await generate(parameters, *WALLS)
    cells = np.array(grid.data).reshape(50, 50)
    assert cells[25, 25] == -1
    assert cells[25, 40] == 0


async def test_map_that_begins_in_an_obstacle_is_unknown():
    grid = await generate("<init_robot_x>-1.95</init_robot_x>", box("pole", "-1.95 0 0.5 0 0 0", "0.14 0.14 1"))
    assert set(grid.data) == {-1}
