"""Map and GridCells, from topics to pages."""

from __future__ import annotations

import asyncio
import math

import numpy as np

from linkwright.graph import DurabilityPolicy, QoSProfile
from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.skipping import skipping
from tests.viewer.contents import unpack_contents
from tests.viewer.scene import open_page, open_world
from tests.waiting import eventually

OccupancyGrid = get_message("nav_msgs/msg/OccupancyGrid")
OccupancyGridUpdate = get_message("map_msgs/msg/OccupancyGridUpdate")
GridCells = get_message("nav_msgs/msg/GridCells")
Point = get_message("geometry_msgs/msg/Point")

FILE = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/CLS
      Enabled: true
      Name: Map
      Topic: {Value: /map}
  Global Options:
    Fixed Frame: base
"""


def make_config(cls: str = "Map") -> RvizConfig:
    return RvizConfig.parse(FILE.replace("CLS", cls))


def make_grid(width: int = 3, height: int = 2, frame: str = "base", data=None):
    message = OccupancyGrid()
    message.header.frame_id = frame
    message.info.width, message.info.height, message.info.resolution = width, height, 0.5
    message.info.origin.position.x = -1.0
    message.info.origin.orientation.w = 1.0
    message.data = list(range(width * height)) if data is None else data
    return message


def make_update(x: int, y: int, width: int, height: int, data):
    return OccupancyGridUpdate(x=x, y=y, width=width, height=height, data=data)


def drawn_cells(display) -> list[list[int]]:
    (content,) = unpack_contents(display)
    fields = content.fields
    return fields["cells"].view(np.int8).reshape(fields["height"], fields["width"]).tolist()


async def test_map_is_sent_and_follows_its_frame():
    async with open_world(make_config()) as world, open_page(world.viewer) as client:
        await client.opened()
        publisher = world.graph.create_node("map").create_publisher(OccupancyGrid, "/map", 1)
        assert world.status("Map")["Message"] == ("warn", "No map received")
        publisher.publish(make_grid(data=[0, 100, -1, 50, -128, 127]))
        await world.settle()
        (content,) = unpack_contents(world.display("Map"))
        assert (content.frame, content.pose) == ("base", None)
        assert content.fields["kind"] == "occupancy_map"
        assert content.fields["origin"] == [-1, 0, 0, 0, 0, 0, 1]
        assert drawn_cells(world.display("Map")) == [[0, 100, -1], [50, -128, 127]]
        assert world.status("Map") == {
            "Topic": ("ok", "1 messages received"),
            "Message": ("ok", "Map received"),
            "Update Topic": ("ok", "OK"),
            "Transform": ("ok", "Transform OK"),
            "Map": ("ok", "Map OK"),
        }


async def test_map_metadata_is_shown_in_read_only_rows():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("map").create_publisher(OccupancyGrid, "/map", 1)
        publisher.publish(make_grid())
        await world.settle()
        rows = {row.name: row for row in world.display("Map").properties.rows()}
        assert [(rows[name].value, rows[name].read_only) for name in ("Resolution", "Width", "Height")] == [
            (0.5, True),
            (3, True),
            (2, True),
        ]
        assert [child.value for child in rows["Position"].children] == [-1.0, 0.0, 0.0]
        assert [child.value for child in rows["Orientation"].children] == [0.0, 0.0, 0.0, 1.0]
        assert "Resolution" not in world.viewer.manager.config.text()


async def test_map_updates_change_part_of_map():
    async with open_world(make_config()) as world:
        node = world.graph.create_node("map")
        publisher = node.create_publisher(OccupancyGrid, "/map", 1)
        updates = node.create_publisher(OccupancyGridUpdate, "/map_updates", 5)
        updates.publish(make_update(0, 0, 1, 1, [7]))  # before there is a map
        original = make_grid()
        publisher.publish(original)
        await world.settle()
        updates.publish(make_update(1, 0, 2, 2, [10, 20, 30, 40]))
        await eventually(lambda: drawn_cells(world.display("Map")) == [[0, 10, 20], [3, 30, 40]])
        assert world.status("Map")["Update"] == ("ok", "Update OK")
        assert list(original.data) == [0, 1, 2, 3, 4, 5]
        updates.publish(make_update(2, 0, 2, 1, [1, 1]))
        await world.settle()
        assert world.status("Map")["Update"] == ("error", "Update area outside of original map area.")
        updates.publish(make_update(0, 0, 2, 2, [1, 1]))
        await world.settle()
        assert world.status("Map")["Update"][1].startswith("Data size doesn't match width*height")
        assert drawn_cells(world.display("Map")) == [[0, 10, 20], [3, 30, 40]]


@skipping
async def test_map_updates_wait_while_time_is_paused():
    async with open_world(make_config()) as world:
        node = world.graph.create_node("map")
        maps, updates = (
            node.create_publisher(OccupancyGrid, "/map", 1),
            node.create_publisher(OccupancyGridUpdate, "/map_updates", 5),
        )
        maps.publish(make_grid(data=[0] * 6))
        await world.settle()
        world.viewer.manager.set_time(paused=True, mode="Off", source="")
        updates.publish(make_update(0, 0, 1, 1, [99]))
        await asyncio.sleep(0.2)
        assert drawn_cells(world.display("Map")) == [[0, 0, 0], [0, 0, 0]]
        world.viewer.manager.set_time(paused=False, mode="Off", source="")
        await eventually(lambda: drawn_cells(world.display("Map")) == [[99, 0, 0], [0, 0, 0]])


async def test_updated_map_survives_fixed_frame_change():
    async with open_world(make_config()) as world:
        node = world.graph.create_node("map")
        world.move({("base", "other"): (1, 0, 0, 0, 0, 0, 1)}, static=True)
        node.create_publisher(OccupancyGrid, "/map", 1).publish(make_grid())
        await world.settle()
        node.create_publisher(OccupancyGridUpdate, "/map_updates", 5).publish(make_update(0, 0, 1, 1, [99]))
        await eventually(lambda: drawn_cells(world.display("Map"))[0] == [99, 1, 2])
        world.viewer.manager.set_fixed_frame("other")
        await world.settle()
        assert drawn_cells(world.display("Map"))[0] == [99, 1, 2]


async def test_invalid_maps_are_reported_with_messages_of_rviz():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("map").create_publisher(OccupancyGrid, "/map", 1)

        async def status(message) -> tuple[str, str]:
            publisher.publish(message)
            await world.settle()
            assert unpack_contents(world.display("Map")) == []
            return world.status("Map")["Map"]

        assert await status(make_grid(0, 4)) == ("error", "Map is zero-sized (0x4)")
        text = "Data size doesn't match width*height: width = 3, height = 2, data size = 1"
        assert await status(make_grid(data=[0])) == ("error", text)
        invalid_map = make_grid()
        invalid_map.info.resolution = math.nan
        assert await status(invalid_map) == ("error", "Message contained invalid floating point values (nans or infs)")


async def test_update_topic_follows_map_topic():
    async with open_world(make_config()) as world:
        display = world.display("Map")
        display.set_property(("Topic",), "/other")
        assert display.properties.text("Update Topic") == "/other_updates"
        display.set_property(("Update Topic",), "/mine")
        node = world.graph.create_node("map")
        node.create_publisher(OccupancyGrid, "/other", 1).publish(make_grid())
        await world.settle()
        node.create_publisher(OccupancyGridUpdate, "/mine", 5).publish(make_update(0, 0, 1, 1, [55]))
        await eventually(lambda: drawn_cells(display)[0][0] == 55)


async def test_default_update_topic_is_not_written_to_file():
    async with open_world(make_config()) as world, open_page(world.viewer) as client:
        await client.opened()
        manager, display = world.viewer.manager, world.display("Map")
        text = manager.config.text()
        assert display.properties.text("Update Topic") == "/map_updates"
        await client.send("set_property", id=f"{display.id}/Topic", value="/other")
        await client.until("property_changed", id=f"{display.id}/Update Topic", value="/other_updates")
        assert manager.config.text() == text.replace("/map", "/other")
        await client.send("set_property", id=f"{display.id}/Update Topic", value="/mine")
        await client.until("property_changed", id=f"{display.id}/Update Topic", value="/mine")
        manager.history.undo()
        assert display.properties.text("Update Topic") == "/other_updates"
        manager.history.undo()
        assert display.properties.text("Update Topic") == "/map_updates"
        assert manager.config.text() == text


async def test_use_timestamp_keeps_map_at_its_stamp():
    async with open_world(make_config()) as world:
        node = world.graph.create_node("map")
        publisher = node.create_publisher(
            OccupancyGrid, "/map", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        )
        world.move({("base", "map"): (1, 2, 0, 0, 0, 0, 1)}, static=True)
        display = world.display("Map")
        publisher.publish(make_grid(frame="map"))
        await world.settle()
        assert unpack_contents(display)[0].pose is None
        display.set_property(("Use Timestamp",), True)
        assert unpack_contents(display)[0].pose == [1, 2, 0, 0, 0, 0, 1]


async def test_map_without_frame_is_in_map_frame():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("map").create_publisher(OccupancyGrid, "/map", 1)
        publisher.publish(make_grid(frame=""))
        await world.settle()
        assert world.status("Map")["Transform"][1].startswith("Could not transform from [map] to [base]")
        world.move({("base", "map"): (0, 0, 0, 0, 0, 0, 1)}, static=True)
        await world.settle()
        assert unpack_contents(world.display("Map"))[0].frame == "map"


# --- GridCells -------------------------------------------------------------------------------------------------------


def make_cell_grid(*positions: float, width: float = 0.5, height: float = 0.25):
    message = GridCells(cell_width=width, cell_height=height, cells=[Point(x=x) for x in positions])
    message.header.frame_id = "base"
    return message


async def test_grid_cells_are_sent():
    async with open_world(make_config("GridCells")) as world:
        publisher = world.graph.create_node("map").create_publisher(GridCells, "/map", 1)
        publisher.publish(make_cell_grid(1.0, 2.0))
        await world.settle()
        (content,) = unpack_contents(world.display("GridCells"))
        fields = content.fields
        assert fields["positions"].tolist() == [1, 0, 0, 2, 0, 0]
        assert (fields["kind"], fields["width"], fields["height"]) == ("cell_grid", 0.5, 0.25)


async def test_invalid_grid_cells_are_reported_with_messages_of_rviz():
    async with open_world(make_config("GridCells")) as world:
        publisher = world.graph.create_node("map").create_publisher(GridCells, "/map", 1)

        async def status(message) -> tuple[str, str]:
            publisher.publish(make_cell_grid(1.0))
            publisher.publish(message)
            await world.settle()
            assert unpack_contents(world.display("GridCells")) == []
            return world.status("GridCells")["Topic"]

        text = "Message contained invalid floating point values (nans or infs)"
        assert await status(make_cell_grid(math.nan)) == ("error", text)
        text = "One of the Cell's dimension is zero, cells will be invisible."
        assert await status(make_cell_grid(1.0, height=0.0)) == ("error", text)
        assert await status(make_cell_grid()) == ("warn", "Message is empty: there are no cells to be shown.")
