"""A field of a received message that counts with the opposite sign is breaking in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

PYTHON = """class Drive(Node):
    def __init__(self):
        super().__init__('drive')
        self.create_subscription(Twist, 'cmd_vel', self.on_twist, 10)

    def on_twist(self, msg):
        {}

    def reset(self, state):
        self.send(state.speed)
"""
CPP = """Drive::Drive() : Node("drive") {{
  sub_ = create_subscription<Twist>("cmd_vel", 10, std::bind(&Drive::on_twist, this, _1));
}}
void Drive::on_twist(const Twist::SharedPtr msg) {{
  {}
}}
"""


@pytest.mark.parametrize(
    ("text", "old", "new", "is_breaking"),
    [
        (PYTHON, "self.send(clamp(msg.linear.y))", "self.send(clamp(-msg.linear.y))", True),
        (PYTHON, "self.speed = -msg.linear.y", "self.speed = msg.linear.y", True),
        (PYTHON, "self.send(msg.linear.y)", "self.send(-msg.linear.x)", False),
        (PYTHON, "self.send(offset)", "self.send(-offset)", False),
        (CPP, "send(clamp(msg->linear.y));", "send(clamp(-msg->linear.y));", True),
        (CPP, "speed_ = msg->linear.y;", "speed_ = -msg->linear.y;", True),
        (CPP, "speed_ = 2 - msg->linear.y;", "speed_ = 2 + msg->linear.y;", False),
    ],
)
def test_opposite_sign_of_a_field_in_a_callback(repository, compare, text, old, new, is_breaking):
    path = "arm/arm/drive.py" if text is PYTHON else "arm/src/drive.cpp"
    manifest = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    repository.commit({**manifest, path: text.format(old)})
    repository.write({path: text.format(new)})
    result = compare(repository)
    assert bool(breaking(result)) is is_breaking
    reasons = [str(change.reason) for _, change in result.breaking_changes]
    assert reasons == ["the same messages of 'cmd_vel' mean the opposite now"] * is_breaking


def test_opposite_sign_in_another_function_is_not_breaking(repository, compare):
    text = PYTHON.format("self.stop()")
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/arm/drive.py": text})
    repository.write({"arm/arm/drive.py": text.replace("state.speed", "-state.speed")})
    assert not breaking(compare(repository))
