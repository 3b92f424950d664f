"""A launch file with programs of rqt: the page opens with the image and the plot."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Page

from tests.browser.conftest import Start, until

pytestmark = pytest.mark.browser

LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package='rqt_reconfigure', executable='rqt_reconfigure', arguments=['/cam2image']),
        Node(package='rqt_plot', executable='rqt_plot', arguments=['/image/height:width']),
        Node(package='rqt_image_view', executable='rqt_image_view', arguments=['/image']),
        Node(package='rqt_robot_steering', executable='rqt_robot_steering',
             parameters=[{'default_topic': '/base/cmd_vel', 'default_vx_max': 2.5}]),
        Node(package='image_tools', executable='cam2image',
             parameters=[{'burger_mode': True, 'width': 64, 'height': 48, 'frequency': 10.0}]),
    ])
"""


IMAGES = """\
<launch>
  <node pkg="image_tools" exec="cam2image"><param name="burger_mode" value="true"/></node>
  <node pkg="rqt_image_view" exec="rqt_image_view" args="/image"/>
</launch>
"""


def test_image_takes_the_place_of_an_empty_scene(start: Start, open_page: Callable[..., Page], tmp_path: Path) -> None:
    (tmp_path / "camera.launch.xml").write_text(IMAGES)
    page = open_page(start("launch", str(tmp_path / "camera.launch.xml")), wait=False)
    until(page, "document.querySelector('.display-panel-host canvas')?.clientWidth > 500")
    assert page.locator(".panel-tab", has_text="3D View").is_visible()
    page.reload()
    until(page, "document.querySelector('.display-panel-host canvas')?.clientWidth > 500")


def test_launch_shows_image_plot_parameters_and_teleop(
    start: Start, open_page: Callable[..., Page], tmp_path: Path
) -> None:
    (tmp_path / "camera.launch.py").write_text(LAUNCH)
    page = open_page(start("launch", str(tmp_path / "camera.launch.py")), wait=False)
    until(page, "lw.panels.monitor.plots[0]?.series.every((series) => series.samples > 5)")
    series = page.evaluate("window.linkwright.panels.monitor.plots[0].series")
    assert {entry["name"]: entry["last"] for entry in series} == {"/image.height": 48, "/image.width": 64}
    page.locator(".plot canvas").wait_for()
    page.locator(".display-panel-host canvas").wait_for()
    until(page, "[...document.querySelectorAll('.display-panel-host canvas')].some((canvas) => canvas.width === 64)")
    assert page.get_by_role("textbox", name="Topic", exact=True).input_value() == "/base/cmd_vel"
    settings = page.evaluate("window.linkwright.panels.monitor.teleop.settings")
    assert (settings["topic"], settings["linear"]) == ("/base/cmd_vel", 2.5)
    page.locator(".panel-tab", has_text="Parameters").click()
    page.locator(".parameter-rows").get_by_text("burger_mode").wait_for()
