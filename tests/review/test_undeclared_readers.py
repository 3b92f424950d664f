"""Sources that get a parameter of ROS 2 which no source declares any more, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

NODE = """#include <rclcpp/rclcpp.hpp>
class Planner : public rclcpp::Node {
public:
  Planner() : Node("planner") {
    declare_parameter("smooth", false);
  }
};
"""
PLUGIN = """#include <rclcpp/rclcpp.hpp>
void Star::initialize(rclcpp::Node * node) {{
  {}
}}
"""
READER = "'star.cpp' still gets 'smooth', which no source declares"
PATH = "arm/src/planner.cpp"


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        (
            'smooth_ = node->get_parameter("smooth").as_bool();',
            "'star.cpp' still gets 'smooth', which no source declares",
        ),
        (
            '// node->declare_parameter("smooth", true);\n  smooth_ = node->get_parameter("smooth").as_bool();',
            "'star.cpp' still gets 'smooth', which no source declares",
        ),
        ('node->declare_parameter("smooth", true);\n  smooth_ = node->get_parameter("smooth").as_bool();', None),
        ('load(node, "smooth", smooth_);', None),
        ('options.allow_undeclared_parameters(true);\n  smooth_ = node->get_parameter("smooth").as_bool();', None),
    ],
)
def test_a_parameter_that_another_source_only_gets_is_lost(repository, compare, code, reason):
    files = {"arm/package.xml": PACKAGE_XML, PATH: NODE, "arm/plugins/star.cpp": PLUGIN.format(code)}
    repository.commit(files)
    repository.write({PATH: NODE.replace('"smooth"', '"enable_optimizer"')})
    reasons = [str(change.reason) for change in subject(compare(repository), PATH).changes if change.reason is not None]
    assert reasons == ([] if reason is None else [reason])
