"""Walk through a course in the page as a learner does, in both languages.

Each step must be red before it is done and green afterwards.

Usage: python tools/walk_course.py [--course COURSE] [--lang zh] [LESSON ...] (needs a Chromium)

The solution of a step stands for the learner's work, and answers are typed into the page. Every lesson is read in
another language than the one before, the first in English or, with ``--lang zh``, in Chinese. The exit status is 1 if a
step is green before it is done, or not green after.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import chromium
import gallery
from playwright.sync_api import Page, sync_playwright

from linkwright.learning.course import Course, Step, find_course, load_course

LOCALES = {"en": "en-US", "zh": "zh-CN"}
TIMEOUT_MS = 150_000
"""The timeout of a check, in milliseconds."""

_CHECKED = """(address) => {
  const { step, checks } = window.linkwright?.panels.lesson ?? {};
  return step === address && checks?.address === address && !checks.is_running && checks.checked_at !== null;
}"""
_PASSED = "() => window.linkwright.panels.lesson.checks.checks.every((check) => check.is_passed)"
_MESSAGES = "() => window.linkwright.panels.lesson.checks.checks.filter((check) => !check.is_passed)"
_TITLE = "(title) => document.querySelector('.lesson-body h2')?.textContent === title"


def walk_course(page: Page, course: Course, lessons: list[str], workspace: Path) -> int:
    """Walk through the lessons, and return the number of steps that are not as they should be."""
    failures = 0
    for number, lesson in enumerate(course.lessons):
        if lessons and lesson.id not in lessons:
            for step in lesson.steps:
                copy_files(lesson.start, workspace)
                copy_files(step.solution, workspace)
            continue
        for step in lesson.steps:
            begin = time.monotonic()
            language, problem = do_step(page, step, number, workspace)
            failures += problem is not None
            mark = "ok  " if problem is None else "FAIL"
            print(f"{mark} {language} {step.address} {time.monotonic() - begin:.1f} s", flush=True)
            if problem is not None:
                print(f"     {problem}", flush=True)
        change_language(page)
    return failures


def change_language(page: Page) -> None:
    """Show the page in its other language."""
    page.get_by_role("button", name=re.compile("^(中文|EN)$")).click()
    page.wait_for_function("() => window.linkwright?.panels.lesson.step", timeout=TIMEOUT_MS)


def do_step(page: Page, step: Step, number: int, workspace: Path) -> tuple[str, str | None]:
    """Do one step of a lesson, and return the language of its text and the problem, or None."""
    language = open_step(page, step, number)
    page.wait_for_function(_CHECKED, arg=step.address, timeout=TIMEOUT_MS)
    if page.evaluate(_PASSED):
        return language, "the step is green before it is done"
    copy_files(step.solution, workspace)
    answer = step.lesson.folder / "solution" / f"{step.id}.answer"
    if answer.is_file():
        page.locator(".lesson-answer").fill(answer.read_text(encoding="utf-8").strip())
        page.locator(".lesson-answer").press("Enter")
    deadline = time.monotonic() + TIMEOUT_MS / 1000
    while time.monotonic() < deadline:
        page.wait_for_timeout(200)
        page.wait_for_function(_CHECKED, arg=step.address, timeout=TIMEOUT_MS)
        if page.evaluate(_PASSED):
            return language, None
    return language, f"the step is not green: {page.evaluate(_MESSAGES)}"


def open_step(page: Page, step: Step, number: int) -> str:
    """Open a step from the list of steps, and return the language of its text.

    The function returns when the text is shown.
    """
    outline = page.locator(".course-outline")
    if not outline.is_visible():
        page.locator(".lesson-head button").click()
    outline.locator("section").nth(number).locator(".outline-step").nth(step.lesson.steps.index(step)).click()
    language: str = page.evaluate("() => document.documentElement.lang.slice(0, 2)")
    page.wait_for_function(_TITLE, arg=step.title.get(language), timeout=TIMEOUT_MS)
    return language


def copy_files(source: Path, workspace: Path) -> None:
    """Copy files into the workspace, if there are any."""
    if source.is_dir():
        shutil.copytree(source, workspace, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))


def main() -> int:
    """Walk through the named lessons, or through all lessons."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--course", default="robot")
    parser.add_argument("--lang", choices=("en", "zh"), default="en")
    parser.add_argument("lessons", nargs="*", metavar="LESSON")
    arguments = parser.parse_args()
    course = load_course(find_course(arguments.course))
    with TemporaryDirectory() as folder, sync_playwright() as playwright:
        workspace = Path(folder) / "ws"
        command = [sys.executable, "-m", "linkwright", "learn", "open", str(workspace), "--no-open"]
        environment = {**os.environ, "HOME": folder, "SHELL": "/bin/sh"}
        program = subprocess.Popen(
            [*command, "--course", str(course.folder)], stdout=subprocess.PIPE, text=True, env=environment
        )
        assert program.stdout is not None
        url = next(line.split()[1] for line in program.stdout if line.startswith("Viewer: "))
        browser = playwright.chromium.launch(
            executable_path=chromium.find_chromium() or chromium.fetch_chromium(), args=list(gallery.CHROMIUM_FLAGS)
        )
        page = browser.new_page(
            viewport={"width": 1440, "height": 900}, locale={"en": "en-US", "zh": "zh-CN"}[arguments.lang]
        )
        page.goto(url)
        failures = walk_course(page, course, arguments.lessons, workspace)
        browser.close()
        program.send_signal(signal.SIGINT)
        program.wait(timeout=30)
    print(f"{failures} steps are not as they should be", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
