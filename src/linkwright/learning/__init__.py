"""Courses of lessons whose steps are checked, and the interface for the checks of lessons."""

from linkwright.learning.checks.declaring import check
from linkwright.learning.checks.not_yet import NotYet, expect
from linkwright.learning.checks.robots import JointCheck, LinkCheck, RobotCheck, ShapeSpec
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
    "right",
    "wrong",
]
