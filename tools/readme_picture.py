"""Make the moving picture of the README from the running program.

Usage: python tools/readme_picture.py (needs a Chromium and Pillow)

`linkwright view` shows a copy of mbot's xacro file in a headless browser. A slider is moved, then the file is edited
and saved, and the page follows. Each frame is a screenshot of the page above the line of the file that is edited.
"""

from __future__ import annotations

import io
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import chromium
from PIL import Image, ImageDraw, ImageFont
from playwright.sync_api import Page, sync_playwright

ROOT = Path(__file__).resolve().parent.parent
TARGET = ROOT / "docs" / "images" / "mbot.webp"
MODEL = ROOT / "robots" / "my_robot_description" / "urdf" / "mbot_base.xacro"
CHROMIUM_FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
)

SIZE = (1120, 630)
"""The size of the page in pixels."""
STRIP_HEIGHT = 44
"""The height of the strip with the edited line, in pixels."""


@dataclass
class Film:
    """The recorded frames, each with its duration in milliseconds.

    Attributes:
        page: the page to record.
        line: the text in the strip below it.
    """

    page: Page
    line: str = ""
    frames: list[Image.Image] = field(default_factory=list)
    durations: list[int] = field(default_factory=list)

    def record(self, milliseconds: int) -> None:
        """Add a frame with the current page."""
        shot = Image.open(io.BytesIO(self.page.screenshot())).convert("RGB")
        frame = Image.new("RGB", (SIZE[0], SIZE[1] + STRIP_HEIGHT), "#1e2327")
        frame.paste(shot)
        ImageDraw.Draw(frame).text((16, SIZE[1] + 12), self.line, font=ImageFont.load_default(17), fill="#e6e6e6")
        self.frames.append(frame)
        self.durations.append(milliseconds)

    def save(self, target: Path) -> None:
        """Write the frames as an animated WebP."""
        target.parent.mkdir(parents=True, exist_ok=True)
        first, *rest = self.frames
        first.save(target, save_all=True, append_images=rest, duration=self.durations, loop=0, quality=72, method=6)


def main() -> int:
    """Start the program on a copy of the model, record the page, and write the picture."""
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "mbot.urdf.xacro"
        shutil.copy(MODEL, model)
        environment = {**os.environ, "XDG_STATE_HOME": folder, "LINKWRIGHT_DDS": "0"}
        command = [sys.executable, "-m", "linkwright", "view", model.name, "--no-open"]
        program = subprocess.Popen(command, stdout=subprocess.PIPE, env=environment, cwd=folder, text=True)
        assert program.stdout is not None
        try:
            url = next(line.split()[1] for line in program.stdout if line.startswith("Viewer: "))
            with sync_playwright() as playwright:
                browser = playwright.chromium.launch(
                    executable_path=chromium.find_chromium() or chromium.fetch_chromium(), args=list(CHROMIUM_FLAGS)
                )
                page = browser.new_page(viewport={"width": SIZE[0], "height": SIZE[1]}, locale="en-US")
                page.goto(url)
                page.wait_for_function("window.linkwright?.ready === true")
                film = Film(page)
                play(film, model)
                film.save(TARGET)
                browser.close()
        finally:
            program.send_signal(signal.SIGINT)
            status = program.wait(timeout=20)
    return 0 if status == 130 else 1


def play(film: Film, model: Path) -> None:
    """Carry out the actions of the picture, which take about ten seconds."""
    page = film.page
    canvas = page.locator("canvas").first.bounding_box()
    assert canvas is not None
    page.mouse.move(canvas["x"] + canvas["width"] / 2, canvas["y"] + canvas["height"] / 2)
    while page.evaluate("window.linkwright.view.distance") > 1.7:
        page.mouse.wheel(0, -120)
        wait_until(page, "lw.ready")
    slider = page.locator('[data-joint="left_wheel_joint"] input[type=range]')
    film.line = f"$ linkwright view {model.name}"
    film.record(1400)
    for step in range(1, 16):
        slider.fill(f"{0.14 * step:.2f}")
        wait_until(page, f"Math.abs(lw.joints.left_wheel_joint - {0.14 * step:.2f}) < 0.02")
        film.record(120)
    film.record(600)
    edit(film, model, "wheel_joint_y", ("0.19", "0.23", "0.28"), "lw.frames.left_wheel_link.position[1]")
    edit(film, model, "kinect_joint_z", ("0.38", "0.46", "0.54"), "lw.frames.kinect_link.position[2]")
    film.record(1200)


def edit(film: Film, model: Path, name: str, values: tuple[str, ...], seen: str) -> None:
    """Set a property of the model to values in turn, and save each time.

    The first value is in the file already.

    Args:
        film: the film.
        model: the file.
        name: the name of the property.
        values: the values of the property.
        seen: the JavaScript expression for the quantity in the page that becomes the value.
    """
    for old_value, new_value in pairwise(values):
        text = model.read_text(encoding="utf-8")
        old, new = (f'<xacro:property name="{name}" value="{value}"/>' for value in (old_value, new_value))
        film.line = f"{model.name}:  {old}"
        film.record(500)
        model.write_text(text.replace(old, new), encoding="utf-8")
        film.line = f"{model.name}:  {new}"
        wait_until(film.page, f"Math.abs({seen} - {new_value}) < 1e-6 && lw.ready")
        film.record(700)


def wait_until(page: Page, condition: str) -> None:
    """Wait until a condition holds, and the page was painted after that.

    In the condition, `lw` is the page's `window.linkwright`.
    """
    page.wait_for_function(f"() => {{ const lw = window.linkwright; return {condition}; }}")
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


if __name__ == "__main__":
    raise SystemExit(main())
