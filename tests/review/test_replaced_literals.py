"""The variables that get a parameter with another default instead of a literal."""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences, subject

NODE = "class Arm(Node):\n    def __init__(self):\n        super().__init__('arm')\n{}"


def find_replaced(repository, compare, old: str, new: str) -> list[str]:
    for content, write in ((old, repository.commit), (new, repository.write)):
        lines = "".join(f"        {line}\n" for line in content.splitlines())
        write({"arm/arm.py": NODE.format(lines)})
    return sentences(subject(compare(repository), "arm/arm.py"))


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("self.goal.z = 1.0", "self.goal.z = rospy.get_param('~z', 0.0)",
         "self.goal.z gets the parameter '~z' now: by default, 1.0 -> 0.0"),
        ("self.z = 1.0", "self.declare_parameter('z', 2.0)\nself.z = float(self.get_parameter('z').value)",
         "self.z gets the parameter 'z' now: by default, 1.0 -> 2.0"),
        ("self.on = True", "self.on = self.declare_parameter('on', False).get_parameter_value().bool_value",
         "self.on gets the parameter 'on' now: by default, True -> False"),
        ("self.z = 1.0", "self.z = rospy.get_param('~z', 1)", None),
        ("self.z = 1.0", "self.z = rospy.get_param('~z')", None),
        ("self.z = 1.0\nself.z = 2.0", "self.z = rospy.get_param('~z', 3.0)", None),
        ("self.z = 1.0", "self.z = limit(rospy.get_param('~z', 3.0))", None),
    ],
)  # fmt: skip
def test_literal_that_a_parameter_replaces(repository, compare, old, new, expected):
    found = find_replaced(repository, compare, old, new)
    assert [line for line in found if "by default" in line] == ([] if expected is None else [expected])
    assert not any(line.startswith("values in") for line in found) or expected is None


@pytest.mark.parametrize(
    ("old", "new", "end"),
    [
        ("rospy.sleep(30.)", "rospy.sleep(rospy.get_param('/delay'))", "30.0 in 'Arm.__init__()'"),
        ("rospy.sleep(30.)", "rospy.sleep(rospy.get_param('/delay', 9))", "30.0 in 'Arm.__init__()': 9 by default"),
        ("rospy.sleep(30.)", "rospy.sleep(rospy.get_param('/delay', 30))", None),
        ("rospy.sleep(delay)", "rospy.sleep(rospy.get_param('/delay'))", None),
        ("rospy.sleep(3)\nrospy.sleep(4)", "rospy.sleep(rospy.get_param('/delay'))\nrospy.sleep(4)", None),
    ],
)
def test_literal_argument_that_a_parameter_replaces(repository, compare, old, new, end):
    found = [line for line in find_replaced(repository, compare, old, new) if "replaces" in line]
    assert found == ([] if end is None else [f"parameter '/delay' replaces {end}"])


CPP = """void Arm::configure() {{
  {}
  start();
}}
void Arm::step() {{
  {}
}}
"""


@pytest.mark.parametrize(
    ("read", "old", "new", "expected"),
    [
        ('nh_.param("rate", rate_, 20);', "ros::Rate rate(50);", "const ros::Rate rate(rate_);",
         ["parameter 'rate' replaces 50 in 'Arm::step()': 20 by default"]),
        ('nh_.getParam(ns_ + "gain", gain_);', "send(x * -0.5);", "send(x * this->gain_);",
         ["parameter 'gain' replaces -0.5 in 'Arm::step()'"]),
        ('rate_ = declare_parameter("rate", 50.0);', "sleep(50);", "sleep(rate_);", []),  # the same value
        ('nh_.param("rate", rate_, 20);', "sleep(50);", "sleep(50); sleep(rate_);", []),  # the old statement is kept
        ('nh_.param("rate", rate_, 20);', "sleep(50); wait(50);", "sleep(rate_);",
         ["parameter 'rate' replaces 50 in 'Arm::step()': 20 by default"]),
        ('nh_.param("rate", rate_, 20);', "sleep(50);", "sleep(2 * rate_);", []),
        ('nh_.param("rate", rate_, 20);', "sleep(50);", "sleep(period_);", []),
    ],
)  # fmt: skip
def test_literal_that_a_parameter_replaces_in_cpp(repository, compare, read, old, new, expected):
    repository.commit({"arm/arm.cpp": CPP.format("", old)})
    repository.write({"arm/arm.cpp": CPP.format(read, new)})
    found = sentences(subject(compare(repository), "arm/arm.cpp"))
    assert [line for line in found if "replaces" in line] == expected


HEADER = "class Arm {{\n  {}\n}};\n"


@pytest.mark.parametrize(
    ("member", "more", "expected"),
    [
        ("double limit_ = 3.0;", "", ["'limit_' (3.0) replaces 2.5 in 'Arm::step()'"]),
        ("double limit_{2.50};", "", []),
        ("double limit_ = 3.0;", "limit_ = find_limit();", []),
        ("double limit_;", "", []),
    ],
)
def test_literal_that_a_member_replaces_in_cpp(repository, compare, member, more, expected):
    source = '#include "arm.hpp"\n' + CPP
    repository.commit({"arm/arm.hpp": HEADER.format(""), "arm/arm.cpp": source.format("", "send(2.5);")})
    repository.write({"arm/arm.hpp": HEADER.format(member), "arm/arm.cpp": source.format(more, "send(limit_);")})
    found = sentences(subject(compare(repository), "arm/arm.cpp"))
    assert [line for line in found if "replaces" in line] == expected
