"""Create the pictures of a course's steps, and link them in the texts.

A picture is ``images/STEP.webp`` in the folder of its lesson.

Usage: python tools/lesson_pictures.py [--course COURSE] [LESSON | LESSON/STEP ...] (needs a Chromium and Pillow)

A step has what its row in `lesson_pictures.toml` says: a picture of a page, or the output of a command, as a block of
text. Without a row, a picture shows the robot after the solution of the step, if it looks different than before.
"""

from __future__ import annotations

import argparse
import io
import re
import shutil
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import closing
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import chromium
import gallery
from page_actions import Terminals, drain, perform_action
from PIL import Image
from playwright.sync_api import Browser, Error, Page, sync_playwright

from linkwright import load
from linkwright.learning.classroom import open_classroom
from linkwright.learning.course import Step, find_course
from linkwright.learning.lesson_text import LessonText

SEEN_HEADINGS = ("### What you should see now", "### 现在应该看到")
"""The headings of the sections to which the pictures belong."""

LEARNERS_FOLDER = "/home/you/robot_ws"

LISTENING_S = 2.0
"""Seconds after which a command that prints messages is sure to receive them."""

MAX_LINES = 24
"""The greatest number of lines of an output."""

FAILED_PAGE_FILE = Path(__file__).resolve().parent.parent / ".build" / "lesson-picture.png"
"""The file for a picture of a page in which an action failed."""

tomllib: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")

ROWS: dict[str, dict[str, dict[str, Any]]] = tomllib.loads(
    Path(__file__).with_suffix(".toml").read_text(encoding="utf-8")
)


def iterate_pictured_steps(workspace: Path, course: str) -> Iterator[tuple[Step, dict[str, Any]]]:
    """Yield each step with a picture or an output, and its row, with the step's files at hand."""
    classroom = open_classroom(workspace, course)
    previous_appearance = ""
    for step in classroom.course.steps:
        for folder in (step.lesson.start, step.solution):
            if folder.is_dir():
                shutil.copytree(folder, workspace, dirs_exist_ok=True)
        file = classroom.find_shown_file(step)
        appearance = previous_appearance if file is None or not file.is_file() else describe_appearance(file)
        row = ROWS.get(step.lesson.id, {}).get(step.id)
        if row is not None or appearance != previous_appearance:
            yield step, row or {"page": f"linkwright view {file}"}
        previous_appearance = appearance


def describe_appearance(file: Path) -> str:
    """Return a text that describes the appearance of a robot, rounded to 1 cm and 0.01 rad."""
    links = load(file).links.values()
    visuals = [
        (link.name, visual.geometry, visual.origin, visual.material) for link in links for visual in link.visuals
    ]
    return re.sub(r"(\.\d\d)\d+", r"\1", repr(visuals))


def make_pictures(browser: Browser, step: Step, row: dict[str, Any], workspace: Path) -> None:
    """Create the picture and the output of a step, and insert both into its texts."""
    with closing(Terminals(workspace)) as terminals:
        for command in row.get("before", ()):
            terminals.run(command)
        for command in row.get("beside", ()):
            drain(terminals.start(command))
        for topic in row.get("topics", ()):
            terminals.wait_for_topic(topic)
        time.sleep(row.get("seconds", 0))
        if "page" in row or "image" in row:
            image = step.lesson.folder / "images" / f"{step.id}.webp"
            image.parent.mkdir(exist_ok=True)
            make_picture(browser, terminals, row).save(image, quality=80, method=6)
            for language, lesson_text in step.lesson.texts.items():
                link_picture(lesson_text, step, row.get(language))
            print(image, image.stat().st_size)
        if "output" in row:
            with closing(Terminals(workspace)) as more:
                text = run_for_output(more, row)
            for lesson_text in step.lesson.texts.values():
                write_output(lesson_text, step, text)
            print(step.address, text, sep="\n")


def run_for_output(terminals: Terminals, row: dict[str, Any]) -> str:
    """Return the output of a command, or the lines of it that the row selects.

    ``folder`` is where it runs, ``begin`` a pattern of the first line, ``lines`` the number of lines after which it is
    stopped, and ``leave_out`` a pattern of lines that are left out. ``then`` has the commands that make it print. The
    path of the workspace becomes that of a learner.
    """
    program = terminals.start(row["output"], row.get("folder", "."))
    assert program.stdout is not None
    if "then" in row:
        time.sleep(LISTENING_S)
    for command in row.get("then", ()):
        drain(terminals.start(command))
    lines: list[str] = []
    for line in program.stdout:
        if re.search(row.get("leave_out", r"(?!)"), line) or (not lines and not re.search(row.get("begin", ""), line)):
            continue
        lines.append(line.rstrip().replace(str(terminals.workspace), LEARNERS_FOLDER))
        if len(lines) == row.get("lines"):
            break
    if not lines or len(lines) > MAX_LINES:
        raise SystemExit(f"{row['output']} prints {len(lines)} lines")
    drain(program)
    return "\n".join(lines).strip("\n")


