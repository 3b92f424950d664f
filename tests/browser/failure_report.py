"""The content of the pages of a failed test: a screenshot of each, its text and its state."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Browser, Error, Page

_TIMEOUT_MS = 10_000
"""The time limit in milliseconds; the page itself may hang."""
_STATE = "() => JSON.stringify({ready: window.linkwright?.ready, frames: window.linkwright?.framesDrawn})"


def describe_pages(browser: Browser, folder: Path, name: str) -> str:
    """Describe all open pages, and save their screenshots in a folder."""
    pages = [page for context in browser.contexts for page in context.pages]
    return "\n".join(_describe(page, folder / f"{name}-{number}.png") for number, page in enumerate(pages))


def _describe(page: Page, screenshot: Path) -> str:
    try:
        screenshot.parent.mkdir(parents=True, exist_ok=True)
        page.screenshot(path=screenshot, timeout=_TIMEOUT_MS)
        text = page.locator("body").inner_text(timeout=_TIMEOUT_MS)
        return f"{page.url}\n{screenshot}\n{page.evaluate(_STATE)}\n{text}"
    except Error as error:
        return f"{page.url}\nthe page cannot be inspected: {error.message}"
