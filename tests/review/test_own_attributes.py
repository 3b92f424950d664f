"""The lines of a review about attributes and methods that Python classes use of themselves without having them."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

SOURCE = """from rclpy.node import Node


class Arm(Node):
    def __init__(self):
        super().__init__("arm")
        self.speed = 1
        self._limit = 2

    def step(self):
        self.get_logger().info(str(self.speed))
        return self.halt() + self._limit

    def halt(self):
        return 0
"""
LOST = "uses its attribute 'speed', which is no longer defined"
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/arm/__init__.py": "",
    "arm/arm/base.py": "class Base:\n    def __init__(self, **rest):\n        self.count = len(rest)\n",
}


@pytest.mark.parametrize(
    ("edits", "expected"),
    [
        ([("self.speed =", "self.pace =")], [LOST]),
        ([("def halt", "def stop")], ["calls its method 'halt', which is no longer defined"]),
        ([("self._limit =", "self._bound =")], ["uses its attribute '_limit', which is no longer defined"]),
        ([("str(self.speed)", "str(self.sped)")], ["uses its attribute 'sped', which nothing defines"]),
        ([("self.halt()", "self.hold()")], ["calls its method 'hold', which nothing defines"]),
        ([("self.halt()", "self._clock")], []),
        ([("self.halt()", "self.create_timer()")], []),
        ([("self.speed = 1", 'setattr(self, "speed", 1)')], []),
        ([("self.speed = 1", "x = 1"), ("return self", 'hasattr(self, "speed")\n        return self')], []),
        ([("self.speed = 1", "x = 1"), ("    def step(self)", "    @staticmethod\n    def step(self)")], []),
        ([("self.speed = 1", "x = 1"), ("return self", "class A:\n            x = self.s\n        return self")],
         [LOST]),
        ([("self.speed = 1", "x = 1"), ("import Node", "import Node\nfrom a import B"), ("(Node)", "(Node, B)")], []),
        ([("self.speed = 1", "x = 1"), ("import Node", "import Node\nfrom .base import Base"), ("(Node)", "(Base)"),
          ("self.get_logger().info", "print"), ("self.halt()", "self.count")], [LOST]),
    ],
)  # fmt: skip
def test_an_attribute_that_nothing_defines_is_told(repository, compare, edits, expected):
    repository.commit({**FILES, "arm/arm/node.py": SOURCE})
    text = SOURCE
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    repository.write({"arm/arm/node.py": text})
    found = breaking(compare(repository))
    assert [sentence for sentence in found if "its " in sentence] == expected


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("left.py", "from .node import Arm\n\n\nclass Left(Arm):\n    speed = 3\n"),
        ("main.py", "from .node import Arm\n\narm = Arm()\narm.speed = 3\n"),
    ],
)
def test_an_attribute_that_another_source_gives_the_class_is_not_told(repository, compare, name, text):
    repository.commit({**FILES, "arm/arm/node.py": SOURCE, f"arm/arm/{name}": text})
    repository.write({"arm/arm/node.py": SOURCE.replace("self.speed = 1", "x = 1")})
    assert breaking(compare(repository)) == []


def test_a_base_class_that_sets_any_attribute_makes_all_of_them_uncertain(repository, compare):
    base = FILES["arm/arm/base.py"] + "        for name in rest:\n            setattr(self, name, 1)\n"
    source = SOURCE.replace("rclpy.node import Node", ".base import Base").replace("(Node)", "(Base)")
    repository.commit({**FILES, "arm/arm/base.py": base, "arm/arm/node.py": source})
    repository.write(
        {"arm/arm/node.py": source.replace('("arm")', '("arm", speed=1)').replace("self.speed = 1", "x = 1")}
    )
    assert breaking(compare(repository)) == []
