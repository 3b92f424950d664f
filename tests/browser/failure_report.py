"""What the pages of a failed test showed: a screenshot of each, its text and its state."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Browser, Error, Page

_PATIENCE = 10_000
"""Milliseconds for a page that may be the very thing that hangs."""
_STATE = "() => JSON.stringify({ready: window.linkwright?.ready, frames: window.linkwright?.framesDrawn})"


def what_was_seen(browser: Browser, folder: Path, name: str) -> str:
    """Describe all open pages, and write their pictures into a folder."""
    pages = [page for context in browser.contexts for page in context.pages]
    return "\n".join(_seen(page, folder / f"{name}-{number}.png") for number, page in enumerate(pages))


def _seen(page: Page, screenshot: Path) -> str:
    try:
        screenshot.parent.mkdir(parents=True, exist_ok=True)
        page.screenshot(path=screenshot, timeout=_PATIENCE)
        text = page.locator("body").inner_text(timeout=_PATIENCE)
        return f"{page.url}\n{screenshot}\n{page.evaluate(_STATE)}\n{text}"
    except Error as error:
        return f"{page.url}\nit cannot be looked at: {error.message}"
