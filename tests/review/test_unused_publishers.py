"""Publishers with which a source never published a message, or no longer publishes one."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

NODE = """import rclpy
from arm.base import Base
from std_msgs.msg import Float64


class Arm(Base):
    def __init__(self):
        super().__init__("arm")
        self.stop = self.create_publisher(Float64, "stop", 1)
        self.speed = self.create_publisher(Float64, "speed", 1)
        self.speed.publish(1)
"""
LINE = '        self.stop = self.create_publisher(Float64, "stop", 1)\n'
BASE = "from rclpy.node import Node\n\n\nclass Base(Node):\n    def halt(self):\n        self.NAME.publish(0)\n"
CPP = """#include <rclcpp/rclcpp.hpp>
class Arm : public rclcpp::Node {
 public:
  Arm() : Node("arm") {
    // the stop
    stop_ = create_publisher<std_msgs::msg::Float64>("stop", 1);
  }
  /* The arm
     has a member. */
  rclcpp::Publisher<std_msgs::msg::Float64>::SharedPtr stop_;
};
"""
CALL = 'stop_ = create_publisher<std_msgs::msg::Float64>("stop", 1);'
UNUSED = "publishers that published nothing removed: 'stop' (Float64)"
LOST = "publishers removed: 'stop' (Float64)"


@pytest.mark.parametrize(
    ("path", "old", "new", "others", "sentence"),
    [
        ("arm/arm.py", NODE, NODE.replace(LINE, ""), {"arm/base.py": BASE.replace("NAME", "other")}, UNUSED),
        ("arm/arm.py", NODE, NODE.replace(LINE, ""), {"arm/base.py": BASE.replace("NAME", "stop")}, LOST),
        ("arm/arm.py", NODE + "        self.stop.publish(0)\n", NODE.replace(LINE, ""), {}, LOST),
        ("arm/arm.py", NODE + "        getattr(self, name).publish(0)\n", NODE.replace(LINE, ""), {}, LOST),
        ("src/arm.cpp", CPP, CPP.replace(CALL, ""), {}, UNUSED),
        ("src/arm.cpp", CPP, CPP.replace(CALL, ""),
         {"src/tool.cpp": "void halt(Arm& arm) { arm.stop_->publish(Float64()); }\n"}, LOST),
    ],
)  # fmt: skip
def test_a_publisher_that_no_code_uses_breaks_nothing(repository, compare, path, old, new, others, sentence):
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    repository.commit({"arm/package.xml": manifest, f"arm/{path}": old, **{f"arm/{p}": t for p, t in others.items()}})
    repository.write({f"arm/{path}": new})
    result = compare(repository)
    assert sentence in sentences(subject(result, f"arm/{path}"))
    assert (sentence in breaking(result)) == (sentence == LOST)


SENDING = CPP.replace(CALL, CALL + "\n    stop_->publish(std_msgs::msg::Float64());")
SILENT = "nothing is published with the publisher 'stop' any more"


@pytest.mark.parametrize(
    ("path", "old", "new", "others", "is_told", "is_breaking"),
    [
        ("arm/arm.py", NODE + "        self.stop.publish(0)\n", NODE, {}, True, True),
        ("arm/arm.py", NODE + "        self.stop.publish(0)\n", NODE + "        # self.stop.publish(0)\n", {},
         True, True),
        ("src/arm.cpp", SENDING, CPP, {}, True, True),
        # another source of the package publishes the topic, or uses the variable
        ("arm/arm.py", NODE + "        self.stop.publish(0)\n", NODE,
         {"arm/other.py": NODE.replace(LINE, "").replace('"speed"', '"stop"')}, True, False),
        ("src/arm.cpp", SENDING, CPP, {"src/tool.cpp": "void halt(Arm& arm) { arm.stop_->publish(Float64()); }\n"},
         False, False),
        # it is passed to a function, still publishes elsewhere, or never published
        ("arm/arm.py", NODE + "        self.stop.publish(0)\n", NODE + "        self.send(self.stop)\n", {},
         False, False),
        ("arm/arm.py", NODE + "        self.stop.publish(0)\n" * 2, NODE + "        self.stop.publish(0)\n", {},
         False, False),
        ("arm/arm.py", NODE, NODE.replace("self.speed.publish(1)", "self.speed.publish(2)"), {}, False, False),
    ],
)  # fmt: skip
def test_a_publisher_that_no_longer_publishes_is_breaking(
    repository, compare, path, old, new, others, is_told, is_breaking
):
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    repository.commit({"arm/package.xml": manifest, f"arm/{path}": old, **{f"arm/{p}": t for p, t in others.items()}})
    repository.write({f"arm/{path}": new})
    result = compare(repository)
    told = [line for found in result.subjects for line in sentences(found)]
    assert (SILENT in told) == is_told
    assert (SILENT in breaking(result)) == is_breaking
