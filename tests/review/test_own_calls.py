"""The lines of a review about Python modules that call their own functions and methods with the old arguments."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

MODULE = """import math


def scale(value, factor):
    return value * 2


class Arm:
    def _move(self, x, y):
        return math.hypot(x, y)

    def home(self):
        return self._move(0, 0)


def main():
    Arm().home()
    return scale(3, 4)
"""
OLD_SCALE = "calls 'scale' of 'arm/arm/node.py' with the old arguments; the new ones are (value)"
OLD_MOVE = "calls 'Arm._move' of 'arm/arm/node.py' with the old arguments; the new ones are (x, y, z)"
SCALE = ("def scale(value, factor)", "def scale(value)")
MOVE = ("_move(self, x, y)", "_move(self, x, y, z)")


@pytest.fixture
def review_module(repository, compare):
    """Review replacements in the module, and return the breaking lines about calls."""

    def run(*replacements, old=MODULE, files=None):
        package = PACKAGE_XML.replace("arm_description", "arm")
        repository.commit({"arm/package.xml": package, "arm/arm/__init__.py": "", "arm/arm/node.py": old})
        text = old
        for replaced, new in replacements:
            assert replaced in text
            text = text.replace(replaced, new)
        repository.write({"arm/arm/node.py": text, **(files or {})})
        return [line for line in breaking(compare(repository)) if line.startswith("calls ")]

    return run


@pytest.mark.parametrize(
    ("replacements", "expected"),
    [
        ([SCALE], [OLD_SCALE]),
        ([MOVE], [OLD_MOVE]),
        ([SCALE, MOVE], [OLD_MOVE, OLD_SCALE]),
        ([("def scale(value, factor)", "def scale(value, factor=1)")], []),
        ([SCALE, ("scale(3, 4)", "scale(3)")], []),
        ([MOVE, ("_move(0, 0)", "_move(0, 0, 0)")], []),
        ([MOVE, ("_move(0, 0)", "_move(*items)")], []),
        ([SCALE, ("    return scale(3", "    scale = max\n    return scale(3")], []),
        ([SCALE, ("def main():", "def main(scale=max):")], []),
        ([SCALE, ("def scale", "@cached\ndef scale")], []),
        ([MOVE, ("    def _move", "    @cached\n    def _move")], []),
        ([MOVE, ("def home(self):", "def home(self):\n        self._move = math.hypot")], []),
        (
            [MOVE, ("def main", "class Leg(Arm):\n    def _move(self, x, y):\n        return x\n\n\ndef main():")],
            [],
        ),
        ([MOVE, ("def home(self)", "@staticmethod\n    def home(self)")], []),
    ],
)
def test_a_module_that_calls_itself_with_the_old_arguments_fails(review_module, replacements, expected):
    assert review_module(*replacements) == expected


def test_a_method_that_a_class_of_another_source_may_replace_is_not_told(review_module):
    other = "from arm.node import Arm\n\n\nclass Leg(Arm):\n    def _move(self, x, y):\n        return x\n"
    assert review_module(MOVE, files={"arm/arm/leg.py": other}) == []


def test_a_call_that_never_fitted_is_not_told(review_module):
    assert review_module(SCALE, old=MODULE.replace("scale(3, 4)", "scale(3, 4, 5)")) == []
