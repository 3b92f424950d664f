"""Pages on slow connections, and that pages request nothing from other hosts."""

from __future__ import annotations

from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest

from tests.browser.conftest import TIMEOUT_S, until
from tests.browser.live import configuration
from tests.page.test_slow_lines import make_cloud, make_image
from tests.viewer.throttle import slow_line
from tests.waiting import wait_until

pytestmark = pytest.mark.browser

_SQUARE_PX = 8

SENSES = configuration(
    """
- Class: rviz_default_plugins/PointCloud2
  Enabled: true
  Name: Cloud
  Topic:
    Value: /cloud
- Class: rviz_default_plugins/Image
  Enabled: true
  Name: Picture
  Topic:
    Value: /image
"""
)


def make_noise_image(width: int, height: int) -> Any:
    """Return an image of squares of random colors.

    It is hard to compress, also at the size of its panel.
    """
    message = make_image(width, height)
    squares = np.random.default_rng(1).integers(0, 256, (height // _SQUARE_PX, width // _SQUARE_PX, 3), np.uint8)
    message.data = squares.repeat(_SQUARE_PX, axis=0).repeat(_SQUARE_PX, axis=1).tobytes()
    return message


_HELD = """
  const told = new Promise((resolve) => (window.tell = resolve));
  window.WebSocket = class extends WebSocket {
    set onmessage(take) { super.onmessage = async (event) => { await told; take(event); }; }
  };
"""
"""Runs before the page's scripts, and holds the server's messages until `tell` is called."""

_WAITING = """async () => {
  for (let frame = 0; frame < 10; frame++) await new Promise(requestAnimationFrame);
  const canvas = document.querySelector(".canvas-box canvas");
  const timings = document.getAnimations().map(({ effect }) => effect.getTiming());
  return {
    frames: linkwright.framesDrawn,
    canvas: getComputedStyle(canvas).visibility,
    behind: getComputedStyle(canvas.parentElement).backgroundColor,
    moving: timings.filter(({ iterations, delay }) => iterations === Infinity && delay < 1000).length,
  };
}"""


class SlowAddress:
    """The address of a viewer, reached through a slow line."""

    def __init__(self, url: str) -> None:
        self.url = url


def test_slow_connection_thins_heavy_topics_and_shows_notice(start_viewer, open_page):
    viewer = start_viewer(SENSES)
    viewer.place("tip", 1.0, 0.0, 0.0)
    line = slow_line(viewer.url, 100_000.0)  # images are scaled to the size of their panel
    page = open_page(SlowAddress(viewer.run(line.__aenter__)), wait=False)
    until(page, "lw.displays.length === 2")

    heavy_messages = make_cloud(50_000), make_noise_image(1280, 720)
    facts: dict[str, Any] = {}

    def is_thinned() -> bool:
        """Publish both topics, and return whether both are thinned.

        Both are published because a silent topic's last message is sent whole.
        """
        for topic, message in zip(("/cloud", "/image"), heavy_messages, strict=True):
            viewer.publish(topic, message)
        notice = "document.querySelector('.line-notice:not([hidden])')?.innerText ?? ''"
        facts.update(
            page.evaluate(f"() => ({{ text: {notice}, drawn: linkwright.displays.map((display) => display.drawn) }})")
        )
        points, shown_points = facts["drawn"]
        return (
            all(
                text in facts["text"]
                for text in ("The connection is slow", "Cloud 1 in", "of 1280 × 720, quality", "WebP")
            )
            and points["step"] > 1
            and 0 < points["points"] < 50_000
            and shown_points["width"] == 1280
        )

    wait_until(is_thinned, TIMEOUT_S, lambda: facts)
    # Without other traffic, all data arrives.
    until(page, "lw.displays[0].drawn.points === 50000 && document.querySelector('.line-notice').hidden")
    viewer.run(lambda: line.__aexit__(None, None, None))


def test_fast_connection_shows_no_notice(start_viewer, open_page):
    viewer = start_viewer(SENSES)
    page = open_page(viewer, wait=False)
    until(page, "lw.displays.length === 2")
    heavy_messages = make_cloud(100_000)
    for _ in range(20):
        viewer.publish("/cloud", heavy_messages)
    until(page, "lw.displays[0].drawn?.points === 100000")
    until(page, "document.querySelector('.line-notice').hidden")


def test_scene_is_not_drawn_before_displays_are_known(start_viewer, browser):
    """Without a GPU, each frame of a waiting page would cost a frame of the robot's page."""
    viewer = start_viewer(SENSES)
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    context.add_init_script(_HELD)
    page = context.new_page()
    page.goto(viewer.url)
    until(page, "lw.framesDrawn >= 0")
    assert page.evaluate(_WAITING) == {"frames": 0, "canvas": "hidden", "behind": "rgb(48, 48, 48)", "moving": 0}
    page.evaluate("tell()")
    until(page, "lw.framesDrawn > 0")
    until(page, "getComputedStyle(document.querySelector('.canvas-box canvas')).visibility === 'visible'")
    context.close()


def test_page_requests_nothing_from_other_hosts(start_viewer, browser):
    viewer = start_viewer(SENSES)
    host = urlsplit(viewer.url).netloc
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    page = context.new_page()
    urls: list[str] = []
    page.on("request", lambda request: urls.append(request.url))
    page.on("websocket", lambda socket: urls.append(socket.url))
    page.goto(viewer.url)
    until(page, "lw.displays.length === 2")
    viewer.publish("/image", make_image(64, 64))
    # Panels that are created when they are opened may request more files.
    for name in ("File", "Panels", "Share"):
        page.get_by_role("button", name=name, exact=True).click()
        page.keyboard.press("Escape")
    until(page, "lw.displays[1].drawn?.width === 64")
    page.wait_for_load_state("networkidle")
    context.close()
    assert len(urls) > 3
    foreign_urls = [url for url in urls if urlsplit(url).netloc != host and not url.startswith(("data:", "blob:"))]
    assert foreign_urls == []
