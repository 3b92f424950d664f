"""Make the pictures of the steps of a course, ``images/STEP.webp`` in each lesson, and link them in the texts.

Usage: python tools/lesson_pictures.py [--course COURSE] [LESSON ...] (needs a Chromium and Pillow)

A picture shows the robot after the solution of its step, if it looks different than before, or the scene of the
step's command in `lesson_pictures.toml`.
"""

from __future__ import annotations

import argparse
import re
import shutil
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import chromium
import gallery
from playwright.sync_api import Browser, sync_playwright

from linkwright import load
from linkwright.learning.classroom import open_classroom
from linkwright.learning.course import Step, find_course

SEEN = ("### What you should see now", "### 现在应该看到")
"""The headings of the sections to which the pictures belong."""


tomllib: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")

COMMANDS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))


def pictured(workspace: Path, course: str) -> Iterator[tuple[Step, list[str]]]:
    """Yield each step with a picture, and the words of the command that shows it, with the step's files at hand."""
    room = open_classroom(workspace, course)
    before = ""
    for step in room.course.steps:
        for folder in (step.lesson.start, step.solution):
            if folder.is_dir():
                shutil.copytree(folder, workspace, dirs_exist_ok=True)
        command = COMMANDS.get(step.lesson.id, {}).get(step.id)
        if command is not None:
            yield step, command.split()
            continue
        file = room.shown_file(step)
        if file is None or not file.is_file():
            continue
        look = appearance(file)
        if look != before:
            yield step, ["view", str(file)]
        before = look


def appearance(file: Path) -> str:
    """Return what a robot looks like, as a text, to 1 cm and 0.01 rad."""
    links = load(file).links.values()
    visuals = [
        (link.name, visual.geometry, visual.origin, visual.material) for link in links for visual in link.visuals
    ]
    return re.sub(r"(\.\d\d)\d+", r"\1", repr(visuals))


def link_picture(step: Step) -> None:
    """Show the picture of a step in the texts of its lesson, below what one should see."""
    for text in step.lesson.texts.values():
        content = text.path.read_text(encoding="utf-8")
        title = next(each.title for each in text.steps if each.id == step.id)
        picture = f"![{title}](images/{step.id}.webp)"
        start = re.search(rf"^## .*\{{#{step.id}[ }}]", content, re.MULTILINE)
        if picture in content or start is None:
            continue
        section = re.compile("|".join(map(re.escape, SEEN))).search(content, start.end())
        if section is None:
            raise SystemExit(f"{text.path}: the step {step.id} does not say what one should see")
        end = content.index("\n### ", section.end())
        text.path.write_text(f"{content[:end]}\n{picture}\n{content[end:]}", encoding="utf-8")


def make_picture(browser: Browser, step: Step, words: list[str], workspace: Path) -> None:
    """Write the picture of a step, and link it."""
    image = step.lesson.folder / "images" / f"{step.id}.webp"
    image.parent.mkdir(exist_ok=True)
    gallery.make_image(browser, words, image, workspace)
    link_picture(step)
    print(image)


def main() -> int:
    """Make the pictures of these lessons, or of all."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--course", default="robot")
    parser.add_argument("lessons", nargs="*", metavar="LESSON")
    arguments = parser.parse_args()
    with TemporaryDirectory() as workspace, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium.find() or chromium.fetch(), args=list(gallery.FLAGS)
        )
        for step, words in pictured(Path(workspace), str(find_course(arguments.course))):
            if not arguments.lessons or step.lesson.id in arguments.lessons:
                make_picture(browser, step, words, Path(workspace))
        browser.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
