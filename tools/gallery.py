"""Create the images of the gallery from its descriptions.

``docs/gallery/NAME.xacro`` becomes ``docs/gallery/NAME.webp``.

Usage: python tools/gallery.py [NAME ...] (needs a Chromium and Pillow)

An image shows the scene of `linkwright view` in a headless browser, without panels.
"""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import chromium
from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "gallery"
PARTS = "parts"
"""The file that the robots include; it does not describe a robot itself."""

CHROMIUM_FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
)
WINDOW = {"width": 1480, "height": 812}
SIZE = (480, 360)
SETTLING_MS = 4000
"""Milliseconds after which the scene is drawn at its full resolution."""

_CONTROLS_HIDDEN = """(canvas) => {
  for (let element = canvas; element.parentElement; element = element.parentElement) {
    for (const sibling of element.parentElement.children) {
      if (sibling !== element && getComputedStyle(sibling).position === "absolute") sibling.style.visibility = "hidden";
    }
  }
}"""


def list_robots() -> list[str]:
    """Return the names of the robots."""
    return sorted(path.stem for path in FOLDER.glob("*.xacro") if path.stem != PARTS)


def make_image(browser: Browser, words: Sequence[str], image: Path, folder: Path) -> None:
    """Run a command such as ``view FILE`` in a folder, and write an image of its scene."""
    command = [sys.executable, "-m", "linkwright", *words, "--no-open"]
    environment = {**os.environ, "LINKWRIGHT_DDS": "0"}
    program = subprocess.Popen(command, stdout=subprocess.PIPE, env=environment, cwd=folder, text=True)
    assert program.stdout is not None
    try:
        page = browser.new_page(viewport=WINDOW, locale="en-US")  # type: ignore[arg-type]
        page.goto(next(line.split()[1] for line in program.stdout if line.startswith("Viewer: ")))
        page.wait_for_function("window.linkwright?.ready === true", timeout=60_000)
        small = capture_scene(page)
        page.close()
    finally:
        program.send_signal(signal.SIGINT)
        program.wait(timeout=30)
    small.save(image, quality=80, method=6)


def capture_scene(page: Page) -> Image.Image:
    """Capture the middle of a page's scene, without the controls over it."""
    canvas = page.locator("canvas").first
    canvas.evaluate(_CONTROLS_HIDDEN)
    page.wait_for_timeout(SETTLING_MS)
    shot = Image.open(io.BytesIO(canvas.screenshot(timeout=60_000))).convert("RGB")
    height = min(shot.height, shot.width * SIZE[1] // SIZE[0])
    width = height * SIZE[0] // SIZE[1]
    left, top = (shot.width - width) // 2, (shot.height - height) // 2
    return shot.crop((left, top, left + width, top + height)).resize(SIZE, Image.Resampling.LANCZOS)


def main(names: Sequence[str]) -> int:
    """Create the images of the named robots, or of all robots."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium.find_chromium() or chromium.fetch_chromium(), args=list(CHROMIUM_FLAGS)
        )
        for name in names or list_robots():
            make_image(browser, ["view", f"{name}.xacro"], FOLDER / f"{name}.webp", FOLDER)
        browser.close()
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
