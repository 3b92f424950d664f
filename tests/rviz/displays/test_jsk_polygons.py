"""The display of jsk's polygons."""

from __future__ import annotations

from contextlib import asynccontextmanager
from typing import Any

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.viewer.contents import shown_markers
from tests.viewer.scene import open_world

PolygonArray = get_message("jsk_recognition_msgs/msg/PolygonArray")
PolygonStamped, Point32 = (get_message(f"geometry_msgs/msg/{name}") for name in ("PolygonStamped", "Point32"))
FILE = """\
Visualization Manager:
  Displays:
    - {Class: jsk_rviz_plugin/PolygonArray, Enabled: true, Name: Planes, Topic: /planes}
  Global Options:
    Fixed Frame: base
"""
WALL = ((2.0, 0.0, 0.0), (2.0, 4.0, 0.0), (2.0, 4.0, 1.0), (2.0, 1.0, 1.0), (2.0, 1.0, 3.0), (2.0, 0.0, 3.0))
"""An L in the plane x = 2, counterclockwise about x."""


def make_polygon(corners: Any) -> Any:
    polygon = PolygonStamped()
    polygon.header.frame_id = "tip"
    polygon.polygon.points = [Point32(x=x, y=y, z=z) for x, y, z in corners]
    return polygon


@asynccontextmanager
async def shown(*polygons: Any, **fields: Any) -> Any:
    """Publish polygons, and yield the display and a function that reads its markers."""
    async with open_world(RvizConfig.parse(FILE)) as world:
        world.move_arm(5.0)
        publisher = world.graph.create_node("segmenter").create_publisher(PolygonArray, "/planes", 10)
        await world.settle()
        publisher.publish(PolygonArray(polygons=list(polygons), **fields))
        await world.settle()
        (display,) = world.viewer.displays
        yield display, lambda: shown_markers(display) if len(display._store) else {}


async def test_border_and_normal_are_drawn_in_the_frame_of_the_polygon():
    async with shown(make_polygon(WALL)) as (_, markers):
        drawn = markers()
        assert set(drawn) == {"polygons/0", "normals/0"}
        assert drawn["polygons/0"]["pose"][:3] == [5, 0, 0]


async def test_surface_has_the_area_of_a_polygon_that_is_not_convex():
    async with shown(make_polygon(WALL)) as (display, _):
        display.set_property(("only border",), False)
        surface = display.markers(PolygonArray(polygons=[make_polygon(WALL)]))[0]
        corners = np.array([(point.x, point.y, point.z) for point in surface.points]).reshape(-1, 3, 3)
        areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
        assert areas.sum() == pytest.approx(4.0 + 2.0)


async def test_normal_points_to_the_side_from_which_the_corners_are_counterclockwise():
    async with shown() as (display, _):
        display.set_property(("normal length",), 0.5)
        for corners, direction in ((WALL, 0.5), (WALL[::-1], -0.5)):
            _, arrow = display.markers(PolygonArray(polygons=[make_polygon(corners)]))
            start, end = ((point.x, point.y, point.z) for point in arrow.points)
            assert np.subtract(end, start) == pytest.approx((direction, 0.0, 0.0))
        display.set_property(("show normal",), False)
        assert len(display.markers(PolygonArray(polygons=[make_polygon(WALL)]))) == 1


async def test_polygons_without_an_area_are_left_out():
    line, nowhere = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0)), ((float("nan"), 0.0, 0.0), *WALL)
    async with shown(*map(make_polygon, (line, nowhere, WALL[:2], WALL))) as (_, markers):
        assert set(markers()) == {"polygons/3", "normals/3"}


@pytest.mark.parametrize(
    ("coloring", "expected"), [("Likelihood", [(1, 0, 0), (0.25, 0, 0.75)]), ("Flat color", [(25 / 255, 1, 0)] * 2)]
)
async def test_colors_follow_the_likelihood_or_the_property(coloring, expected):
    async with shown(make_polygon(WALL), make_polygon(WALL), likelihood=[1.0, 0.25]) as (display, markers):
        display.set_property(("show normal",), False)
        display.set_property(("coloring",), coloring)
        colors = [marker["color"] for marker in markers().values()]
        np.testing.assert_allclose(colors, [(*color, 1.0) for color in expected], atol=1e-3)


async def test_labels_choose_colors():
    async with shown(*[make_polygon(WALL)] * 3, labels=[4, 7, 4]) as (display, markers):
        display.set_property(("show normal",), False)
        display.set_property(("coloring",), "Label")
        first, second, third = (tuple(marker["color"]) for marker in markers().values())
        assert first == third != second
