"""Pictures of the page that stand beside the tests, for people: what a layout looks like is seen, and not computed.

They are not compared with, as fonts and graphics differ from machine to machine; the tests compute what must hold. With
``LINKWRIGHT_KEEP_PICTURES=yes`` the tests that keep some write them anew.
"""

from __future__ import annotations

import io
import os
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page

FOLDER = Path(__file__).parent / "pictures"
_COLORS = 96


def keep(page: Page, name: str) -> None:
    """Write what a page shows as a small PNG, where pictures are to be kept."""
    if "LINKWRIGHT_KEEP_PICTURES" not in os.environ:
        return
    with Image.open(io.BytesIO(page.screenshot())) as image:
        FOLDER.mkdir(exist_ok=True)
        image.convert("RGB").quantize(_COLORS).save(FOLDER / f"{name}.png", optimize=True)
