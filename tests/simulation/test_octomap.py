"""Octrees of worlds."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.geometry.octrees import encode_octree
from linkwright.messages import get_message
from linkwright.rviz.displays.moveit.octree import read_octree
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import box

SERVICE = "rotors_comm/srv/Octomap"
PLUGIN = '<plugin name="octomap" filename="librotors_gazebo_octomap_plugin.so"/>'
CRATE = box("crate", "0.6 0 0 0 0 0", "1.0 1.0 1.0")
EARTH = (
    "<spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>12.5</latitude_deg>"
    "<longitude_deg>-7</longitude_deg><elevation>30</elevation><heading_deg>0</heading_deg></spherical_coordinates>"
)


def free_and_occupied(data: bytes, resolution: float):
    cells = read_octree(data=data, binary=True, kind="OcTree", resolution=resolution)
    return cells.select(cells.probabilities < 0.5), cells.select(cells.probabilities > 0.5)


def volume(cells) -> float:
    return float((cells.sizes**3).sum())


async def generate(parts, *, lengths=(4.0, 2.0, 2.0), leaf=0.2, publish=False, filename=""):
    async with running_server(*parts, gravity="0 0 0") as (server, graph, log):
        node = graph.create_node("planner")
        maps = Recording(graph, node, "/world/octomap")
        client = node.create_client(SERVICE, "/world/get_octomap")
        request = get_message(f"{SERVICE}_Request")(leaf_size=leaf, publish_octomap=publish, filename=filename)
        request.bounding_box_lengths.x, request.bounding_box_lengths.y, request.bounding_box_lengths.z = lengths
        response = client.call_async(request)
        await graph.settle()
        server.advance(SECOND_NS // 100)
        await graph.settle()
        return response.result(), list(maps), log


async def test_a_closed_body_is_occupied_and_the_space_around_it_is_free():
    response, maps, log = await generate((PLUGIN, CRATE, EARTH), publish=True)
    octomap = response.map
    assert (octomap.header.frame_id, octomap.id, octomap.binary, octomap.resolution) == ("world", "OcTree", True, 0.2)
    free, occupied = free_and_occupied(octomap.data.tobytes(), 0.2)
    assert volume(free) + volume(occupied) == pytest.approx(4.0 * 2.0 * 2.0)
    inside = (np.abs(occupied.centers - (0.6, 0.0, 0.0)) < 0.5 + 0.2).all(axis=1)
    assert inside.all()
    assert 1.0 <= volume(occupied) <= 1.4**3
    assert not ((np.abs(free.centers - (0.6, 0.0, 0.0)) + free.sizes[:, None] / 2) < 0.5 - 0.2).all(axis=1).any()
    assert [message.data.tobytes() for message in maps] == [octomap.data.tobytes()]
    assert (response.origin_latitude, response.origin_longitude) == pytest.approx((12.5, -7.0))
    assert response.origin_altitude == pytest.approx(30.0)
    assert not log


async def test_the_octree_is_published_and_written_only_on_request(tmp_path):
    _, maps, _ = await generate((PLUGIN, CRATE))
    assert not maps
    path = tmp_path / "map.bt"
    response, _, log = await generate((PLUGIN, CRATE), filename=str(path))
    head, _, data = path.read_bytes().partition(b"\ndata\n")
    assert head.startswith(b"# Octomap OcTree binary file\n")
    assert b"\nres 0.2" in head
    assert data == response.map.data.tobytes()
    assert not log


async def test_a_file_that_cannot_be_written_and_a_box_that_is_too_large_are_told(tmp_path):
    _, _, log = await generate((PLUGIN,), filename=str(tmp_path / "no" / "map.bt"))
    assert "map.bt" in log[0].text
    response, _, log = await generate((PLUGIN,), leaf=0.0001)
    assert "leaf_size" in log[0].text
    assert not len(response.map.data)


def test_eight_equal_cells_are_merged_and_counted():
    states = np.full((2, 2, 3), 2, dtype=np.uint8)
    states[:, :, 2] = 1
    data, count = encode_octree(np.zeros(3, dtype=int), states)
    free, occupied = free_and_occupied(data, 1.0)
    assert (occupied.sizes.tolist(), occupied.centers.tolist()) == ([2.0], [[1.0, 1.0, 1.0]])
    assert sorted(free.centers.tolist()) == [[x, y, 2.5] for x in (0.5, 1.5) for y in (0.5, 1.5)]
    assert count == len(data) // 2 + 1 + 4


def test_random_cells_are_read_back():
    states = np.random.default_rng(1).integers(0, 3, (9, 7, 5)).astype(np.uint8)
    first = np.array((-4, 3, -1))
    free, occupied = free_and_occupied(encode_octree(first, states)[0], 1.0)
    read = np.zeros_like(states)
    for state, cells in ((1, free), (2, occupied)):
        for center, size in zip(cells.centers, cells.sizes, strict=True):
            low = np.round(center - size / 2).astype(int) - first
            high = low + int(size)
            read[low[0] : high[0], low[1] : high[1], low[2] : high[2]] = state
    assert (read == states).all()
