"""The octomap of a topic."""

from __future__ import annotations

import struct
from typing import Any

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.rviz.displays.moveit.arm import as_signed_bytes
from tests.viewer.contents import shown_markers
from tests.viewer.scene import open_world

Octomap = get_message("octomap_msgs/msg/Octomap")
FILE = """\
Visualization Manager:
  Displays:
    - Class: octomap_rviz_plugins/OccupancyGrid
      Enabled: true
      Max. Height Display: inf
      Max. Octree Depth: 16
      Min. Height Display: -inf
      Name: OccupancyGrid
      Octomap Topic: /octomap
      Queue Size: 5
      Value: true
      Voxel Alpha: 1
      Voxel Coloring: Z-Axis
      Voxel Rendering: Occupied Voxels
  Global Options:
    Fixed Frame: base
"""
OCCUPIED, FREE, INNER = 2, 1, 3


def make_octomap(last: list[int], frame: str = "base") -> Any:
    """Return a map of half a meter with eight occupied cells.

    They are the smallest cells at the center's corner, in the first octant.
    """
    nodes = [struct.pack("<H", INNER << 14), *[struct.pack("<H", INNER)] * 14]
    leaves = struct.pack("<H", sum(state << 2 * child for child, state in enumerate(last)))
    message = Octomap(binary=True, id="OcTree", resolution=0.5, data=as_signed_bytes(b"".join([*nodes, leaves])))
    message.header.frame_id = frame
    return message


async def test_octomap_cells_follow_properties():
    async with open_world(RvizConfig.parse(FILE)) as world:
        world.move_arm()
        publisher = world.graph.create_node("mapper").create_publisher(Octomap, "/octomap", 10)
        await world.settle()
        publisher.publish(make_octomap([OCCUPIED, FREE, 0, 0, OCCUPIED, 0, 0, 0]))
        await world.settle()
        (display,) = world.viewer.displays
        (marker,) = shown_markers(display).values()
        assert (marker["frame"], marker["scale"]) == ("base", [0.5, 0.5, 0.5])
        assert sorted(marker["points"].reshape(-1, 3).tolist()) == [[0.25, 0.25, 0.25], [0.25, 0.25, 0.75]]
        assert world.status("OccupancyGrid")["Transform"] == ("ok", "Transform OK")

        def cells() -> int:
            return sum(len(shown_marker["points"]) // 3 for shown_marker in shown_markers(display).values())

        display.set_property(("Voxel Rendering",), "All Voxels")
        assert cells() == 3
        display.set_property(("Max. Height Display",), 0.5)
        assert cells() == 2
        display.set_property(("Max. Octree Depth",), 15)
        (marker,) = shown_markers(display).values()
        assert (marker["scale"], marker["points"].tolist()) == ([1, 1, 1], [0.5, 0.5, 0.5])


async def test_invalid_octomaps_and_frames_are_reported():
    async with open_world(RvizConfig.parse(FILE)) as world:
        world.move_arm()
        publisher = world.graph.create_node("mapper").create_publisher(Octomap, "/octomap", 10)
        await world.settle()
        publisher.publish(Octomap(binary=True, id="OcTree", resolution=0.5, data=[1]))
        await world.settle()
        status = world.status("OccupancyGrid")
        assert status["Octomap"] == ("error", "The data of the octomap ends too early, after 1 bytes")
        publisher.publish(make_octomap([OCCUPIED] * 8, frame="nowhere"))
        await world.settle()
        status = world.status("OccupancyGrid")
        assert "Octomap" not in status
        assert status["Transform"] == ("error", "No transform from [nowhere] to [base]")


async def test_octomap_file_is_saved_unchanged():
    async with open_world(RvizConfig.parse(FILE)) as world:
        assert world.viewer.displays[0].row().supported
        assert world.viewer.config.warnings == []
        assert world.viewer.config.text() == FILE
