"""The lines of a review about initial values of C++ members that are names or defaults of parameters."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
HEADER = """struct Limits { double speed{1.5}; int count = 3; };
class Arm : public rclcpp::Node {
  double rate_{10.0};
  bool is_slow_ = true;
  int depth_;
  double width_{0.5};
  std::string topic_{"state"};
  std::string read_{"scan"};
  Limits limits_;
  unsigned int period_ = 5, count_{7};
};
"""
SOURCE = """#include "arm/arm.hpp"
Result Arm::on_parameters(const std::vector<rclcpp::Parameter> & changed) { period_ = changed[0].as_int(); }
Arm::Arm() : Node("arm"), depth_(4) {
  rate_ = declare_parameter("rate", rate_);
  nh_.param("is_slow", is_slow_, is_slow_);
  declare_parameter("depth", depth_);
  declare_parameter("speed", limits_.speed);
  declare_parameter<int>("period", period_);
  declare_parameter<int>("count", count_);
  width_ = compute();
  declare_parameter("width", width_);
  create_publisher<std_msgs::msg::String>(topic_, 10);
  get_parameter("read", read_);
  create_publisher<std_msgs::msg::String>(read_, 10);
}
"""
FILES = {"arm/include/arm/arm.hpp": HEADER, "arm/src/arm.cpp": SOURCE}


def review_source(repository, compare, old, new):
    repository.commit({**MANIFEST, **FILES})
    assert sum(old in text for text in FILES.values()) == 1
    repository.write({path: text.replace(old, new) for path, text in FILES.items()})
    return compare(repository)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("{10.0}", "{20.0}", "parameter 'rate': default 10.0 -> 20.0"),
        ("= true", "= false", "parameter 'is_slow': default true -> false"),
        ("depth_(4)", "depth_(5)", "parameter 'depth': default 4 -> 5"),
        ("{7}", "{8}", "parameter 'count': default 7 -> 8"),
        ("= 5", "= 6", "parameter 'period': default 5 -> 6"),
        ("{1.5}", "{2.5}", "parameter 'speed': default 1.5 -> 2.5"),
        ('"state"', '"status"', "publisher 'state' (String) renamed to 'status' (String)"),
    ],
)
def test_the_initial_value_of_a_member_is_a_default_or_a_name(repository, compare, old, new, expected):
    result = review_source(repository, compare, old, new)
    assert sentences(subject(result, "arm/src/arm.cpp")) == [expected]


@pytest.mark.parametrize(("old", "new"), [("{0.5}", "{0.7}"), ('"scan"', '"scans"')])
def test_a_member_that_the_source_sets_before_its_use_is_only_a_value(repository, compare, old, new):
    (found,) = review_source(repository, compare, old, new).subjects
    assert found.path == "arm/include/arm/arm.hpp"


CREATED = """Board::Board() : Node("board") {{
  std::string topic;
  topic = "{0}";
  battery_ = create_publisher<{1}>(topic, 10);
  {{
    topic = "~/pwm";
    pwm_ = create_publisher<Pwm>(topic, 10);
  }}
  state_ = create_publisher<State>(topic, 10);
}}
"""


def test_variable_has_the_text_that_was_assigned_last_in_its_block(repository, compare):
    repository.commit({**MANIFEST, "arm/a.cpp": CREATED.format("voltage", "Float64")})
    repository.write({"arm/a.cpp": CREATED.format("battery", "BatteryState").replace("~/pwm", "~/duty")})
    (found,) = compare(repository).subjects
    assert sentences(found) == [
        "publisher '~/pwm' (Pwm) renamed to '~/duty' (Pwm)",
        "publishers added: 'battery' (BatteryState)",
        "publishers removed: 'voltage' (Float64)",
    ]


DECLARED = "void Board::declare(rclcpp::Node & node) {{\n{}}}\n"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('node.declare_parameter("mode", 2);', 'node.declare_parameter("mode", "mean");'),
        (
            'int mode = MEAN; node.declare_parameter("mode", mode);',
            'std::string mode("mean"); node.declare_parameter("mode", mode);',
        ),
        ('node.declare_parameter("mode", 2);', 'node.declare_parameter("mode", 2.0);'),
        ('node.declare_parameter<bool>("mode", false);', 'node.declare_parameter("mode", 0);'),
    ],
)
def test_declared_parameter_of_another_type_rejects_the_old_values(repository, compare, old, new):
    repository.commit({**MANIFEST, "arm/a.cpp": DECLARED.format(old)})
    repository.write({"arm/a.cpp": DECLARED.format(new)})
    (line,) = breaking(compare(repository))
    assert line.startswith("parameter 'mode': type ")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('node.declare_parameter<double>("mode", 2);', 'node.declare_parameter("mode", 2.5);'),
        ('double mode(2); node.declare_parameter("mode", mode);', 'node.declare_parameter("mode", 2.5);'),
        ('node.declare_parameter("mode", find_mode());', 'node.declare_parameter("mode", 2.5);'),
    ],
)
def test_declared_parameter_of_the_same_type_breaks_nothing(repository, compare, old, new):
    repository.commit({**MANIFEST, "arm/a.cpp": DECLARED.format(old)})
    repository.write({"arm/a.cpp": DECLARED.format(new)})
    assert breaking(compare(repository)) == []


JOINED = """class Drive {{
  Drive() : ns_("drive/") {{
    nh_.param(ns_ + "{0}", gain_, 1.0);
    out_ = nh_.advertise<Bool>(ns_ + NAME + "/done", 1);
  }}
  std::string ns_;
}};
"""


def test_a_name_may_be_a_sum_of_constants(repository, compare):
    text = 'const std::string NAME = "left";\n' + JOINED
    repository.commit({**MANIFEST, "arm/a.cpp": text.format("gain")})
    repository.write({"arm/a.cpp": text.format("force").replace('"left"', '"right"')})
    (found,) = compare(repository).subjects
    assert breaking(compare(repository)) == [
        "publisher 'drive/left/done' (Bool) renamed to 'drive/right/done' (Bool)",
        "parameter 'drive/gain' (1.0) renamed to 'drive/force' (1.0)",
    ], sentences(found)


EMPTY = """class Drive : public rclcpp::Node {{
public:
  Drive() : Node("drive") {{
{}    declare_parameter<std::string>("topic", topic_);
  }}
private:
  std::string topic_;
}};
"""


@pytest.mark.parametrize(
    ("before", "expected"),
    [("", "parameters added: 'topic' (\"\")"), ("    load(topic_);\n", "parameters added: 'topic'")],
)
def test_a_text_without_a_value_is_an_empty_default(repository, compare, before, expected):
    text = EMPTY.format(before)
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    declaration = '    declare_parameter<std::string>("topic", topic_);\n'
    repository.commit({"arm/package.xml": manifest, "arm/src/drive.cpp": text.replace(declaration, "")})
    repository.write({"arm/src/drive.cpp": text})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert [line for line in lines if line.startswith("parameters")] == [expected]


LISTS = """class Arm : public rclcpp::Node {{
  std::vector<double> pose_ = {};
  void init() {{
    {}
    pose_ = declare_parameter<std::vector<double>>("pose", pose_);
  }}
}};
"""


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("start();", ["parameter 'pose': default [0.5, 1.0] -> [0.5, -1.0]"]),
        ("pose_.push_back(3.0);", []),
        ("pose_ = {2.0};", []),
    ],
)
def test_initial_list_of_a_member_is_a_default(repository, compare, line, expected):
    old, new = (LISTS.format(value, line) for value in ("{0.5, 1.0}", "{0.5,\n    -1.0}"))
    repository.commit({**MANIFEST, "arm/a.cpp": old})
    repository.write({"arm/a.cpp": new})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert [line for line in lines if line.startswith("parameter ")] == expected


@pytest.mark.parametrize(
    ("call", "is_told"),
    [('nh.param(joint->name() + "/offset", offset_, 0.0)', True), ("nh.param(joint->name(), offset_, 0.0)", False)],
)
def test_parameter_of_ros_1_with_a_partly_known_name_is_told(repository, compare, call, is_told):
    text = "void Arm::load(const ros::NodeHandle & nh) {{\n  {};\n}}\n"
    repository.commit({**MANIFEST, "arm/a.cpp": text.format("start()")})
    repository.write({"arm/a.cpp": text.format(call)})
    (found,) = compare(repository).subjects
    line = "parameters with computed names added: 'joint->name() + \"/offset\"' (0.0)"
    assert (line in sentences(found)) == is_told


def test_local_variables_of_one_declaration_have_defaults(repository, compare):
    code = 'int main() {\n  int left = 0, right = 1;\n  nh.getParam("left", left);\n  nh.getParam("right", right);\n}\n'
    repository.commit({**MANIFEST, "arm/src/arm.cpp": code})
    repository.write({"arm/src/arm.cpp": code.replace("left = 0, right = 1", "left = 1, right = 0")})
    found = sentences(subject(compare(repository), "arm/src/arm.cpp"))
    assert found[:2] == ["parameter 'left': default 0 -> 1", "parameter 'right': default 1 -> 0"]
