"""The lines of a review about topics whose names functions of C++ sources return."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

SOURCE = """#include "arm/node.hpp"
std::string Node::prefix() { return "arm"; }
std::string Node::state_topic() const {
  return prefix() + "/state";
}
const char * help_topic() { return std::string("help"); }
std::string Node::load_topic() { if (big_) { return "big"; } return "load"; }
Node::Node(rclcpp::Node::SharedPtr node) {
  state_ = node->create_publisher<std_msgs::msg::String>(state_topic(), 10);
  help_ = node->create_publisher<std_msgs::msg::String>(Node::help_topic(), 10);
  load_ = node->create_publisher<std_msgs::msg::String>(load_topic(), 10);
}
"""
HEADER = """#pragma once
class Node {
 public:
  static std::string own_topic() { return std::string("own"); }
  std::string state_topic() const;
};
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('"/state"', '"/status"', ["publisher 'arm/state' (String) renamed to 'arm/status' (String)"]),
        ('{ return "arm"; }', '{ return "leg"; }', ["publisher 'arm/state' (String) renamed to 'leg/state' (String)"]),
        ("(state_topic(), 10)", '("arm/state", 10)', []),
        ("(state_topic(), 10)", "(own_topic(), 10)", ["publisher 'arm/state' (String) renamed to 'own' (String)"]),
        ("(load_topic(), 10)", "(big_topic(), 10)", []),
        ("(state_topic(), 10)", '(ros::names::resolve("arm") + "/state", 10)', []),
    ],
)
def test_a_function_that_only_returns_a_text_gives_the_name(repository, compare, old, new, expected):
    assert old in SOURCE
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/include/arm/node.hpp": HEADER}
    repository.commit({**files, "arm/src/node.cpp": SOURCE})
    repository.write({"arm/src/node.cpp": SOURCE.replace(old, new)})
    result = compare(repository)
    lines = [line for subject in result.subjects for line in sentences(subject) if line.startswith("publisher '")]
    assert lines == breaking(result) == expected
