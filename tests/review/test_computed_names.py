"""The lines of a review about topics and services whose names are expressions."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PATH = "arm/arm/arm.py"
CPP_PATH = "arm/src/arm.cpp"
ROSPY = """import rospy
from std_msgs.msg import Int32, String


class Arm:
    def __init__(self):
        self.a = rospy.get_param("~a", "state")
        self.b = rospy.get_param("~b", "status")
        self.c = compute()
        {}

    def stop(self, message):
        pass
"""
SUBSCRIPTION = "self.s = rospy.Subscriber(self.a, String, self.stop)"
RCLPY = """from rclpy.node import Node


class Arm(Node):
    def __init__(self):
        self.a = self.declare_parameter("a", "state").value
        self.b = self.declare_parameter("b", "status").value
        self.create_subscription(String, self.a, self.stop, 10)
"""
CPP = """#include <ros/ros.h>
Arm::Arm(ros::NodeHandle & n) {
  name_ = compute();
  client_ = n.serviceClient<arm_msgs::Move>(name_);
}
"""


@pytest.mark.parametrize(
    ("line", "name"),
    [
        (SUBSCRIPTION, "self.a"),
        ("self.s = rospy.Subscriber(self.c, String, self.stop, 1)", "self.c"),
        ("from rospy import Subscriber as S, Subscriber; Subscriber(self.c, String, self.stop)", "self.c"),
    ],
)
def test_computed_topic_of_rospy_is_not_its_callback(repository, compare, line, name):
    repository.commit({**MANIFEST, PATH: ROSPY.format(line)})
    repository.write({PATH: ROSPY.format("pass")})
    (found,) = compare(repository).subjects
    assert sentences(found)[0] == f"subscriptions with computed names removed: '{name}' (String)"


@pytest.mark.parametrize(
    ("path", "old", "new", "expected", "reason"),
    [
        (PATH, ROSPY.format(SUBSCRIPTION), ROSPY.format(SUBSCRIPTION.replace("String", "Int32")),
         "subscription 'state': type String -> Int32", "programs that use 'state' with the old type get nothing"),
        (PATH, ROSPY.format(SUBSCRIPTION.replace("self.a", "self.c")),
         ROSPY.format(SUBSCRIPTION.replace("self.a", "self.c").replace("String", "Int32")),
         "subscription 'self.c': type String -> Int32", "programs that use the name with the old type get nothing"),
        (CPP_PATH, CPP, CPP.replace("Move", "Stop"),
         "service client 'name_': type Move -> Stop", "servers with the old type do not answer"),
        (CPP_PATH, CPP.replace("(name_)", '("move")'), CPP.replace("(name_)", '("move")').replace("Move", "Stop"),
         "service client 'move': type Move -> Stop", "servers of 'move' with the old type do not answer"),
        (PATH, ROSPY.format(SUBSCRIPTION), ROSPY.format(SUBSCRIPTION.replace("self.a", "self.b")),
         "subscription 'state' (String) renamed to 'status' (String)",
         "by default, programs that use the name 'state' do not find it"),
        (PATH, RCLPY, RCLPY.replace("String, self.a", "String, self.b"),
         "subscription 'state' (String) renamed to 'status' (String)",
         "by default, programs that use the name 'state' do not find it"),
    ],
)  # fmt: skip
def test_computed_names_are_compared(repository, compare, path, old, new, expected, reason):
    repository.commit({**MANIFEST, path: old})
    repository.write({path: new})
    result = compare(repository)
    assert breaking(result) == [expected]
    (found,) = result.subjects
    assert [str(change.reason) for change in found.changes if change.reason] == [reason]


def test_another_name_for_the_same_parameter_is_no_other_topic(repository, compare):
    repository.commit({**MANIFEST, PATH: RCLPY})
    repository.write({PATH: RCLPY.replace("self.a", "self.topic")})
    assert not breaking(compare(repository))


def test_default_of_a_parameter_that_a_launch_file_sets_is_not_lost(repository, compare):
    launch = '<launch>\n  <node pkg="arm" exec="arm">\n    <param name="b" value="state"/>\n  </node>\n</launch>\n'
    repository.commit({**MANIFEST, PATH: RCLPY, "arm/launch/arm.launch.xml": launch})
    repository.write({PATH: RCLPY.replace("String, self.a", "String, self.b")})
    assert not breaking(compare(repository))


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        ("ArmNode.__init__(self)", "nodes added: 'steps'"),
        ("Node.__init__(self, 'arm')", "nodes added: 'arm', 'steps'"),
    ],
)
def test_instance_is_no_name_of_a_node(repository, compare, call, expected):
    text = "import rospy\nclass Steps(ArmNode):\n  def __init__(self):\n    {}\n    rospy.init_node('steps')\n"
    repository.commit(MANIFEST)
    repository.write({PATH: text.format(call)})
    (found,) = compare(repository).subjects
    assert [line for line in sentences(found) if "nodes" in line] == [expected]


@pytest.mark.parametrize(
    ("expression", "is_breaking"),
    [
        ('fmt::format("bridge.{}.topic", name)', True),
        ('"left/" + name', True),
        ('"bridge." + name', False),
        ("get_topic(name)", False),
        ('name + read("left")', False),
    ],
)
def test_a_parameter_whose_name_an_expression_cannot_give_is_lost(repository, compare, expression, is_breaking):
    text = "void Arm::f() {{ gain_ = declare_parameter<double>({}, 1.0); }}\n"
    repository.commit({**MANIFEST, "arm/a.cpp": text.format('"bridge.topic"')})
    repository.write({"arm/a.cpp": text.format(expression)})
    result = compare(repository)
    assert any("has a computed name now" in line for line in sentences(result.subjects[0]))
    assert bool(breaking(result)) is is_breaking


def test_parameters_that_get_a_namespace_are_lost(repository, compare):
    declare = 'limit += declare_parameter<double>({}"{}", {});'
    values = (("min_x", 1.0), ("max_x", 2.0))
    old = " ".join(declare.format("", name, value) for name, value in values)
    new = " ".join(declare.format("name + ", f".{name}", value) for name, value in values)
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/arm.cpp": f"void f() {{ {old} }}\n"})
    repository.write({"arm/src/arm.cpp": f'void f() {{ {new} declare_parameter<int>(name + ".count", 1); }}\n'})
    assert breaking(compare(repository)) == [
        (
            "parameters that have computed names now: "
            "'min_x' (1.0) -> name + \".min_x\", 'max_x' (2.0) -> name + \".max_x\""
        )
    ]


def test_a_static_member_is_a_constant(repository, compare):
    text = """const std::string Arm::kRate{"rate"};
