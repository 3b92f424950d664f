"""The lines of a review about parameters that a C++ source still reads but no longer uses."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
HEADER = "class Arm : public rclcpp::Node {\n  double rate_ = 10.0, gain_;\n  int depth_{3};\n};\n"
ROS1 = """int main(int argc, char ** argv) {{
  ros::NodeHandle n("~");
  int hz = 30;
  n.param("rate", hz, 30);
  ROS_INFO("rate %d", hz);
  {}
}}
"""
ROS2 = """#include "arm/arm.hpp"
Arm::Arm() : Node("arm"), depth_(3) {{
  declare_parameter("rate", rate_);
  get_parameter("rate", rate_);
  gain_ = declare_parameter("gain", 1.0);
  declare_parameter<double>("limit", {1});
  set_on_parameters([this](const rclcpp::Parameter & p) {{ rate_ = p.as_double(); }});
}}
void Arm::step() {{ send({0} * gain_); }}
"""
NOT_USED = "values that launch files and parameter files give to '{}' have no effect"


def review_texts(repository, compare, old, new, files=None):
    repository.commit({**MANIFEST, "arm/include/arm/arm.hpp": HEADER, "arm/src/arm.cpp": old, **(files or {})})
    repository.write({"arm/src/arm.cpp": new})
    return [change for found in compare(repository).subjects for change in found.changes]


@pytest.mark.parametrize(
    ("old", "new", "name"),
    [
        (ROS1.format("ros::Rate rate(hz);"), ROS1.format("ros::spin();"), "~rate"),
        (ROS2.format("rate_", "0.0"), ROS2.format("2.0", "0.0"), "rate"),
    ],
)
def test_a_parameter_that_nothing_uses_any_more_is_breaking(repository, compare, old, new, name):
    changes = review_texts(repository, compare, old, new)
    found = {str(change.sentence): str(change.reason) for change in changes if change.reason}
    assert found == {f"parameter '{name}' is no longer used": NOT_USED.format(name)}


@pytest.mark.parametrize(
    ("old", "new", "files"),
    [
        (ROS1.format("ros::Rate rate(hz);"), ROS1.format("run(&hz);"), {}),
        (ROS1.format("ros::spin();"), ROS1.format("wait();"), {}),  # it was not used before either
        (ROS2.format("rate_", "0.0"), ROS2.format("2.0", "rate_"), {}),  # the default of another parameter
        (ROS2.format("rate_", "0.0"), ROS2.format("2.0", "0.0"), {"arm/src/run.cpp": "int Arm::run() { f(rate_); }\n"}),
    ],
)  # fmt: skip
def test_a_parameter_that_is_still_used_is_not_told(repository, compare, old, new, files):
    lines = [str(change.sentence) for change in review_texts(repository, compare, old, new, files)]
    assert lines
    assert not any("no longer used" in line for line in lines)


@pytest.mark.parametrize(
    ("code", "is_breaking"),
    [
        ('double rate{}; nh.param<double>("/rate", rate, 100);', False),
        ('auto rate = node->declare_parameter("rate", 1.0); RCLCPP_INFO(log, "rate %f", rate);', False),
        ('double rate; if (!nh.getParam("rate", rate)) return 1;', True),
        ('double rate; nh.getParam("rate", rate); ros::Rate loop(rate);', True),
        ('nh.getParam("rate", speed_);', True),
    ],
)
def test_a_removed_parameter_that_nothing_used_breaks_nothing(repository, compare, code, is_breaking):
    program = "int main(int argc, char ** argv) {{\n  ros::NodeHandle nh;\n  {}\n  ros::spin();\n}}\n"
    changes = review_texts(repository, compare, program.format(code), program.format(""))
    assert [change.reason is not None for change in changes if "parameter" in str(change.sentence)] == [is_breaking]
