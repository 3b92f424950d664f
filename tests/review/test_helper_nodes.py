"""Nodes in C++ beside the node of a source, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences

SOURCE = """#include <rclcpp/rclcpp.hpp>
class Goal : public rclcpp::Node {
 public:
  Goal() : Node("goal") {
    helper_ = std::make_shared<rclcpp::Node>("NAME");
    USE
    publisher_ = create_publisher<std_msgs::msg::String>("state", 1);
  }
};
"""
CLIENT = (
    'client_ = rclcpp_action::create_client<Move>(helper_, "move"); rclcpp::spin_until_future_complete(helper_, f);'
)


@pytest.mark.parametrize(
    ("use", "is_breaking"),
    [
        (CLIENT, False),
        ('RCLCPP_INFO(helper_->get_logger(), "moved");', False),
        ('out_ = helper_->create_publisher<std_msgs::msg::String>("out", 1);', True),
        ("broadcaster_ = std::make_unique<tf2_ros::TransformBroadcaster>(helper_);", True),
        ('helper_->declare_parameter("rate", 5);', True),
    ],
)
def test_name_of_a_node_that_offers_nothing_is_not_breaking(package, compare, use, is_breaking):
    path = "arm_description/src/goal.cpp"
    text = SOURCE.replace("USE", use)
    package.commit({path: text.replace("NAME", "client_node")})
    package.write({path: text.replace("NAME", "client_node_of_goal")})
    result = compare(package)
    renamed = [sentence for found in result.subjects for sentence in sentences(found) if "client_node" in sentence]
    assert renamed
    assert bool(breaking(result)) is is_breaking
