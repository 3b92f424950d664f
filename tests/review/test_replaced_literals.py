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
