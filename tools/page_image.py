"""Make an image of the page that a command serves, for the documentation.

Usage: python tools/page_image.py IMAGE [--wait SECONDS] [--click TEXT ...] -- COMMAND ... (needs a Chromium and Pillow)

The command, such as ``linkwright view robot.urdf``, is run without opening a browser; the image is a WebP screenshot of
its page in a headless browser after the given clicks, in English or, with ``--lang zh``, in Chinese.
"""

from __future__ import annotations

import argparse
import io
import os
import signal
import subprocess
import sys
from pathlib import Path

import chromium
from PIL import Image
from playwright.sync_api import Page, sync_playwright

CHROMIUM_FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
)
PAGE_SIZE = {"width": 1120, "height": 700}
LOCALES = {"en": "en-US", "zh": "zh-CN"}
TIMEOUT_MS = 60_000
"""The timeout of an action, in milliseconds."""


def main() -> int:
    """Start the command, make the image, and end the command."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("image", type=Path)
    parser.add_argument("--wait", type=float, default=2.0, help="seconds until the robot stands where it should")
    parser.add_argument("--click", action="append", default=[], metavar="TEXT", help="a button or label, in this order")
    parser.add_argument("--lang", choices=list(LOCALES), default="en")
    parser.add_argument("command", nargs="+")
    arguments = parser.parse_args()
    program = subprocess.Popen(
        arguments.command, stdout=subprocess.PIPE, text=True, env={**os.environ, "BROWSER": "true"}
    )
    assert program.stdout is not None
    try:
        url = next(line.split()[1] for line in program.stdout if line.startswith("Viewer: "))
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(
                executable_path=chromium.find_chromium() or chromium.fetch_chromium(), args=list(CHROMIUM_FLAGS)
            )
            page = browser.new_page(viewport=PAGE_SIZE, locale=LOCALES[arguments.lang])  # type: ignore[arg-type]
            page.goto(url)
            page.wait_for_function("window.linkwright?.ready === true", timeout=TIMEOUT_MS)
            click_texts(page, arguments.click)
            page.wait_for_timeout(arguments.wait * 1000)
            shot = Image.open(io.BytesIO(page.screenshot(timeout=TIMEOUT_MS))).convert("RGB")
            shot.save(arguments.image, quality=76, method=6)
            browser.close()
    finally:
        program.send_signal(signal.SIGINT)
        program.wait(timeout=30)
    return 0


def click_texts(page: Page, texts: list[str]) -> None:
    """Click the element with each text, one after the other."""
    for text in texts:
        page.get_by_text(text, exact=True).first.click(timeout=TIMEOUT_MS)


if __name__ == "__main__":
    sys.exit(main())
