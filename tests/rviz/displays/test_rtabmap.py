"""The displays of rtabmap's map, its graph, and its statistics."""

from __future__ import annotations

import struct
import zlib
from contextlib import asynccontextmanager
from io import BytesIO
from typing import Any

import numpy as np
import pytest
from PIL import Image as Pictures

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.viewer.contents import shown_markers, unpack_contents
from tests.viewer.packed_images import encode_sized_rvl, make_jpeg, make_png
from tests.viewer.scene import open_world

MapData, MapGraph, Info, Node = (
    get_message(f"rtabmap_msgs/msg/{name}") for name in ("MapData", "MapGraph", "Info", "Node")
)
Link = get_message("rtabmap_msgs/msg/Link")
Pose = get_message("geometry_msgs/msg/Pose")
Transform = get_message("geometry_msgs/msg/Transform")
CameraInfo = get_message("sensor_msgs/msg/CameraInfo")

FILE = """\
Visualization Manager:
  Displays:
    - {{Class: {cls}, Enabled: true, Name: Map, Topic: {{Value: /map}}{extra}}}
  Global Options:
    Fixed Frame: base
"""
EVERY_PIXEL = ", Cloud decimation: 1, Cloud voxel size (m): 0, Cloud max depth (m): 0"


@asynccontextmanager
async def open_display(name: str, message: type, extra: str = "") -> Any:
    """Yield a world, a display, and a function that publishes messages to it."""
    text = FILE.format(cls=f"rtabmap_rviz_plugins/{name}", extra=extra)
    async with open_world(RvizConfig.parse(text)) as world:
        world.move({("base", "map"): (10, 0, 0, 0, 0, 0, 1)}, static=True)
        publisher = world.graph.create_node("rtabmap").create_publisher(message, "/map", 10)

        async def publish(content: Any) -> None:
            content.header.frame_id = "map"
            await world.settle()
            publisher.publish(content)
            await world.settle()

        await world.settle()
        (display,) = world.viewer.displays
        yield world, display, publish


def as_bytes(content: bytes) -> np.ndarray:
    return np.frombuffer(content, np.uint8)


def make_pose(x: float) -> Any:
    pose = Pose()
    pose.position.x = x
    pose.orientation.w = 1.0
    return pose


def make_node(number: int, depth: bytes = b"", color: bytes = b"", *, size: tuple[int, int] = (2, 1)) -> Any:
    """Return a node with a camera that looks along x: columns go to the right, which is -y, and rows down."""
    info = CameraInfo(width=size[0], height=size[1])
    info.p = np.array([1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1, 0])
    transform = Transform()
    rotation = transform.rotation
    rotation.x, rotation.y, rotation.z, rotation.w = -0.5, 0.5, -0.5, 0.5
    node = Node(id=number)
    node.pose.orientation.w = 1.0
    node.data.left_compressed, node.data.right_compressed = as_bytes(color), as_bytes(depth)
    node.data.left_camera_info, node.data.local_transform = [info], [transform]
    return node


def make_map(nodes: list[Any], poses: dict[int, float]) -> Any:
    message = MapData(nodes=nodes)
    message.graph.poses_id = np.array(list(poses), np.int32)
    message.graph.poses = [make_pose(x) for x in poses.values()]
    return message


MILLIMETERS = np.array([[1000, 2000]], np.uint16)


def make_float_png(meters: np.ndarray) -> bytes:
    """Return depths of 32 bits as a PNG whose channels are their bytes, blue first."""
    channels = np.frombuffer(meters.astype("<f4").tobytes(), np.uint8).reshape(*meters.shape, 4)[..., [2, 1, 0, 3]]
    file = BytesIO()
    Pictures.fromarray(np.ascontiguousarray(channels), "RGBA").save(file, "PNG")
    return file.getvalue()


@pytest.mark.parametrize(
    "depth",
    [make_png(MILLIMETERS), b"DEPTHRVL" + encode_sized_rvl(MILLIMETERS), make_float_png(MILLIMETERS / 1000)],
    ids=["png", "rvl", "float"],
)
async def test_nodes_are_drawn_at_their_poses_in_the_color_of_their_images(depth):
    async with open_display("MapCloud", MapData, EVERY_PIXEL) as (_, display, publish):
        await publish(make_map([make_node(1, depth, make_jpeg((255, 0, 0), 2, 1))], {1: 5.0}))
        (content,) = unpack_contents(display)
        points = content.fields["positions"].reshape(-1, 3)
        np.testing.assert_allclose(points, [(1, 0, 0), (2, -2, 0)], atol=1e-6)
        assert content.pose == [15, 0, 0, 0, 0, 0, 1]
        assert display.properties.text("Color Transformer") == "RGB8"
        assert content.fields["colors"].reshape(-1, 4)[0].tolist() == [254, 0, 0, 255]


async def test_points_stay_follow_the_graph_and_leave_with_it():
    async with open_display("MapCloud", MapData, EVERY_PIXEL) as (_, display, publish):
        png = make_png(MILLIMETERS)
        await publish(make_map([make_node(1, png)], {1: 0.0}))
        await publish(make_map([make_node(2, png)], {1: 0.0, 2: 1.0}))
        assert sorted(content.pose[0] for content in unpack_contents(display)) == [10, 11]
        await publish(make_map([], {1: 3.0, 2: 1.0}))
        assert sorted(content.pose[0] for content in unpack_contents(display)) == [11, 13]
        await publish(make_map([], {2: 1.0}))
        assert [content.pose[0] for content in unpack_contents(display)] == [11]


