"""The lines of a review about Python sources that use fields which an interface does not have."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

PATH = "arm/scripts/drive.py"
FILES = {
    "arm_msgs/package.xml": PACKAGE_XML.replace("arm_description", "arm_msgs"),
    "arm_msgs/msg/State.msg": "int32 LIMIT = 5\nint32 speed\n",
    "arm_msgs/srv/Home.srv": "int32 count\n---\nbool done\n",
    "arm_msgs/msg/Reading.msg": "std_msgs/Header header\nstd_msgs/Header[] others\ngeometry_msgs/Pose pose\n",
    "arm_msgs/action/Move.action": "float64 goal_x\n---\nbool done\n---\nfloat64 rest\n",
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
}
HEAD = """from arm_msgs.action import Move
from arm_msgs.msg import Reading, State
from arm_msgs.srv import Home, HomeRequest


"""


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("state = State()\n    state.force = 1", ["uses 'force', which 'arm_msgs/State' does not have"]),
        ("state = State(force=1)", ["uses 'force', which 'arm_msgs/State' does not have"]),
        ("goal = Move.Goal()\n    goal.goal_y = 1.0", ["uses 'goal goal_y', which 'arm_msgs/Move' does not have"]),
        ("request = HomeRequest()\n    request.done = 1", ["uses 'request done', which 'arm_msgs/Home' does not have"]),
        ("request = Home.Request()\n    request.count = 1", []),
        (
            "item = Reading()\n    item.header.timestamp = 1\n    item.pose.position.x = 1.0",
            ["uses 'timestamp', which 'std_msgs/Header' does not have"],
        ),
        (
            "item = Reading()\n    item.header.stamp = 1\n    item.others.append(1)\n    item.pose.position.x = 1.0",
            [],
        ),
        ("import rospy\n    item = Reading()\n    item.header.seq = 1", []),
        ("state = State()\n    state.speed = state.LIMIT\n    print(state.get_fields_and_field_types(), state._x)", []),
        ("state = State()\n    if hasattr(state, 'force'):\n        state.force = 1", []),
        ("state = State()\n    state = drive()\n    state.force = 1", []),  # another object
        ("state = State()\n    try:\n        state.force = 1\n    except AttributeError:\n        pass", []),
        (
            "state = State()\n    try:\n        load(1)\n    except AttributeError:\n        pass\n    state.force = 1",
            ["uses 'force', which 'arm_msgs/State' does not have"],
        ),
        ("state = State()\n    state.force = 1\n\n\ntry:\n    drive()\nexcept AttributeError:\n    pass", []),
    ],
)
def test_a_new_use_of_a_field_that_the_type_does_not_have_is_breaking(repository, compare, line, expected):
    text = f"{HEAD}def drive():\n    {{}}\n"
    repository.commit({**FILES, PATH: text.format("pass")})
    repository.write({PATH: text.format(line)})
    assert breaking(compare(repository)) == expected


def test_a_use_that_failed_before_is_not_told(repository, compare):
    text = f"{HEAD}def drive():\n    state = State()\n    state.force = 1\n"
    repository.commit({**FILES, PATH: text})
    repository.write({PATH: f"{text}    state.speed = 2\n"})
    assert breaking(compare(repository)) == []


def test_a_use_of_a_lost_field_has_one_line(repository, compare):
    text = f"{HEAD}def drive():\n    state = State()\n    state.speed = 1\n"
    repository.commit({**FILES, PATH: text})
    repository.write({PATH: f"{text}    state.LIMIT\n", "arm_msgs/msg/State.msg": "int32 LIMIT = 5\nint32 force\n"})
    lines = [line for line in breaking(compare(repository)) if line.startswith("uses")]
    assert lines == ["uses 'speed', which 'arm_msgs/State' no longer has"]


def test_a_field_that_the_interface_and_the_source_get_together_is_no_missing_one(repository, compare):
    text = f"{HEAD}def drive():\n    state = State()\n    state.speed = 1\n"
    repository.commit({**FILES, PATH: text})
    state = "int32 LIMIT = 5\nint32 speed\nint32 force\n"
    repository.write({PATH: f"{text}    state.force = 2\n", "arm_msgs/msg/State.msg": state})
    assert not any(line.startswith("uses") for line in breaking(compare(repository)))


CALLBACK = """import {library}
from geometry_msgs.msg import Point
from std_srvs.srv import SetBool


class Drive:
    def __init__(self):
        self.create_subscription(Point, "place", self.take, 10)
        self.create_service(SetBool, "lamp", self.switch)

    def take(self, place):
        {taken}

    def switch(self, request, response):
        {switched}
"""


@pytest.mark.parametrize(
    ("library", "taken", "switched", "expected"),
    [
        ("rclpy", "print(place.theta)", "pass", ["uses 'theta', which 'geometry_msgs/Point' does not have"]),
        ("rclpy", "pass", "response.data = request.data",
         ["uses 'response data', which 'std_srvs/SetBool' does not have"]),
        ("rclpy", "print(place.z)", "response.success = request.data", []),
        ("rospy", "print(place.theta)", "pass", []),
    ],
)  # fmt: skip
def test_a_new_use_of_a_field_that_a_common_type_does_not_have_is_breaking(
    repository, compare, library, taken, switched, expected
):
    repository.commit({**FILES, PATH: CALLBACK.format(library=library, taken="pass", switched="pass")})
    repository.write({PATH: CALLBACK.format(library=library, taken=taken, switched=switched)})
    assert breaking(compare(repository)) == expected
