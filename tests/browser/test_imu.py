"""The display of an IMU, drawn in a real browser."""

from __future__ import annotations

import pytest

from tests.browser.conftest import until
from tests.browser.live import configuration
from tests.rviz.displays.test_imu import make_imu

pytestmark = pytest.mark.browser

DISPLAY = """
- Acceleration properties: {Acc. vector scale: 0.1, Enable acceleration: true}
  Axes properties: {Axes scale: 0.6}
  Box properties: {Enable box: true, x_scale: 0.6, y_scale: 0.4, z_scale: 0.2, Box alpha: 0.5}
  Class: rviz_imu_plugin/Imu
  Enabled: true
  Name: Imu
  Topic: {Value: /imu}
"""


def test_box_axes_and_acceleration_of_an_imu_are_drawn(start_viewer, open_page, tmp_path):
    viewer = start_viewer(configuration(DISPLAY, distance=4))
    page = open_page(viewer, wait=False)
    viewer.place("sensor", 0.0, 0.0, 0.3)
    viewer.publish("/imu", make_imu())
    until(page, "Object.keys(lw.displays[0]?.drawn?.markers ?? {}).length === 5")
    viewer.settle(page)
    page.screenshot(path=tmp_path / "imu.png")
