"""Classes in C++ whose constructors make publishers, subscriptions, services and clients, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
HEADER = """template <typename T>
class Sender {
 public:
  Sender(rclcpp::Node * node, const std::string & topic, int depth = 10)
  : node_(node), depth_{depth} {
    publisher_ = node->create_publisher<T>("~/" + topic, depth);
  }
};
class Listener {
 public:
  explicit Listener(ros::NodeHandle & nh, std::string topic) : nh_(nh), topic_(std::move(topic)) {}
  void start() { subscriber_ = nh_.subscribe<std_msgs::Bool>(topic_, 1, &Listener::on, this); }
};
class Server {
 public:
  Server(std::shared_ptr<rclcpp::Node> node, const std::string & name);
};
class Changing {
 public:
  Changing(rclcpp::Node * node, std::string topic) {
    topic = prefix_ + topic;
    node->create_publisher<std_msgs::msg::Bool>(topic, 10);
  }
};
"""
CODE = """#include "arm/events.hpp"
Server::Server(std::shared_ptr<rclcpp::Node> node, const std::string & name)
    : server_(node->create_service<std_srvs::srv::Trigger>(name, f)) {
}
"""
SOURCE = """#include "arm/events.hpp"
class Arm : public rclcpp::Node {{
  Sender<std_msgs::msg::Int8> member_;
  ros::NodeHandle nh_{{"~"}};
  Arm() : Node("arm"), {} {{
    {}
  }}
}};
"""
FILES = {**MANIFEST, "arm/include/arm/events.hpp": HEADER, "arm/src/events.cpp": CODE}
PATH = "arm/src/arm.cpp"


def review_call(repository, compare, initializer, call):
    """Return the lines about a source that gets an initializer and a statement."""
    repository.commit({**FILES, PATH: SOURCE.format("a_(1)", "")})
    repository.write({PATH: SOURCE.format(initializer, call)})
    return sentences(subject(compare(repository), PATH))


@pytest.mark.parametrize(
    ("initializer", "call", "expected"),
    [
        ('member_(this, "left")', "", "publishers added: '~/left' (Int8)"),
        ("a_(1)", 's_ = std::make_unique<Sender<std_msgs::msg::Bool>>(this, "up", 5);',
         "publishers added: '~/up' (Bool)"),
        ("a_(1)", 's_ = new Sender<std_msgs::msg::Bool>(this, "up");', "publishers added: '~/up' (Bool)"),
        ("a_(1)", 'Listener listener(nh_, "goal");', "subscriptions added: '~goal' (Bool)"),
        ("a_(1)", 'list_.push_back(Server(node, "home"));', "services added: 'home' (Trigger)"),
    ],
)  # fmt: skip
def test_a_class_makes_the_name_that_its_caller_passes(repository, compare, initializer, call, expected):
    assert expected in review_call(repository, compare, initializer, call)


@pytest.mark.parametrize("call", ['Changing changing(this, "goal");', 'Other other(this, "goal");'])
def test_a_class_that_changes_the_name_or_is_unknown(repository, compare, call):
    assert not any("goal" in line for line in review_call(repository, compare, "a_(1)", call))


def test_an_unchanged_name_is_no_change(repository, compare):
    lines = review_call(repository, compare, "a_(1), b_(2)", "")
    assert not any("added:" in line for line in lines)


def test_a_class_whose_source_moves_into_a_subfolder_keeps_its_names(repository, compare):
    source = SOURCE.format("a_(1)", 'list_.push_back(Server(node, "home"));')
    repository.commit({**FILES, PATH: source})
    (repository.root / "arm/src/events.cpp").unlink()
    repository.write({"arm/src/server/events.cpp": CODE, PATH: source.replace("a_(1)", "a_(2)")})
    comparison = compare(repository)
    assert not breaking(comparison)
    assert not any("home" in line for line in sentences(subject(comparison, PATH)))


NAMED_NODE = """#include <rclcpp/rclcpp.hpp>
class Arm : public rclcpp::Node
{
public:
  explicit Arm(const std::string & name) : rclcpp::Node(name), rate_(10) { start(); }
};
int main(int argc, char ** argv)
{
  rclcpp::spin(std::make_shared<Arm>("arm"));
}
"""


def test_the_constructor_of_a_class_gets_the_name_of_the_node(repository, compare):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": NAMED_NODE})
    repository.write({"arm/src/arm.cpp": NAMED_NODE.replace('"arm"', '"gripper"')})
    assert breaking(compare(repository)) == ["node 'arm' renamed to 'gripper'"]