async def test_points_follow_the_fixed_frame():
    async with open_display("MapCloud", MapData, EVERY_PIXEL) as (world, display, publish):
        await publish(make_map([make_node(1, make_png(MILLIMETERS))], {1: 0.0}))
        await publish(make_map([], {1: 0.0}))
        world.viewer.manager.set_fixed_frame("map")
        await world.settle()
        assert [content.pose[0] for content in unpack_contents(display)] == [0]


async def test_limits_decimate_and_leave_points_out():
    depth = make_png(np.array([[1000, 1500, 2000, 6000]] * 2, np.uint16))
    node = make_node(1, depth, size=(4, 2))
    async with open_display("MapCloud", MapData, ", Cloud decimation: 1") as (_, display, publish):

        async def depths(name: str, value: float) -> list[float]:
            display.set_property((name,), value)
            await publish(make_map([node], {1: 0.0}))
            contents = unpack_contents(display)
            if not contents:
                return []
            return np.sort(contents[0].fields["positions"].reshape(-1, 3)[:, 0]).round(4).tolist()

        assert await depths("Cloud max depth (m)", 4.0) == [1, 1, 1.5, 1.5, 2, 2]
        assert await depths("Cloud min depth (m)", 1.2) == [1.5, 1.5, 2, 2]
        assert await depths("Filter floor (m)", -0.5) == [1.5, 2]  # the second row is as far below as ahead
        assert await depths("Cloud decimation", 2) == [2]


async def test_laser_scans_are_the_other_source():
    values = np.array([(1, 0, 0, 7), (0, 2, 0, 9)], "<f4")
    node = make_node(1)
    node.data.laser_scan_compressed = as_bytes(
        zlib.compress(values.tobytes()) + struct.pack("<iii", 1, 2, 5 + (3 << 3))
    )
    node.data.laser_scan_format = 6
    node.data.laser_scan_local_transform.translation.z = 0.5
    node.data.laser_scan_local_transform.rotation.w = 1.0
    async with open_display("MapCloud", MapData, ", Cloud from scan: true") as (_, display, publish):
        await publish(make_map([node], {1: 0.0}))
        (content,) = unpack_contents(display)
        assert content.fields["positions"].reshape(-1, 3).tolist() == [[1, 0, 0.5], [0, 2, 0.5]]
        assert "intensity" in display._channels


async def test_missing_nodes_are_requested_once():
    async with open_display("MapCloud", MapData) as (world, _, publish):
        requests: list[list[int]] = []
        world.graph.create_node("listener").create_subscription(
            "std_msgs/msg/Int32MultiArray",
            "/rtabmap/republish_node_data",
            lambda message: requests.append(list(message.data)),
            10,
        )
        await publish(make_map([], {1: 0.0, 2: 0.0, -3: 0.0}))
        await publish(make_map([], {1: 0.0, 2: 0.0}))
        assert requests == [[1, 2]]


@pytest.mark.parametrize("depth", [b"nonsense", b"DEPTHRVL", b"DEPTHRVL" + struct.pack("<II", 1 << 30, 9) + b"abcd"])
async def test_damaged_node_is_told_and_others_are_drawn(depth):
    async with open_display("MapCloud", MapData, EVERY_PIXEL) as (world, display, publish):
        await publish(make_map([make_node(1, depth), make_node(2, make_png(MILLIMETERS))], {1: 0.0, 2: 0.0}))
        assert world.status("MapCloud")["Node"][0] == "error"
        assert len(unpack_contents(display)) == 1


async def test_links_have_the_colors_of_their_types():
    message = MapGraph(poses=[make_pose(0.0), make_pose(1.0), make_pose(2.0)])
    message.poses_id = np.array([1, 2, 3], np.int32)
    message.links = [Link(from_id=1, to_id=2, type=0), Link(from_id=3, to_id=1, type=1), Link(from_id=1, to_id=9)]
    async with open_display("MapGraph", MapGraph, ', Neighbor: "0; 255; 0", Alpha: 0.5') as (_, display, publish):
        await publish(message)
        markers = shown_markers(display)
        assert set(markers) == {"Neighbor/0", "Global loop closure/0"}
        assert markers["Neighbor/0"]["points"].tolist() == [0, 0, 0, 1, 0, 0]
        assert markers["Neighbor/0"]["color"] == [0, 1, 0, 0.5]
        assert markers["Global loop closure/0"]["color"] == [1, 0, 0, 0.5]


async def test_statistics_are_rows_of_the_status():
    async with open_display("Info", Info) as (world, _, publish):
        message = Info(ref_id=7, loop_closure_id=3, stats_keys=["Loop/Id/"], stats_values=np.array([3], np.float32))
        message.loop_closure_transform.translation.x = 1.5
        message.loop_closure_transform.rotation.w = 1.0
        await publish(message)
        status = world.status("Info")
        assert status["Info"] == ("ok", "7->3")
        assert status["Position (XYZ)"][1] == "1.5;0;0"
        assert status["Loop/Id/"][1] == "3"
        await publish(Info(ref_id=8, proximity_detection_id=2))
        status = world.status("Info")
        assert (status["Info"][1], status["Loop closures"][1], status["Proximity detections"][1]) == (
            "8->2 [Proximity]",
            "1",
            "1",
        )
        assert "Loop/Id/" not in status