void Arm::load() {
#ifdef ROS1
  if (!nh.param<int>(kRate, rate_, 1)) {
#else
  if (!this->get_parameter(kRate, rate_)) {
#endif
    warn();
  }
}
void Arm::setup() { p_ = create_publisher<Bool>("state", 1); }
"""
    removed = text[text.index("#ifdef") : text.index("}\nvoid Arm::setup")]
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/arm.cpp": text})
    repository.write({"arm/src/arm.cpp": text.replace(removed, "  more();\n")})
    result = compare(repository)
    assert breaking(result) == ["parameters removed: 'rate' (1)"]
    assert not any("no longer only if" in line for subject in result.subjects for line in sentences(subject))


@pytest.mark.parametrize(("served", "is_lost"), [("state", True), ("status", False)])
def test_a_client_with_another_name_needs_a_server(repository, compare, served, is_lost):
    text = 'void f() { c_ = create_client<Trigger>("state"); }\n'
    server = 'void g() { s_ = create_service<Trigger>("state", h); }\n'
    repository.commit(
        {"arm/package.xml": PACKAGE_XML, "arm/a.cpp": text, "base/package.xml": PACKAGE_XML, "base/b.cpp": server}
    )
    repository.write({"arm/a.cpp": text.replace("state", "status"), "base/b.cpp": server.replace("state", served)})
    assert (
        "service client 'state' (Trigger) renamed to 'status' (Trigger)" in breaking(compare(repository))
    ) is is_lost


NODE = """#include "arm/arm.hpp"
void Arm::start(const std::string & side) {{
  node_ = rclcpp::Node::make_shared({});
  a_ = node_->create_subscription<arm_msgs::msg::State>({}, 10, fill);
  b_ = node_->create_subscription<arm_msgs::msg::Mode>({}, 10, fill);
}}
"""
PYTHON_NODE = """import rclpy
node = rclpy.create_node({})
node.create_subscription(State, {}, fill, 10)
node.create_subscription(Mode, {}, fill, 10)
"""
LITERALS = '"states"', '"modes"'


@pytest.mark.parametrize(
    ("path", "text", "old", "new", "is_breaking"),
    [
        (CPP_PATH, NODE, '"arm", side', ('side + "/states"', 'side + "/modes"'), False),
        (CPP_PATH, NODE, '"arm", side', ('other + "/states"', 'other + "/modes"'), True),
        (CPP_PATH, NODE, '"arm"', ('side + "/states"', 'side + "/modes"'), True),
        (CPP_PATH, NODE, '"arm", "left"', ('"left/states"', '"left/modes"'), False),
        (CPP_PATH, NODE, '"arm", "left"', ('"right/states"', '"right/modes"'), True),
        (PATH, PYTHON_NODE, '"arm", namespace=side', ('f"{side}/states"', 'f"{side}/modes"'), False),
        (PATH, PYTHON_NODE, '"arm", namespace=side', ('f"{other}/states"', 'f"{other}/modes"'), True),
    ],
)
def test_name_that_gets_the_namespace_of_its_node_is_the_same(repository, compare, path, text, old, new, is_breaking):
    repository.commit({**MANIFEST, path: text.format(old, *LITERALS)})
    repository.write({path: text.format('"arm"', *new)})
    assert bool(breaking(compare(repository))) == is_breaking


HEADER = "class Arm {{\npublic:\n  void init(rclcpp::Node::SharedPtr node{});\n}};\n"
CLIENTS = """#include "arm/arm.hpp"
void Arm::init(rclcpp::Node::SharedPtr node{}) {{
  std::string ns = {};
  a_ = node->create_client<arm_msgs::srv::Move>(ns + "move");
  b_ = node->create_client<arm_msgs::srv::Stop>(ns + "stop");
}}
"""


@pytest.mark.parametrize(
    ("default", "value", "is_breaking"),
    [('"left"', 'side_ + "/"', True), ('""', "side_", False), ('"left"', 'compute() + "/"', False)],
)
def test_default_of_a_new_argument_is_a_part_of_the_names(repository, compare, default, value, is_breaking):
    path, header_path = "arm/src/arm.cpp", "arm/include/arm/arm.hpp"
    old = CLIENTS.format("", '""').replace("ns + ", "")
    repository.commit({**MANIFEST, header_path: HEADER.format(""), path: old})
    new_header = HEADER.format(f", std::string side = {default}")
    repository.write({header_path: new_header, path: CLIENTS.format(", std::string side_", value)})
    reasons = [
        str(change.reason) for subject in compare(repository).subjects for change in subject.changes if change.reason
    ]
    expected = "callers that do not pass 'side' use the name 'left/move' instead of 'move'"
    assert (expected in reasons) == is_breaking


CHOSEN = """import sys
from rclpy.node import Node

if sys.argv[1] == "1":
    side = "left"
else:
    side = OTHER
NAME = "state"


class Arm(Node):
    def __init__(self):
        super().__init__("arm")
        self.create_publisher(String, EXPRESSION, 10)
"""


@pytest.mark.parametrize(
    ("other", "expression", "texts", "is_breaking"),
    [
        ('"right"', 'f"{side}/{NAME}"', "'left/state' or 'right/state'", True),
        ('"right"', 'side + "/state"', "'left/state' or 'right/state'", True),
        ('""', 'f"{side}/state"', "'left/state' or '/state'", False),
        ('"right" if BIG else "rear"', 'f"{side}/state"', "'left/state', 'right/state' or 'rear/state'", True),
        ("sys.argv[2]", 'f"{side}/state"', None, False),
        ('"right"', 'f"{side:>9}/state"', None, False),
    ],
)
def test_computed_name_has_the_values_that_the_source_gives(repository, compare, other, expression, texts, is_breaking):
    text = CHOSEN.replace("OTHER", other)
    repository.commit({**MANIFEST, PATH: text.replace("EXPRESSION", '"/state"')})
    repository.write({PATH: text.replace("EXPRESSION", expression)})
    result = compare(repository)
    (found,) = result.subjects
    (line,) = sentences(found)  # no other line repeats the argument of the call
    assert line.startswith("publisher '/state' (String) has a computed name now: ")
    assert line.endswith(f", which is {texts}") if texts else "which is" not in line
    assert bool(breaking(result)) == is_breaking


SERVICES = """void Arm::start() {{
  std::string name;
  name = prefix + "{}";
  stop_ = node_->create_service<std_srvs::srv::Trigger>(name.c_str(), stop);
  name = prefix + "reset";
  reset_ = node_->create_service<std_srvs::srv::Empty>({}, reset);
}}
"""


@pytest.mark.parametrize(
    ("variable", "expected"),
    [
        ("name.c_str()", "'prefix + \"stop\"' (Trigger), 'prefix + \"reset\"' (Empty)"),
        ("other", "'prefix + \"stop\"' (Trigger), 'other' (Empty)"),
    ],
)
def test_names_in_a_variable_that_is_assigned_before_each_use(repository, compare, variable, expected):
    repository.commit({**MANIFEST, CPP_PATH: "void Arm::start() {}\n"})
    repository.write({CPP_PATH: SERVICES.format("stop", variable)})
    lines = sentences(subject(compare(repository), CPP_PATH))
    assert f"services with computed names added: {expected}" in lines


def test_another_sum_in_a_variable_is_another_name(repository, compare):
    repository.commit({**MANIFEST, CPP_PATH: SERVICES.format("stop", "name")})
    repository.write({CPP_PATH: SERVICES.format("halt", "name")})
    lines = sentences(subject(compare(repository), CPP_PATH))
    assert lines[0] == "service 'prefix + \"stop\"' (Trigger) renamed to 'prefix + \"halt\"' (Trigger)"
