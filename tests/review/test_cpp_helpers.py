"""The lines of a review about names that C++ sources give to functions of their own or of other libraries."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
HEADER = """class Arm : public rclcpp::Node {
 public:
  template <typename Message>
  void publish_on(const std::string & topic, std::shared_ptr<rclcpp::Publisher<Message>> & out, int depth = 10) {
    out = create_publisher<Message>("~/" + topic, depth);
  }
};
"""
SOURCE = """#include "arm/arm.hpp"
double Arm::read(std::string_view name, double value) { return declare_parameter<double>(name, value); }
void Arm::listen(const std::string & topic) {
  sub_ = create_subscription<std_msgs::msg::Bool>(topic, 10, std::bind(&Arm::on_flag, this, _1));
}
void Arm::look(std::string topic) {
  topic = prefix_ + topic;
  look_ = create_subscription<std_msgs::msg::Bool>(topic, 10, on_look);
}
Arm::Arm() {
  publish_on<std_msgs::msg::String>("state", state_);
  gain_ = read("gain", 1.0);
  this->listen("flag");
  other_.listen("else");
  look("scene");
  auto serve = [this](const std::string & name) { return create_service<std_srvs::srv::Trigger>(name, f); };
  home_ = serve("home");
}
"""


def review_source(repository, compare, old, new):
    files = {"arm/include/arm/arm.hpp": HEADER, "arm/src/arm.cpp": SOURCE}
    repository.commit({**MANIFEST, **files})
    assert any(old in text for text in files.values())
    repository.write({path: text.replace(old, new) for path, text in files.items()})
    return [sentence for found in compare(repository).subjects for sentence in sentences(found)]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('"state"', '"status"', ["publisher '~/state' (String) renamed to '~/status' (String)"]),
        ('"state", state_', '"state", state_, 1', ["publisher '~/state': QoS 10 -> 1"]),
        ('("gain", 1.0)', '("gain", 2.0)', ["parameter 'gain': default 1.0 -> 2.0"]),
        ('"gain"', '"kp"', ["parameter 'gain' (1.0) renamed to 'kp' (1.0)"]),
        ('"flag"', '"flags"', ["subscription 'flag' (Bool) renamed to 'flags' (Bool)"]),
        ('"home"', '"homes"', ["service 'home' (Trigger) renamed to 'homes' (Trigger)"]),
    ],
)
def test_a_helper_makes_the_name_that_its_caller_gives(repository, compare, old, new, expected):
    assert review_source(repository, compare, old, new) == expected


@pytest.mark.parametrize("name", ["else", "scene"])
def test_a_call_of_another_object_or_of_a_helper_that_edits_the_name_is_only_a_value(repository, compare, name):
    (line,) = review_source(repository, compare, f'"{name}"', f'"{name}s"')
    assert line.startswith("values in Arm::Arm: ")


SWRI = """#include <swri_roscpp/swri_roscpp.h>
void Arm::init() {
  swri::param(pnh_, "rate", rate_, 10.0);
  sub_ = swri::Subscriber(nh_, "command", 1, &Arm::on_command, this);
  pub_ = swri::advertise<std_msgs::String>(nh_, "state", 1);
  image_ = image_transport::create_publisher(this, "image", qos);
  server_ = swri::ServiceServer(nh_, "reset", &Arm::reset, this);
}
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("10.0", "20.0", "parameter 'rate': default 10.0 -> 20.0"),
        ('"command"', '"commands"', "subscription 'command' renamed to 'commands'"),
        ('"state"', '"states"', "publisher 'state' (String) renamed to 'states' (String)"),
        ('"image"', '"images"', "publisher 'image' renamed to 'images'"),
        ('"reset"', '"resets"', "service 'reset' renamed to 'resets'"),
    ],
)
def test_a_function_of_another_library_has_the_node_before_the_name(repository, compare, old, new, expected):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": SWRI})
    repository.write({"arm/src/arm.cpp": SWRI.replace(old, new)})
    (found,) = compare(repository).subjects
    assert sentences(found) == [expected]


MACROS = """#pragma once
#define COMMON_DECLARE(x)                                          \\
  do {                                                             \\
    rcl_interfaces::msg::ParameterDescriptor descriptor;           \\
    params_.x = declare_parameter<decltype(params_.x)>(#x, descriptor); \\
  } while (false)
#define COMMON_DECLARE_OR(x, value) params_.x = declare_parameter(#x, value)
"""
DECLARING = """#include <common/parameters.hpp>
void Arm::declare() {
  COMMON_DECLARE_OR(port, "/dev/ttyS0");
  COMMON_DECLARE_OR(rate, 10.0);
}
"""


@pytest.mark.parametrize(
    ("old", "new", "expected", "reason"),
    [
        (
            "rate",
            "speed",
            "parameter 'rate' (10.0) renamed to 'speed' (10.0)",
            "values that launch files and parameter files give to",
        ),
        ("10.0", "20.0", "parameter 'rate': default 10.0 -> 20.0", ""),
        ("10.0", '"fast"', "parameter 'rate': type double -> string", "values of the old type are rejected"),
        ('_OR(port, "/dev/ttyS0")', "(port)", "parameter 'port': required no -> yes", "the program fails where 'port'"),
    ],
)
def test_a_macro_of_another_package_declares_the_parameter_that_it_is_given(
    repository, compare, old, new, expected, reason
):
    common = {"common/package.xml": PACKAGE_XML.replace("arm_description", "common")}
    common["common/include/common/parameters.hpp"] = MACROS
    repository.commit({**MANIFEST, **common, "arm/src/arm.cpp": DECLARING})
    repository.write({"arm/src/arm.cpp": DECLARING.replace(old, new)})
    result = compare(repository)
    assert expected in [line for found in result.subjects for line in sentences(found)]
    assert [str(change.reason)[: len(reason)] for _, change in result.breaking_changes] == ([reason] if reason else [])


