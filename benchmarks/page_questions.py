"""Measurements of an opened page: time to the first frame, frame rate, and age of the data."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Page

from benchmarks.plain_browser import PlainPage

_SLIDER = """
async ([row, value]) => {
  const slider = document.querySelector(`[data-joint="${row}"] input[type=range]`);
  const orientation = () => JSON.stringify(window.linkwright.frames.left_wheel_link.orientation);
  const before = orientation();
  const begin = performance.now();
  const until = async (happened) => {
    while (!happened()) {
      if (performance.now() - begin > 5000) throw new Error("nothing happened");
      await new Promise((next) => setTimeout(next, 1));
    }
    return performance.now() - begin;
  };
  slider.value = String(value);
  slider.dispatchEvent(new Event("input", { bubbles: true }));
  // The frame may be drawn between two looks, and the next one not before the next move.
  let frames = window.linkwright.framesDrawn;
  const known = await until(() => {
    if (orientation() !== before) return true;
    frames = window.linkwright.framesDrawn;
    return false;
  });
  return [known, await until(() => window.linkwright.framesDrawn > frames)];
}
"""

_SAVED = """
async ([link, z]) => {
  const limit = performance.now() + 5000;
  while (Math.abs((window.linkwright.frames[link]?.position[2] ?? NaN) - z) > 1e-6 || Number.isNaN(z)) {
    if (performance.now() > limit) return null;
    await new Promise((next) => setTimeout(next, 1));
  }
  return performance.timeOrigin + performance.now();
}
"""

_WATCH_WHEEL = """
() => {
  window.turns = [];
  addEventListener("wheel", async (event) => {
    const frames = window.linkwright.framesDrawn;
    while (window.linkwright.framesDrawn === frames) await new Promise((next) => setTimeout(next, 0));
    window.turns.push(performance.now() - event.timeStamp);
  }, { capture: true, passive: true });
}
"""

_DRAWN = "() => window.linkwright.framesDrawn"

COUNT_FRAMES = """
(() => {
  let drew = false;
  window.framesWithDrawing = 0;
  for (const { prototype } of [WebGLRenderingContext, WebGL2RenderingContext]) {
    for (const name of ["drawArrays", "drawElements", "drawArraysInstanced", "drawElementsInstanced"]) {
      const draw = prototype[name];
      if (draw) prototype[name] = function (...words) { drew = true; return draw.apply(this, words); };
    }
  }
  const next = () => {
    if (drew) window.framesWithDrawing += 1;
    drew = false;
    requestAnimationFrame(next);
  };
  requestAnimationFrame(next);
})();
"""
"""A script for pages of other programs, run before their own: counts the frames in which WebGL draws."""


def measure_slider_latency(page: Page, moves: int) -> tuple[list[float], list[float]]:
    """Return the ms from a slider's input events to the new transform in the page, and to its frame."""
    known, drawn = [], []
    for number in range(moves):
        page.wait_for_timeout(37 + 13 * (number % 7))
        value = -1 + 2 * ((number * 7) % moves) / moves
        first, second = page.evaluate(_SLIDER, ["left_wheel_joint", value])
        known.append(first)
        drawn.append(second)
    return known, drawn


def measure_save_latency(page: Page, model: Path, saves: int) -> list[float]:
    """Return the ms from the end of a file's writing to the changed frame in the page."""
    text = model.read_text(encoding="utf-8")
    times = []
    for number in range(saves):
        page.wait_for_timeout(150)
        z = -0.05 - 0.001 * (number + 1)
        model.write_text(text.replace("0 0.19 -0.05", f"0 0.19 {z:.4f}"), encoding="utf-8")
        begin = time.time() * 1000
        end = page.evaluate(_SAVED, ["left_wheel_link", z])
        times.append(end - begin)
    return times


def measure_wheel_latency(page: PlainPage, turns: int) -> list[float]:
    """Return the ms from a mouse wheel event in the browser to the frame drawn after it."""
    page.evaluate(_WATCH_WHEEL)
    for number in range(turns):
        page.wheel(640, 400, 20 if number % 2 else -20)
        time.sleep((97 + 13 * (number % 7)) / 1000)
    times: list[float] = page.evaluate("() => window.turns")
    return times


def count_frames(page: Page | PlainPage) -> int:
    """Return the number of frames that the page has drawn."""
    count: int = page.evaluate(_DRAWN)
    return count


def count_drawing_frames(page: PlainPage) -> int:
    """Return the number of frames that a page with `COUNT_FRAMES` has drawn."""
    count: int = page.evaluate("() => window.framesWithDrawing")
    return count


def count_images(page: PlainPage) -> int:
    """Return the number of images that the first display has shown, in a panel of its own."""
    count: int = page.evaluate("() => window.linkwright.displays[0].drawn.images")
    return count


def measure_rate(counted: Callable[[PlainPage], int], page: PlainPage, seconds: float) -> float:
    """Return the increase of a counter per second."""
    old_count, begin = counted(page), time.perf_counter()
    time.sleep(seconds)
    return (counted(page) - old_count) / (time.perf_counter() - begin)


def measure_transform_age(pages: list[PlainPage], times: int) -> float:
    """Return the median age of the oldest transforms in pages, in milliseconds."""
    oldest: list[float] = []
    for number in range(times):
        time.sleep(0.1 + 0.013 * (number % 7))
        oldest.append(max(page.evaluate("() => Date.now() - 1000 * window.linkwright.stamp") for page in pages))
    return statistics.median(oldest)


def open_every_panel(page: Page) -> int:
    """Open all panels, and return the number of panels that were closed."""
    count = 0
    while True:
        page.get_by_role("button", name="Panels").click()
        closed = page.locator('[role=menuitemcheckbox][aria-checked="false"]')
        if closed.count() == 0:
            page.keyboard.press("Escape")
            return count
        closed.first.click()
        count += 1


def measure_scripts(page: Page) -> float:
    """Return the KiB of scripts and styles that the page had fetched when it first drew."""
    size: float = page.evaluate(
        "() => performance.getEntriesByType('resource')"
        ".filter((each) => /[.](js|css)$/.test(new URL(each.name).pathname))"
        ".reduce((sum, each) => sum + each.decodedBodySize, 0) / 1024"
    )
    return size
