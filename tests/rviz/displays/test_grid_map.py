"""GridMap: surfaces of layers."""

from __future__ import annotations

from contextlib import asynccontextmanager
from typing import Any

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.viewer.contents import unpack_contents
from tests.viewer.scene import open_world

GridMap = get_message("grid_map_msgs/msg/GridMap")
Layer = get_message("std_msgs/msg/Float32MultiArray")
Dimension = get_message("std_msgs/msg/MultiArrayDimension")
NAN = float("nan")


def make_config(extra: str = "") -> RvizConfig:
    return RvizConfig.parse(
        "Visualization Manager:\n  Global Options: {Fixed Frame: base}\n  Displays:\n"
        f"    - {{Class: grid_map_rviz_plugin/GridMap, Enabled: true, Topic: /grid_map, Name: Map{extra}}}\n"
    )


def make_grid_map(resolution: float = 1.0, **layers: list[list[float]]) -> Any:
    """Return a map of layers; rows go along -x, columns along -y, as in grid_map."""
    (rows, columns) = np.shape(next(iter(layers.values())))
    grid_map = GridMap(layers=list(layers))
    grid_map.header.frame_id = "base"
    grid_map.info.resolution = resolution
    grid_map.info.length_x, grid_map.info.length_y = rows * resolution, columns * resolution
    for cells in layers.values():
        numbers = np.asarray(cells, dtype=np.float32).T.reshape(-1)
        layer = Layer(data=numbers.tolist())
        layer.layout.dim = [Dimension(label="column_index", size=columns), Dimension(label="row_index", size=rows)]
        grid_map.data.append(layer)
    return grid_map


@asynccontextmanager
async def open_display(extra: str = ""):
    """Return a display, and a function that publishes a map and returns the sent content."""
    async with open_world(make_config(extra)) as world:
        world.move_arm()
        publisher = world.graph.create_node("mapper").create_publisher(GridMap, "/grid_map", 10)
        await world.settle()

        async def publish_and_settle(message: Any) -> dict[str, Any] | None:
            publisher.publish(message)
            await world.settle()
            grid_contents = unpack_contents(world.display("GridMap"))
            return grid_contents[-1].fields if grid_contents else None

        yield world, publish_and_settle


async def test_grid_map_properties_match_rviz():
    async with open_display() as (world, _):
        rows = {row.name: row.value for row in world.display("GridMap").row().properties}
        assert rows == {
            "Topic": "/grid_map",
            "Alpha": 1.0,
            "History Length": 1,
            "Show Grid Lines": True,
            "Height Transformer": "GridMapLayer",
            "Height Layer": "elevation",
            "Color Transformer": "GridMapLayer",
            "Color Layer": "elevation",
            "Use Rainbow": True,
            "Invert Rainbow": False,
            "Autocompute Intensity Bounds": True,
        }
    async with open_display(", Use ColorMap: false") as (world, _):
        assert {"Use ColorMap", "Min Color"} <= {row.name for row in world.display("GridMap").row().properties}


async def test_first_cell_has_largest_x_and_y():
    async with open_display() as (world, publish_and_settle):
        grid_map = make_grid_map(0.5, elevation=[[1, 2, 3], [4, 5, 6]])
        grid_map.info.pose.position.x = 10.0
        content = await publish_and_settle(grid_map)
        assert (content["rows"], content["columns"]) == (2, 3)
        points = content["points"].reshape(2, 3, 3)
        np.testing.assert_allclose(points[0, 0], [10.25, 0.5, 1])
        np.testing.assert_allclose(points[1, 2], [9.75, -0.5, 6])
        assert world.status("GridMap")["Transform"] == ("ok", "Transform OK")


async def test_circular_buffer_start_index_is_applied():
    async with open_display() as (_, publish_and_settle):
        grid_map = make_grid_map(elevation=[[4, 3], [2, 1]])
        grid_map.outer_start_index = grid_map.inner_start_index = 1
        content = await publish_and_settle(grid_map)
        assert content["points"].reshape(-1, 3)[:, 2].tolist() == [1, 2, 3, 4]


