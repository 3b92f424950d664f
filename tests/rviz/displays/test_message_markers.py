"""Displays of other packages that draw messages as markers."""

from __future__ import annotations

from typing import Any

import pytest

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from linkwright.rviz.config.schema import FIXED_FRAME, PropertySpec, topic_spec
from linkwright.rviz.displays import catalog
from linkwright.rviz.displays.marker import MessageMarkersDisplay
from tests.viewer.contents import shown_markers
from tests.viewer.scene import open_world

Float64 = get_message("std_msgs/msg/Float64")
Marker = get_message("visualization_msgs/msg/Marker")

FILE = """\
Visualization Manager:
  Displays:
    - Class: own_displays/Gauge
      Enabled: true
      Name: Gauge
      Topic:
        Value: /level
  Global Options:
    Fixed Frame: base
"""


class Gauge(MessageMarkersDisplay):
    """A number as a bar. Its message has no header."""

    CLASS = "own_displays/Gauge"
    MESSAGE = "std_msgs/msg/Float64"
    SCHEMA = (
        topic_spec(description=MESSAGE),
        PropertySpec("Use Frame", "bool", True, "Whether the marker has a frame."),
        PropertySpec("Frame", "frame", FIXED_FRAME, "Frame of the bar."),
    )

    def markers(self, message: Any) -> Any:
        """Return a bar of the height of the number."""
        bar = Marker(ns="bars", type=Marker.CUBE)
        if self.properties.flag("Use Frame"):
            bar.header.frame_id = self.properties.text("Frame")
        bar.scale.x = bar.scale.y = bar.scale.z = message.data
        bar.color.a = 1.0
        yield bar


@pytest.fixture(autouse=True)
def installed(monkeypatch):
    """Register the display under its name."""
    monkeypatch.setattr(catalog, "has_display", lambda cls: cls == Gauge.CLASS)
    monkeypatch.setattr(catalog, "_load_display_class", lambda cls: Gauge)


async def publish_level(world: Any) -> Any:
    await world.settle()
    world.graph.create_node("tank").create_publisher(Float64, "/level", 10).publish(Float64(data=2.0))
    await world.settle()
    (display,) = world.viewer.displays
    return display


@pytest.mark.parametrize("has_frame", [True, False])
async def test_without_a_header_markers_are_in_the_fixed_frame_and_follow_its_change(has_frame):
    async with open_world(RvizConfig.parse(FILE)) as world:
        display = await publish_level(world)
        display.set_property(("Use Frame",), has_frame)
        (shown,) = shown_markers(display).values()
        assert shown["pose"][:3] == [0, 0, 0]
        world.move({("base", "tank"): (1, 0, 0, 0, 0, 0, 1)}, static=True)
        await world.settle()
        world.viewer.manager.set_fixed_frame("tank")
        await world.settle()
        (shown,) = shown_markers(display).values()
        assert shown["pose"][:3] == [0, 0, 0]


async def test_a_property_can_place_the_markers_in_another_frame():
    async with open_world(RvizConfig.parse(FILE)) as world:
        world.move({("base", "tank"): (1, 0, 0, 0, 0, 0, 1)}, static=True)
        display = await publish_level(world)
        display.set_property(("Frame",), "tank")
        (shown,) = shown_markers(display).values()
        assert shown["pose"][:3] == [1, 0, 0]
