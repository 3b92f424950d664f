"""Take the picture of the README from the running program: ``python tools/readme_picture.py`` (needs a Chromium)."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import chromium
from playwright.sync_api import sync_playwright

TARGET = Path(__file__).resolve().parent.parent / "docs" / "images" / "mbot.png"
COMMAND = ("launch", "my_robot_description", "display_xacro.launch.py", "--no-open")
FLAGS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking")


def main() -> int:
    """Start the program, turn a wheel, select the link, take the picture."""
    with tempfile.TemporaryDirectory() as state:  # the program keeps there what is not saved
        return 0 if take({**os.environ, "XDG_STATE_HOME": state}) == 130 else 1


def take(environment: dict[str, str]) -> int:
    """The same in an environment; the exit status of the program."""
    command = [sys.executable, "-m", "linkwright", *COMMAND]
    program = subprocess.Popen(command, stdout=subprocess.PIPE, env=environment, text=True)
    assert program.stdout is not None
    url = next(line.split()[1] for line in program.stdout if line.startswith("Viewer: "))
    with sync_playwright() as playwright:
        path = chromium.find() or chromium.fetch()
        browser = playwright.chromium.launch(executable_path=path, args=list(FLAGS))
        page = browser.new_page(viewport={"width": 1280, "height": 800}, locale="en-US")
        page.goto(url)
        page.wait_for_function("window.linkwright?.ready === true")
        page.locator('[data-joint="left_wheel_joint"] input[type=range]').fill("0.9")
        # The tutorial's axes are as long as the robot is wide; at a third of that the robot shows.
        tf = page.locator(".row:has(.row-title:text-is('TF'))")
        tf.locator(".row-name").dblclick()
        scale = page.locator(".row:has(.row-title:text-is('Marker Scale')) input")
        scale.fill("0.35")
        scale.press("Enter")
        tf.locator(".row-name").dblclick()
        canvas = page.locator("canvas").first.bounding_box()
        assert canvas is not None
        page.mouse.move(canvas["x"] + 300, canvas["y"] + 300)
        page.mouse.wheel(0, -240)
        page.mouse.click(canvas["x"] + canvas["width"] * 0.5, canvas["y"] + canvas["height"] * 0.56)
        page.wait_for_timeout(800)
        TARGET.parent.mkdir(parents=True, exist_ok=True)
        page.screenshot(path=str(TARGET))
        browser.close()
    program.send_signal(signal.SIGINT)
    return program.wait(timeout=10)


if __name__ == "__main__":
    raise SystemExit(main())