async def test_nan_cells_are_not_drawn():
    async with open_display() as (_, publish_and_settle):
        grid_map = make_grid_map(elevation=[[1, NAN], [2, 3]], certain=[[1, 1], [1, NAN]])
        content = await publish_and_settle(grid_map)
        assert content["colors"].reshape(-1, 4)[:, 3].tolist() == [255, 0, 255, 255]
        assert np.isfinite(content["points"]).all()
        grid_map.basic_layers = ["certain"]
        content = await publish_and_settle(grid_map)
        assert content["colors"].reshape(-1, 4)[:, 3].tolist() == [255, 0, 255, 0]


async def test_rainbow_two_color_and_flat_color_modes():
    async with open_display() as (world, publish_and_settle):
        content = await publish_and_settle(make_grid_map(elevation=[[0, 10]], other=[[5, 0]]))
        first, last = content["colors"].reshape(-1, 4)[:, :3].tolist()
        assert (first, last) == ([204, 0, 255], [255, 0, 0])
        display = world.display("GridMap")

        def colors() -> list[list[int]]:
            return unpack_contents(display)[-1].fields["colors"].reshape(-1, 4)[:, :3].tolist()

        display.set_property(("Invert Rainbow",), True)
        assert colors() == [last, first]
        display.set_property(("Color Layer",), "other")
        assert colors() == [first, last]
        display.set_property(("Use Rainbow",), False)
        assert colors() == [[255, 255, 255], [0, 0, 0]]
        display.set_property(("Autocompute Intensity Bounds",), False)
        assert colors() == [[128, 128, 128], [0, 0, 0]]
        display.set_property(("Color Transformer",), "FlatColor")
        assert colors() == [[200, 200, 200]] * 2
        display.set_property(("Height Transformer",), "Flat")
        assert unpack_contents(display)[-1].fields["points"].reshape(-1, 3)[:, 2].tolist() == [0, 0]
        display.set_property(("Color Transformer",), "None")
        assert unpack_contents(display)[-1].fields["filled"] is False


async def test_color_layer_is_unpacked():
    packed = np.array([0x00FF8000, 0x000000FF], dtype=np.uint32).view(np.float32).tolist()
    async with open_display(", Color Transformer: ColorLayer, Color Layer: color") as (_, publish_and_settle):
        content = await publish_and_settle(make_grid_map(elevation=[[0, 0]], color=[packed]))
        assert content["colors"].reshape(-1, 4)[:, :3].tolist() == [[255, 128, 0], [0, 0, 255]]


async def test_large_map_is_subsampled_with_warning():
    async with open_display() as (world, publish_and_settle):
        content = await publish_and_settle(make_grid_map(elevation=np.zeros((900, 900)).tolist()))
        assert (content["rows"], content["columns"]) == (450, 450)
        assert world.status("GridMap")["Size"] == ("warn", "The map is large: 1 in 2 rows and columns is drawn")


@pytest.mark.parametrize(
    ("broken", "text"),
    [
        ({"layers": ["a"]}, "The map has no layer 'elevation'; its layers are 'a'"),
        ({"layers": []}, "The map has 0 layers, but data for 1 layers"),
        ({"resolution": 0.0}, "The resolution, lengths or pose of the map are not valid"),
        ({"length_x": NAN}, "The resolution, lengths or pose of the map are not valid"),
        ({"length_y": 0.0}, "The map has 2 x 0 cells"),
        ({"length_y": 9.0}, "Layer 'elevation' has 4 numbers for 2 x 9 cells"),
    ],
)
async def test_invalid_grid_map_is_reported(broken, text):
    async with open_display() as (world, publish_and_settle):
        grid_map = make_grid_map(elevation=[[1, 2], [3, 4]])
        for name, value in broken.items():
            setattr(grid_map if name == "layers" else grid_map.info, name, value)
        assert await publish_and_settle(grid_map) is None
        assert world.status("GridMap")["Message"] == ("error", text)
        assert await publish_and_settle(make_grid_map(elevation=[[1, 2], [3, 4]])) is not None
        assert "Message" not in world.status("GridMap")


async def test_grid_map_demo_file_is_saved_unchanged():
    text = make_config(", Unreliable: false, Use Rainbow: true, Min Intensity: 0, Color: 200; 200; 200").text()
    async with open_world(RvizConfig.parse(text)) as world:
        assert world.viewer.displays[0].row().supported
        assert world.viewer.config.text() == text
