"""Local names of methods of a node, such as ``declare = self.declare_parameter``, in a review."""

from __future__ import annotations

import pytest

FILE = """from rclpy.node import Node
from std_msgs.msg import String


class Lamp(Node):
    def __init__(self, other):
        super().__init__("lamp")
        declare = self.declare_parameter
        declare("color", "/red")
        read, publish = self.get_parameter, None
        make = self.create_publisher
        self.sender = make(String, "light", 10)
        {line}
"""


@pytest.mark.parametrize(
    ("line", "is_known"),
    [
        ('declare("hue", 5)', True),
        ('declare = print\n        declare("hue", 5)', False),
        ('[declare("hue", 5) for declare in other]', False),
        ('other("hue", 5)', False),
    ],
)
def test_parameter_that_a_local_name_of_the_method_declares(review_changes, line, is_known):
    changes, _ = review_changes("lamp.py", FILE, "{line}", line)
    assert any("parameter 'hue'" in text or "parameters added: 'hue'" in text for text in changes) == is_known, changes


def test_topic_that_a_local_name_of_the_method_publishes(review_changes):
    _, found = review_changes("lamp.py", FILE.replace("{line}", "pass"), '"light"', '"glow"')
    assert any("'light'" in text and "'glow'" in text for text in found), found


def test_name_of_another_method_stays(review_changes):
    old = FILE.replace("{line}", "say = self.print_parameter\n        say('hue', 5)")
    changes, _ = review_changes("lamp.py", old, "'hue'", "'shade'")
    assert not any("parameter" in text for text in changes if "print" not in text), changes
