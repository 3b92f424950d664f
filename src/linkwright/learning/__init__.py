"""Courses of lessons whose steps are checked, and the interface for the checks of lessons.

The names below are for `checks.py` and `cases.py` of lessons. Each is loaded when it is first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.loading.deferred import deferred

if TYPE_CHECKING:
    from linkwright.learning.checks.declarations import check
    from linkwright.learning.checks.not_yet import NotYet, expect
    from linkwright.learning.checks.robots import JointCheck, LinkCheck, RobotCheck, ShapeSpec
    from linkwright.learning.checks.silence import expect_published
    from linkwright.learning.checks.work import Work
    from linkwright.learning.lesson_tests import Edit, right, wrong
    from linkwright.learning.local_text import LocalText

__all__ = [
    "Edit",
    "JointCheck",
    "LinkCheck",
    "LocalText",
    "NotYet",
    "RobotCheck",
    "ShapeSpec",
    "Work",
    "check",
    "expect",
    "expect_published",
    "right",
    "wrong",
]

__getattr__ = deferred(
    __name__,
    {
        "checks.declarations": ("check",),
        "checks.not_yet": ("NotYet", "expect"),
        "checks.silence": ("expect_published",),
        "checks.robots": ("JointCheck", "LinkCheck", "RobotCheck", "ShapeSpec"),
        "checks.work": ("Work",),
        "lesson_tests": ("Edit", "right", "wrong"),
        "local_text": ("LocalText",),
    },
)
