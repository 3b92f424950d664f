"""The displays that draw texts, gauges, plots and images over the scene."""

from __future__ import annotations

from contextlib import asynccontextmanager
from typing import Any

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.viewer.contents import unpack
from tests.viewer.scene import open_world
from tests.waiting import eventually

FILE = """\
Visualization Manager:
  Displays:
    - {{Class: "{cls}", Enabled: true, Name: Over, "{topic}": {{Value: /over}}}}
  Global Options:
    Fixed Frame: base
"""
Float32 = get_message("std_msgs/msg/Float32")


class Overlay:
    """A display with a publisher."""

    def __init__(self, world: Any, message: type) -> None:
        self.world = world
        (self.display,) = world.viewer.displays
        self._publisher = world.graph.create_node("car").create_publisher(message, "/over", 10)

    async def publish(self, *messages: Any) -> None:
        """Publish messages."""
        await self.world.settle()
        for message in messages:
            self._publisher.publish(message)
            await self.world.settle()

    @property
    def figure(self) -> dict[str, Any] | None:
        """The figure that pages show."""
        frames = self.display.data()
        return unpack(frames[0]).fields if frames else None

    @property
    def texts(self) -> list[str]:
        """The texts of the figure."""
        return [shape["text"] for shape in self.figure["shapes"] if shape["shape"] == "text"]

    def set(self, name: str, value: object) -> None:
        """Set a property."""
        self.display.set_property((name,), value)


@asynccontextmanager
async def overlay(cls: str, message: type, topic: str = "Topic") -> Any:
    """Yield a display of a class."""
    async with open_world(RvizConfig.parse(FILE.format(cls=cls, topic=topic))) as world:
        yield Overlay(world, message)


def make_text(**fields: Any) -> Any:
    kind = get_message("rviz_2d_overlay_msgs/msg/OverlayText")
    message = kind(width=200, height=50, horizontal_distance=5, vertical_distance=7, text_size=12.0, **fields)
    message.horizontal_alignment, message.vertical_alignment = kind.RIGHT, kind.BOTTOM
    message.fg_color.g = message.fg_color.a = 1.0
    return message


async def test_text_has_the_place_and_the_colors_of_its_message_or_of_the_display():
    async with overlay("rviz_2d_overlay_plugins/TextOverlay", type(make_text())) as over:
        await over.publish(make_text(text='<span style="color: red;">stop</span><br>now'))
        figure = over.figure
        assert over.texts == ["stop\nnow"]
        assert [figure[name] for name in ("horizontal", "vertical", "x", "y")] == ["right", "bottom", 5, 7]
        (text,) = figure["shapes"]
        assert (text["size"], text["wrap"], text["color"]) == (16, 200, [0, 1, 0, 1])
        assert figure["label"] == "Over\nstop\nnow"
        over.set("Overtake Position Properties", True)
        over.set("hor_alignment", "center")
        over.set("Overtake FG Color Properties", True)
        over.set("Foreground Color", "#ff0000")
        assert [over.figure[name] for name in ("horizontal", "width")] == ["center", 128]
        assert over.figure["shapes"][0]["color"] == pytest.approx([1, 0, 0, 0.8])
        await over.publish(make_text(action=1))
        assert over.figure is None


async def test_text_of_jsk_has_a_place_from_the_corner():
    kind = get_message("jsk_rviz_plugins/msg/OverlayText")
    async with overlay("jsk_rviz_plugin/OverlayText", kind) as over:
        await over.publish(kind(left=3, top=4, width=100, height=20, text_size=9.0, text="ready"))
        assert over.texts == ["ready"]
        assert [over.figure[name] for name in ("horizontal", "vertical", "x", "y")] == ["left", "top", 3, 4]
        over.set("Overtake Position Properties", True)
        over.set("left", 50)
        assert [over.figure[name] for name in ("x", "y", "width")] == [50, 0, 128]
        over.set("Align Bottom", True)
        assert over.figure["shapes"][0]["is_above"]


async def test_menu_marks_its_current_entry_and_closes():
    kind = get_message("jsk_rviz_plugins/msg/OverlayMenu")
    async with overlay("jsk_rviz_plugin/OverlayMenu", kind) as over:
        await over.publish(kind(title="Tasks", menus=["wait", "fetch the cup"], current_index=1))
        assert over.texts == ["Tasks", "wait", "fetch the cup"]
        assert [over.figure[name] for name in ("horizontal", "vertical")] == ["center", "center"]
        (mark,) = [shape for shape in over.figure["shapes"] if shape["shape"] == "area"]
        entry = next(shape for shape in over.figure["shapes"] if shape["text"] == "fetch the cup")
        assert mark["points"][1] < entry["points"][1] + entry["size"] / 2 < mark["points"][5]
        over.set("keep centered", False)
        over.set("left", 7)
        assert [over.figure[name] for name in ("horizontal", "x", "y")] == ["left", 7, 128]
        await over.publish(kind(action=kind.ACTION_CLOSE))
        assert over.figure is None


