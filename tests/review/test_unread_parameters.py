"""Removed parameters that a source only declared, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

CPP = """#include <rclcpp/rclcpp.hpp>
class Filter : public rclcpp::Node {
public:
  Filter() : Node("filter") {
    // Parameters
    DECLARATION
    this->declare_parameter<double>("rate", 1.0);
    rate_ = get_parameter("rate").as_double();
  }
  double rate_;
};
"""
PYTHON = """from rclpy.node import Node


class Filter(Node):
    def __init__(self):
        super().__init__("filter")
        DECLARATION
        self.rate = self.declare_parameter("rate", 1.0).value
"""
CMAKE = """project(arm)
find_package(ament_cmake REQUIRED)
add_executable(filter src/filter.cpp)
add_executable(other src/other.cpp)
install(TARGETS filter other DESTINATION lib/${PROJECT_NAME})
"""
DECLARED = 'this->declare_parameter<std::string>("frame", "odom");'


@pytest.mark.parametrize(
    ("path", "declaration", "other", "is_breaking"),
    [
        ("arm/src/filter.cpp", DECLARED, "", False),
        ("arm/src/filter.cpp", DECLARED, 'auto frame = node->get_parameter("frame");', False),
        ("arm/src/filter.cpp", f'{DECLARED} frame_ = get_parameter("frame").as_string();', "", True),
        ("arm/src/filter.cpp", 'frame_ = declare_parameter("frame", "odom");', "", True),
        ("arm/src/filter.cpp", f'{DECLARED} values_ = get_parameters_by_prefix("");', "", True),
        ("arm/arm/filter.py", 'self.declare_parameter("frame", "odom")', "", False),
        ("arm/arm/filter.py", 'self.frame = self.declare_parameter("frame", "odom").value', "", True),
        ("arm/arm/filter.py", 'self.frame = (\\n            self.declare_parameter("frame", "odom").value)', "", True),
    ],
)
def test_parameter_that_nothing_read_has_no_effect_to_lose(repository, compare, path, declaration, other, is_breaking):
    text = PYTHON if path.endswith(".py") else CPP
    files = {
        "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
        "arm/CMakeLists.txt": CMAKE,
        f"{path.rpartition('/')[0]}/other{path[path.rindex('.') :]}": other,
    }
    repository.commit({path: text.replace("DECLARATION", declaration.replace("\\n", "\n")), **files})
    comment = "pass" if path.endswith(".py") else ""
    repository.write({path: text.replace("DECLARATION", comment)})
    found = [line for line in breaking(compare(repository)) if line.startswith("parameters removed: 'frame'")]
    assert bool(found) == is_breaking


def test_parameter_that_nothing_read_is_not_renamed(repository, compare):
    path = "arm/src/filter.cpp"
    new = 'declare_parameter<std::string>("frame_id", "base"); frame_ = get_parameter("frame_id").as_string();'
    package = PACKAGE_XML.replace("arm_description", "arm")
    repository.commit({path: CPP.replace("DECLARATION", DECLARED), "arm/package.xml": package})
    repository.write({path: CPP.replace("DECLARATION", new)})
    lines = sentences(subject(compare(repository), path))
    assert """parameters removed: 'frame' ("odom")""" in lines
