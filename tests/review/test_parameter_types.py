"""Other types of parameters that the sources of their node declare, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

LAUNCH = """<launch>
  <node pkg="arm" exec="driver"><param name="speed" value="{value}"/></node>
</launch>
"""
SETTINGS = "driver:\n  ros__parameters:\n    speed: {value}\n"
SOURCE = """#include <rclcpp/rclcpp.hpp>
class Driver : public rclcpp::Node {{
public:
  Driver() : Node("driver") {{ {declaration}; }}
}};
"""
MODULE = """from rclpy.node import Node


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.declare_parameter("speed", 1.0)
"""
DECLARED = SOURCE.format(declaration='declare_parameter<double>("speed", 1)')


@pytest.mark.parametrize("path", ["arm/launch/arm.launch.xml", "arm/config/arm.yaml"])
@pytest.mark.parametrize(
    ("sources", "is_breaking"),
    [
        ({"arm/src/driver.cpp": DECLARED}, False),
        ({"arm/src/driver.cpp": SOURCE.format(declaration='declare_parameter("speed", 1.0f)')}, False),
        ({"arm/arm/driver.py": MODULE}, False),
        ({"arm/src/driver.cpp": SOURCE.format(declaration='declare_parameter("speed", 1)')}, True),
        (
            {"arm/src/driver.cpp": SOURCE.format(declaration='declare_parameter<std::vector<double>>("speed", {})')},
            True,
        ),
        ({"arm/src/driver.cpp": DECLARED, "arm/arm/other.py": MODULE.replace("1.0", "1")}, True),
        ({"arm/src/driver.cpp": SOURCE.format(declaration='declare_parameter("speed", speed_)')}, True),
        ({}, True),
    ],
)
def test_type_that_the_source_declares_was_the_only_one_that_worked(repository, compare, path, sources, is_breaking):
    text = LAUNCH if path.endswith(".xml") else SETTINGS
    package = PACKAGE_XML.replace("arm_description", "arm")
    repository.commit({"arm/package.xml": package, path: text.format(value="1"), **sources})
    repository.write({path: text.format(value="1.0")})
    assert bool(breaking(compare(repository))) == is_breaking


def test_type_of_a_parameter_of_another_node_counts_as_changed(repository, compare):
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/src/driver.cpp": DECLARED}
    settings = SETTINGS.replace("driver", "hand")
    repository.commit({"arm/config/arm.yaml": settings.format(value="1"), **files})
    repository.write({"arm/config/arm.yaml": settings.format(value="1.0")})
    assert len(breaking(compare(repository))) == 1