async def test_stamped_text_fades_after_an_empty_one():
    kind = get_message("autoware_internal_debug_msgs/msg/StringStamped")
    cls = "autoware_string_stamped_rviz_plugin/StringStampedOverlayDisplay"
    async with overlay(cls, kind) as over:
        over.set("Time To Keep Last Diag", 0.0)
        over.set("Time To Erase Last Diag", 0.3)
        await over.publish(kind(data="lidar is missing"))
        assert over.texts == ["lidar is missing"]
        assert over.figure["shapes"][0]["color"][3] == 1
        await over.publish(kind())
        await eventually(lambda: over.figure is None)
        await over.publish(kind(data="all is well"))
        assert over.texts == ["all is well"]


@pytest.mark.parametrize(
    ("meters", "seconds", "expected"),
    [
        (9.5, 59.0, ["9.5", "m", "59", "sec"]),
        (950.0, 90.0, ["950", "m", "1.5", "min"]),
        (9500.0, 3000.0, ["9.50", "km", "50", "min"]),
        (123456.0, 40000.0, ["123", "km", "11", "hrs"]),
    ],
)
async def test_remaining_distance_and_time_have_fitting_units(meters, seconds, expected):
    kind = get_message("autoware_internal_msgs/msg/MissionRemainingDistanceTime")
    cls, topic = (
        "autoware_mission_details_overlay_rviz_plugin/MissionDetailsDisplay",
        "Remaining Distance and Time Topic",
    )
    async with overlay(cls, kind, topic) as over:
        await over.publish(kind(remaining_distance=meters, remaining_time=seconds))
        assert over.texts == expected
        assert (over.figure["horizontal"], over.figure["x"]) == ("right", 10)


@pytest.mark.parametrize("cls", ["rviz_2d_overlay_plugins/PieChartOverlay", "jsk_rviz_plugin/PieChart"])
async def test_ring_is_filled_by_the_share_of_the_value(cls):
    async with overlay(cls, Float32) as over:
        await over.publish(Float32(data=0.25))
        assert over.texts == ["Over", "0.25"]
        ring = np.array(over.figure["shapes"][3]["points"]).reshape(-1, 2) - 64
        np.testing.assert_allclose(ring[0], [0, 49], atol=1e-6)
        np.testing.assert_allclose(ring[-1], [49, 0], atol=1e-6)
        over.set("clockwise rotate direction", True)
        ring = np.array(over.figure["shapes"][3]["points"]).reshape(-1, 2) - 64
        np.testing.assert_allclose(ring[-1], [-49, 0], atol=1e-6)
        over.set("auto color change", True)
        await over.publish(Float32(data=1.0))
        assert over.figure["shapes"][3]["color"] == pytest.approx([1, 0, 0, 0.7])


async def test_plot_has_the_last_values_in_their_range():
    async with overlay("jsk_rviz_plugin/Plotter2D", Float32) as over:
        over.set("Buffer length", 3)
        await over.publish(*(Float32(data=value) for value in (9.0, 0.0, 1.0, 2.0)))
        line = np.array(over.figure["shapes"][1]["points"]).reshape(-1, 2)
        np.testing.assert_allclose(line, [(0, 128), (64, 64), (128, 0)])
        assert over.texts == ["Over", "2.00"]
        over.set("auto scale", False)
        over.set("max value", 4.0)
        over.set("min value", 0.0)
        line = np.array(over.figure["shapes"][1]["points"]).reshape(-1, 2)
        np.testing.assert_allclose(line[:, 1], [128, 96, 64])


async def test_meter_points_upwards_at_rest_and_is_red_when_the_car_brakes_hard():
    kind = get_message("geometry_msgs/msg/AccelWithCovarianceStamped")
    async with overlay("rviz_plugins/AccelerationMeter", kind) as over:
        await over.publish(kind())
        hand = over.figure["shapes"][4]["points"]
        assert hand == pytest.approx([128, 128, 128, 2])
        assert over.texts == ["0.00m/s^2"]
        message = kind()
        message.accel.accel.linear.x = -4.0
        await over.publish(message)
        assert over.figure["shapes"][-1]["color"] == pytest.approx([1, 80 / 255, 80 / 255, 1])


async def test_image_has_an_opacity_and_keeps_its_proportions():
    kind = get_message("sensor_msgs/msg/Image")
    pixels = np.arange(12, dtype=np.uint8)
    async with overlay("jsk_rviz_plugin/OverlayImage", kind) as over:
        await over.publish(kind(width=4, height=1, step=12, encoding="rgb8", data=pixels.tobytes()))
        over.set("keep aspect ratio", True)
        figure = over.figure
        assert (figure["width"], figure["height"]) == (128, 32)
        assert (figure["image_width"], figure["image_height"]) == (4, 1)
        assert figure["pixels"].tolist()[:8] == [0, 1, 2, 204, 3, 4, 5, 204]
        await over.publish(kind(width=4, height=1, step=12, encoding="riddle"))
        assert over.figure is None
        assert any(row.name == "Image" and row.level == "error" for row in over.display.status)