def make_picture(browser: Browser, terminals: Terminals, row: dict[str, Any]) -> Image.Image:
    """Return a picture of a command's page after the actions of its row.

    The picture may also be an image that a command has written.
    ``show`` is what the picture shows: a selector of CSS, or without it the middle of the scene. ``crop`` is the part
    of it that is kept: left, top, right and bottom, in shares of its width and height. ``robot`` is false if the page
    shows no robot before the actions.
    """
    if "image" in row:
        shot = Image.open(terminals.workspace / row["image"]).convert("RGB")
        return shot.resize((gallery.SIZE[0], shot.height * gallery.SIZE[0] // shot.width), Image.Resampling.LANCZOS)
    width, height = row.get("window", gallery.WINDOW.values())
    page = browser.new_page(viewport={"width": width, "height": height}, locale="en-US")
    page.goto(terminals.serve(row["page"]))
    drawn = "ready" if row.get("robot", True) else "displays.length > 0"
    page.wait_for_function(f"window.linkwright?.{drawn}", timeout=60_000)
    try:
        for action in row.get("do", ()):
            perform_action(page, terminals, action)
    except Error:
        page.screenshot(path=FAILED_PAGE_FILE)
        print(f"'{action}' failed; {FAILED_PAGE_FILE} shows the page")
        raise
    shot = capture_picture(page, row.get("show"), row.get("crop", (0, 0, 1, 1)))
    page.close()
    return shot


def capture_picture(page: Page, selector: str | None, crop: Sequence[float]) -> Image.Image:
    """Return a picture of a part of a page, or of the middle of the scene."""
    if selector is not None:
        shot = Image.open(io.BytesIO(page.locator(selector).first.screenshot(timeout=60_000))).convert("RGB")
        left, top, right, bottom = crop
        box = left * shot.width, top * shot.height, right * shot.width, bottom * shot.height
        shot = shot.crop(tuple(map(round, box)))  # type: ignore[arg-type]
        width = min(shot.width, 2 * gallery.SIZE[0])
        return shot.resize((width, shot.height * width // shot.width), Image.Resampling.LANCZOS)
    return gallery.capture_scene(page)


def find_section(text: LessonText, step: Step, content: str) -> tuple[int, int]:
    """Return the start and end of a step's section on what the learner should see."""
    start = re.search(rf"^## .*\{{#{step.id}[ }}]", content, re.MULTILINE)
    section = start and re.compile("|".join(map(re.escape, SEEN_HEADINGS))).search(content, start.end())
    if not section:
        raise SystemExit(f"{text.path}: the step {step.id} does not say what one should see")
    return section.end(), content.index("\n### ", section.end())


def write_output(text: LessonText, step: Step, run_for_output: str) -> None:
    """Replace the block of output in the section of a step, or append one."""
    content = text.path.read_text(encoding="utf-8")
    start, end = find_section(text, step, content)
    section, block = content[start:end], f"```text\n{run_for_output}\n```"
    changed, count = re.subn(r"```text\n.*?```", lambda _: block, section, count=1, flags=re.DOTALL)
    if not count:
        text_before, picture, text_after = section.partition("\n![")
        changed = f"{text_before}\n{block}\n{picture}{text_after}"
    text.path.write_text(content[:start] + changed + content[end:], encoding="utf-8")


def link_picture(text: LessonText, step: Step, description: str | None) -> None:
    """Insert a step's picture into a text, below the section on what the learner should see."""
    content = text.path.read_text(encoding="utf-8")
    start, end = find_section(text, step, content)
    title = description or next(candidate.title for candidate in text.steps if candidate.id == step.id)
    picture = f"![{title}](images/{step.id}.webp)"
    section = re.sub(rf"\n!\[[^\]]*\]\(images/{step.id}\.webp\)\n", "", content[start:end]).rstrip() + "\n"
    text.path.write_text(f"{content[:start]}{section}\n{picture}\n{content[end:]}", encoding="utf-8")


def main() -> int:
    """Create the pictures of the named lessons and steps, or of all."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--course", default="robot")
    parser.add_argument("names", nargs="*", metavar="LESSON")
    arguments = parser.parse_args()
    with TemporaryDirectory() as workspace, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium.find_chromium() or chromium.fetch_chromium(), args=list(gallery.CHROMIUM_FLAGS)
        )
        for step, row in iterate_pictured_steps(Path(workspace), str(find_course(arguments.course))):
            if not arguments.names or {step.lesson.id, step.address} & set(arguments.names):
                make_pictures(browser, step, row, Path(workspace))
        browser.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
