"""The lines of a review about types of messages and services from another package."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

DEPENDENCIES = "<depend>old_msgs</depend><depend>new_msgs</depend></package>"
MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm").replace("</package>", DEPENDENCIES)}
RCLPY = """from rclpy.node import Node
from {0}_msgs.msg import State


class Arm(Node):
    def __init__(self):
        self.p = self.create_publisher(State, "state", 10)
"""
ROSPY_START = "import rospy\nimport old_msgs.srv\nimport new_msgs.srv as new_srv\n"
ROSPY = ROSPY_START + "rospy.Service('state', {0}.State, f)\n"
ROSPY_STAR = "import rospy\nfrom {0}_msgs.srv import *\nrospy.Service('state', State, f)\n"
RCLCPP = """#include <{0}_msgs/msg/state.hpp>
Arm::Arm() {{ p_ = create_publisher<{0}_msgs::msg::State>("state", 10); }}
"""
RCLCPP_ALIAS = """#include <{0}_msgs/msg/state.hpp>
using State = {0}_msgs::msg::State;
Arm::Arm() {{ p_ = create_publisher<State>("state", 10); }}
"""
ROSCPP = """#include <old_msgs/State.h>
#include <new_msgs/State.h>
int main() {{ ros::NodeHandle n; auto p = n.advertise<{0}_msgs::State>("state", 1); }}
"""
ROSCPP_SERVICE = """#include <{0}_msgs/State.h>
bool f({0}_msgs::State::Request & request, {0}_msgs::State::Response & response) {{ return true; }}
int main() {{ ros::NodeHandle n; auto s = n.advertiseService("state", f); }}
"""
ROSCPP_REQUEST = ROSCPP_SERVICE.replace("::Re", "Re")


@pytest.mark.parametrize(
    ("path", "text", "values"),
    [
        ("arm/arm/arm.py", RCLPY, ("old", "new")),
        ("arm/arm/arm.py", ROSPY, ("old_msgs.srv", "new_srv")),
        ("arm/arm/arm.py", ROSPY_STAR, ("old", "new")),
        ("arm/src/arm.cpp", RCLCPP, ("old", "new")),
        ("arm/src/arm.cpp", RCLCPP_ALIAS, ("old", "new")),
        ("arm/src/arm.cpp", ROSCPP, ("old", "new")),
        ("arm/src/arm.cpp", ROSCPP_SERVICE, ("old", "new")),
        ("arm/src/arm.cpp", ROSCPP_REQUEST, ("old", "new")),
    ],
)
def test_type_of_another_package_is_another_type(repository, compare, path, text, values):
    repository.commit({**MANIFEST, path: text.format(values[0])})
    repository.write({path: text.format(values[1])})
    result = compare(repository)
    assert [sentence.partition(": ")[2] for sentence in breaking(result)] == [
        "type old_msgs/State -> new_msgs/State",
    ]


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        # the same type by another name
        ("arm/arm/arm.py", RCLPY.format("old"),
         RCLPY.format("old").replace("import State", "import State as S").replace("(State", "(S")),
        ("arm/arm/arm.py", ROSPY.format("new_srv"), ROSPY_START.replace("as new_srv", "") +
         "rospy.Service('state', new_msgs.srv.State, f)\n"),
        ("arm/src/arm.cpp", RCLCPP.format("old"), RCLCPP_ALIAS.format("old")),
        ("arm/src/arm.cpp", ROSCPP_SERVICE.format("old"), ROSCPP_REQUEST.format("old")),
        # a name that may mean two types
        ("arm/arm/arm.py", RCLPY.format("old"), "try:\n    from old_msgs.msg import State\nexcept ImportError:\n"
         "    from new_msgs.msg import State\n" + RCLPY.format("new")),
        # not certainly a package
        ("arm/src/arm.cpp", ROSCPP.format("old"), ROSCPP.format("traits")),
    ],
)  # fmt: skip
def test_type_that_may_be_the_same_is_not_reported(repository, compare, path, old, new):
    repository.commit({**MANIFEST, path: old})
    repository.write({path: new})
    result = compare(repository)
    assert not [text for found in result.subjects for text in sentences(found) if "type" in text]
