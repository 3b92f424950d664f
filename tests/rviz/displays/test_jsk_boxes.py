"""The displays of jsk's bounding boxes."""

from __future__ import annotations

import math
from contextlib import asynccontextmanager
from typing import Any

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.viewer.contents import shown_markers
from tests.viewer.scene import open_world

BoundingBox = get_message("jsk_recognition_msgs/msg/BoundingBox")
BoundingBoxArray = get_message("jsk_recognition_msgs/msg/BoundingBoxArray")
FILE = """\
Visualization Manager:
  Displays:
    - {{Class: jsk_rviz_plugin/{name}, Enabled: true, Name: Boxes, Topic: /boxes}}
  Global Options:
    Fixed Frame: base
"""


def make_box(x: float = 0.0, *, size: float = 2.0, **fields: Any) -> Any:
    box = BoundingBox(**fields)
    box.header.frame_id = "tip"
    box.pose.position.x = x
    box.pose.orientation.w = 1.0
    box.dimensions.x = box.dimensions.y = box.dimensions.z = size
    return box


@asynccontextmanager
async def shown(message: Any) -> Any:
    """Publish a message, and yield the display and a function that reads its markers."""
    name = type(message).TYPE_NAME.rpartition("/")[2]
    async with open_world(RvizConfig.parse(FILE.format(name=name))) as world:
        world.move_arm(5.0)
        publisher = world.graph.create_node("detector").create_publisher(type(message), "/boxes", 10)
        await world.settle()
        publisher.publish(message)
        await world.settle()
        (display,) = world.viewer.displays
        yield display, lambda: shown_markers(display) if len(display._store) else {}


async def test_box_is_drawn_in_its_own_frame():
    async with shown(make_box(1.0, value=-1.0)) as (_, markers):
        (marker,) = markers().values()
        assert marker["scale"] == [2, 2, 2]
        assert marker["pose"][:3] == [6, 0, 0]


async def test_boxes_without_a_size_or_below_the_threshold_are_left_out():
    message = BoundingBoxArray(boxes=[make_box(), make_box(size=0.0), make_box(size=math.nan), make_box(value=0.5)])
    async with shown(message) as (display, markers):
        assert set(markers()) == {"boxes/0", "boxes/3"}
        display.set_property(("value threshold",), 0.4)
        assert set(markers()) == {"boxes/3"}


@pytest.mark.parametrize(
    ("coloring", "expected"), [("Value", [(0, 0, 1), (1, 0, 0)]), ("Flat color", [(25 / 255, 1, 0)] * 2)]
)
async def test_colors_follow_the_values_or_the_property(coloring, expected):
    async with shown(BoundingBoxArray(boxes=[make_box(value=2.0), make_box(value=4.0)])) as (display, markers):
        display.set_property(("coloring",), coloring)
        colors = [marker["color"] for marker in markers().values()]
        np.testing.assert_allclose(colors, [(*color, 0.8) for color in expected], atol=1e-3)


async def test_labels_choose_colors():
    boxes = [make_box(label=1), make_box(label=2), make_box(label=1)]
    async with shown(BoundingBoxArray(boxes=boxes)) as (display, markers):
        display.set_property(("coloring",), "Label")
        first, second, third = (tuple(marker["color"]) for marker in markers().values())
        assert first == third != second


async def test_edges_and_axes_are_lines():
    async with shown(BoundingBoxArray(boxes=[make_box()])) as (display, markers):
        display.set_property(("only edge",), True)
        display.set_property(("show coords",), True)
        assert len(markers()["boxes/0"]["points"]) == 12 * 2 * 3
        lengths = np.diff(markers()["boxes/0"]["points"].reshape(-1, 2, 3), axis=1)
        assert np.linalg.norm(lengths, axis=2).ravel().tolist() == [2] * 12
        assert len(markers()["axes/0"]["points"]) == 3 * 2 * 3
