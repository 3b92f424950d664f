"""``linkwright learn new`` and ``test``: create courses, and test their lessons."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from linkwright.diagnostics import display_path, phrase
from linkwright.diagnostics.translation import localized


def configure_new(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn new``."""
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="the folder of the course to create")


def run_new(arguments: argparse.Namespace) -> int:
    """Create a course with one lesson."""
    from linkwright.learning.new_course import create_course

    for path in create_course(arguments.folder):
        print(display_path(path))
    return 0


def configure_test(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn test``."""
    parser.add_argument("course", metavar="COURSE", help="the folder of a course, or the name of a shipped one")
    parser.add_argument("lessons", metavar="LESSON", nargs="*", help="the lessons to test (default: all)")


def run_test(arguments: argparse.Namespace) -> int:
    """Test lessons, and return 1 if a test fails."""
    from linkwright.learning.checks.check_process import create_check_server
    from linkwright.learning.course import find_course, load_course
    from linkwright.learning.lesson_tests import test_lesson

    course = load_course(find_course(arguments.course))
    failures = count = 0
    with create_check_server() as server:
        for lesson in course.find_lessons(arguments.lessons):
            for result in test_lesson(course, lesson, server):
                count += 1
                failures += result.problem is not None
                print(f"{'ok  ' if result.problem is None else 'FAIL'} {result.lesson}/{result.title}", flush=True)
                if result.problem is not None:
                    print(f"     {localized(result.problem)}", flush=True)
    print(localized(phrase("{count} tests, {failures} failed", count=count, failures=failures)), file=sys.stderr)
    return 1 if failures else 0
