"""Images of the page beside the tests, for people who judge a layout.

No test compares them, because fonts and graphics differ between machines; the tests compute what must hold. With
``LINKWRIGHT_KEEP_PICTURES=yes`` the tests write them again.
"""

from __future__ import annotations

import io
import os
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page

FOLDER = Path(__file__).parent / "pictures"
_MAX_COLORS = 96


def keep(page: Page, name: str) -> None:
    """Save a page's screenshot as a small PNG if images are kept."""
    if "LINKWRIGHT_KEEP_PICTURES" not in os.environ:
        return
    with Image.open(io.BytesIO(page.screenshot())) as image:
        FOLDER.mkdir(exist_ok=True)
        image.convert("RGB").quantize(_MAX_COLORS).save(FOLDER / f"{name}.png", optimize=True)