def test_a_call_may_have_its_arguments_in_the_next_line(repository, compare):
    source = (
        'void Arm::listen() {\n  sub_ = create_subscription<Bool>\n                              ("flag", 10, f);\n}\n'
    )
    repository.commit({**MANIFEST, "arm/src/arm.cpp": source})
    repository.write({"arm/src/arm.cpp": source.replace("flag", "stop")})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["subscription 'flag' (Bool) renamed to 'stop' (Bool)"]


PUBLISHING = """#define PUB(p, T, name, ...) \\
  do { \\
    p = create_publisher<T>(name, __VA_ARGS__); \\
  } while (0)
#define LISTEN(s, T, name) s = create_subscription<T>(name, 10, f)
void Arm::start() {
  PUB(imu_, sensor_msgs::msg::Imu, "imu", 5);
  PUB(raw_, sensor_msgs::msg::Imu, space_ + "/raw", 5, options);
  LISTEN(flag_, std_msgs::msg::Bool, "flag");
}
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('Imu, "imu"', 'MagneticField, "imu"', "publisher 'imu': type Imu -> MagneticField"),
        ('"imu", 5', '"imu", 6', "publisher 'imu': QoS 5 -> 6"),
        ("Imu, space_", "MagneticField, space_",
         "publisher 'space_ + \"/raw\"': type Imu -> MagneticField"),
        ('"flag"', '"stop"', "subscription 'flag' (Bool) renamed to 'stop' (Bool)"),
    ],
)  # fmt: skip
def test_a_macro_gets_the_type_of_a_topic(repository, compare, old, new, expected):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": PUBLISHING})
    repository.write({"arm/src/arm.cpp": PUBLISHING.replace(old, new)})
    (found,) = compare(repository).subjects
    assert expected in sentences(found)


LIBRARY_HEADER = """template <class Command>
class Commands {
  template <class Message>
  void make(std::shared_ptr<rclcpp::Node> node, const std::string & topic, size_t depth) {
    MADE
  }
};
"""
LIBRARY_SOURCE = """#include "arm/commands.hpp"
template <>
void Commands<Drive>::init(std::shared_ptr<rclcpp::Node> node) {
  make<arm_msgs::msg::Drive>(node, "drive", 1);
}
"""


@pytest.mark.parametrize(
    "made",
    [
        "out_ = std::make_unique<MessagePublisher<Command, Message>>(node, topic, depth);",
        "using Type = MessagePublisher<Command, Message>; out_ = std::make_unique<Type>(node, topic, depth);",
        "out_.reset(new lib::MessagePublisher<Message>(node, topic, depth));",
    ],
)
def test_a_template_of_another_library_makes_a_publisher(repository, compare, made):
    files = {"arm/include/arm/commands.hpp": LIBRARY_HEADER.replace("MADE", made), "arm/src/arm.cpp": LIBRARY_SOURCE}
    repository.commit({**MANIFEST, **files})
    repository.write({"arm/src/arm.cpp": LIBRARY_SOURCE.replace('"drive"', '"move"')})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["publisher 'drive' (Drive) renamed to 'move' (Drive)"]


@pytest.mark.parametrize(
    ("made", "is_told"),
    [
        ('new realtime_tools::RealtimePublisher<arm_msgs::State>(nh_, "state", 4)', True),
        ('new realtime_tools::RealtimePublisher<arm_msgs::State>(publisher, "state", 4)', False),
        ('new StatePublisher<arm_msgs::State>(nh_, "state", 4)', False),
    ],
)
def test_a_template_without_a_node_or_of_the_source_makes_no_publisher(repository, compare, made, is_told):
    text = "template <class T> class StatePublisher {};\nArm::Arm() { MADE }\n"
    repository.commit({**MANIFEST, "arm/src/arm.cpp": text.replace("MADE", "")})
    repository.write({"arm/src/arm.cpp": text.replace("MADE", f"out_.reset({made});")})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert ("publishers added: 'state' (State)" in lines) == is_told


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        ('declare_parameter<double>(node, "gain")', "parameters added: 'gain'"),
        ('create_publisher<std_msgs::msg::Bool>(node_, "state", 1)', "publishers added: 'state' (Bool)"),
        ("create_publisher<std_msgs::msg::Bool>(node_name, 1)",
         "publishers with computed names added: 'node_name' (Bool)"),
    ],
)  # fmt: skip
def test_a_free_function_may_take_the_node_first(repository, compare, call, expected):
    text = "void read(rclcpp::Node & node) {{ f(); {} }}\n"
    repository.commit({**MANIFEST, "arm/src/arm.cpp": text.format("")})
    repository.write({"arm/src/arm.cpp": text.format(f"{call};")})
    (found,) = compare(repository).subjects
    assert expected in sentences(found)
