"""The displays that draw over the scene, in a real browser."""

from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from linkwright.messages import get_message
from tests.browser.axe import find_violations
from tests.browser.conftest import until
from tests.browser.live import configuration
from tests.rviz.displays.test_overlays import make_text

pytestmark = pytest.mark.browser

DISPLAYS = """
- {Class: rviz_2d_overlay_plugins/TextOverlay, Enabled: true, Name: text, Topic: {Value: /text}}
- Class: rviz_2d_overlay_plugins/PieChartOverlay
  Enabled: true
  Name: battery
  Topic: {Value: /level}
  left: 20
  top: 20
- {Class: jsk_rviz_plugin/Plotter2D, Enabled: true, Name: plot, Topic: {Value: /level}, left: 20, top: 200, width: 200}
- Class: jsk_rviz_plugin/OverlayImage
  Enabled: true
  Name: image
  Topic: {Value: /image}
  left: 300
  top: 20
  alpha: 1
- Class: rviz_plugins/AccelerationMeter
  Enabled: true
  Name: meter
  Topic: {Value: /accel}
  Left: 300
  Top: 200
  Length: 150
- Class: autoware_mission_details_overlay_rviz_plugin/MissionDetailsDisplay
  Enabled: true
  Name: mission
  Top: 150
  Remaining Distance and Time Topic: /mission
- Class: autoware_string_stamped_rviz_plugin/StringStampedOverlayDisplay
  Enabled: true
  Name: state
  Left: 20
  Top: 420
  Topic: {Value: /state}
"""


def test_overlays_are_drawn_where_their_displays_say(start_viewer, open_page, tmp_path):
    viewer = start_viewer(configuration(DISPLAYS))
    page = open_page(viewer, wait=False)
    text = make_text(text="battery is low: return to the dock")
    text.bg_color.a = 0.6
    viewer.publish("/text", text)
    level = get_message("std_msgs/msg/Float32")
    for value in (0.9, 0.6, 0.7):
        viewer.publish("/level", level(data=value))
    pixels = np.zeros((8, 8, 3), np.uint8)
    pixels[:, :4] = (255, 0, 0)
    image = get_message("sensor_msgs/msg/Image")
    viewer.publish("/image", image(width=8, height=8, step=24, encoding="rgb8", data=pixels.tobytes()))
    viewer.publish("/accel", get_message("geometry_msgs/msg/AccelWithCovarianceStamped")())
    mission = get_message("autoware_internal_msgs/msg/MissionRemainingDistanceTime")
    viewer.publish("/mission", mission(remaining_distance=1234.0, remaining_time=90.0))
    viewer.publish(
        "/state", get_message("autoware_internal_debug_msgs/msg/StringStamped")(data="lane following\nclear")
    )
    until(page, "lw.displays.length === 7 && lw.displays.every((display) => display.drawn?.isShown)")
    viewer.settle(page)
    page.screenshot(path=tmp_path / "overlays.png")
    scene = page.locator(".canvas-box").bounding_box()
    picture = page.get_by_role("img", name="image").bounding_box()
    assert (picture["x"] - scene["x"], picture["y"] - scene["y"]) == (300, 20)
    shown = np.array(Image.open(io.BytesIO(page.screenshot())).convert("RGB"))
    middle = int(picture["y"]) + 64
    assert shown[middle, int(picture["x"]) + 20].tolist() == [255, 0, 0]
    assert shown[middle, int(picture["x"]) + 110].tolist() == [0, 0, 0]
    words = page.get_by_role("img", name="battery is low").bounding_box()
    assert scene["x"] + scene["width"] - (words["x"] + words["width"]) == pytest.approx(5)
    assert scene["y"] + scene["height"] - (words["y"] + words["height"]) == pytest.approx(7)
    assert find_violations(page, ".canvas-box") == []
    page.get_by_role("treeitem").filter(has_text="image").get_by_role("checkbox").first.click()
    page.get_by_role("img", name="image").wait_for(state="hidden")
