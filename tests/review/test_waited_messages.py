"""Topics of which a source waits for one message."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

PATH = "arm/scripts/arm.py"
RCLPY = """from rclpy.node import Node
from rclpy.wait_for_message import wait_for_message


class Arm(Node):
    def start(self):
        {}
"""
ROSPY = "import rospy\n\n\ndef start():\n    {}\n"


@pytest.mark.parametrize(
    ("text", "old", "new"),
    [
        (RCLPY, "self.create_subscription(State, 'state', self.show, 1)", "wait_for_message(State, self, 'state')"),
        (ROSPY, "rospy.Subscriber('state', State, show)", "rospy.wait_for_message('state', State, timeout=3)"),
    ],
)
def test_waiting_for_a_message_is_a_subscription(repository, compare, text, old, new):
    repository.commit({PATH: text.format(old)})
    repository.commit({PATH: text.format(new)})
    assert breaking(compare(repository, "HEAD~..HEAD")) == []
    repository.commit({PATH: text.format(new.replace("'state'", "'status'"))})
    lines = sentences(subject(compare(repository, "HEAD~..HEAD"), PATH))
    assert "subscription 'state' (State) renamed to 'status' (State)" in lines
