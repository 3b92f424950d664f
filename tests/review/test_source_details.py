"""The lines of a review about values in the sources of nodes.

The tests cover parameters, frames, options, rates and constants.
"""

from __future__ import annotations

import ast

import pytest

from linkwright.packages.readers.python2 import as_python3
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/arm/__init__.py": ""}

OLD_PYTHON = """#!/usr/bin/env python
import rospy

class Driver:
    STATE = "state"

    def __init__(self):
\tself.topic = "enable"
        rospy.init_node('driver')
        self.rate = rospy.get_param('~rate', 10)
        print "rate: %d" % self.rate
        self.state = rospy.Publisher(self.STATE, String, queue_size=5, latch=True)
        rospy.Subscriber(self.topic, Bool, self.enable)
        try:
            self.open(0777)
        except IOError, e:
            raise ValueError, "closed"
        loop = rospy.Rate(20)
        msg.header.frame_id = "arm_link"
        listener.lookupTransform("map", "arm_link", now)
        broadcaster.sendTransform(place, turn, now, "probe", "arm_link")
"""
PYTHON = """import argparse
from rclpy.qos import qos_profile_sensor_data

parser = argparse.ArgumentParser()
parser.add_argument("file")
parser.add_argument("-r", "--rate", type=float, default=10.0)
node.declare_parameter("gain", 1)
node.create_publisher(Image, "image", 10)
node.create_subscription(Image, "raw", f, qos_profile_sensor_data)
node.create_timer(0.1, f)
if __name__ == "__main__":
    main()
"""
CPP = """const std::string STATE = "state";
#define ENABLE "enable"
int main(int argc, char ** argv) {
  ros::init(argc, argv, "driver");
  ros::NodeHandle nh, private_nh("~");
  double rate;
  private_nh.param("rate", rate, 10.0);
  private_nh.getParam("port", port);
  std::string base = private_nh.param<std::string>("base", "base_link");
  ros::Publisher p = nh.advertise<std_msgs::String>(STATE, 5, true);
  ros::Subscriber s = nh.subscribe(ENABLE, 1, &f);
  actionlib::SimpleActionServer<arm::ReachAction> server(nh, "reach", &g, false);
  msg.header.frame_id = "arm_link";
  transform.child_frame_id = "probe";
  ros::Rate loop(20);
}
"""
CPP2 = """#include "arm/driver.hpp"
Driver::Driver() : Node("driver") {
  declare_parameter<int>("gain", 1);
  nav2_util::declare_parameter_if_not_declared(node, "mode", rclcpp::ParameterValue("fast"));
  create_publisher<Map>("map", rclcpp::QoS(1).transient_local());
  create_wall_timer(100ms, f);
}
RCLCPP_COMPONENTS_REGISTER_NODE(arm::Driver)
"""
CFG = """#!/usr/bin/env python
PACKAGE = "arm"
from dynamic_reconfigure.parameter_generator_catkin import *
gen = ParameterGenerator()
gen.add("rate", int_t, 0, "The rate", 10, 1, 100)
gen.add("mode", str_t, 0, "The mode", "fast")
exit(gen.generate(PACKAGE, "arm", "Arm"))
"""
LOOP = """import rospy
defaults = {'host': '192.168.0.1', 'port': 80}
for name, value in defaults.iteritems():
    rospy.get_param('~' + name, value)
"""
HEADER = "namespace arm {\nclass Driver : public Node {\n};\nstruct Later;\n}\n"
MODULE = "class Tool:\n    pass\n\n\ndef grip():\n    pass\n\n\ndef _own():\n    pass\n"


@pytest.mark.parametrize(
    ("name", "text", "old", "new", "expected", "is_breaking"),
    [
        ("a.py", OLD_PYTHON, '"state"', '"arm_state"',
         ["publisher 'state' (String) renamed to 'arm_state' (String)"], True),
        ("a.py", OLD_PYTHON, '"enable"', '"go"', ["subscription 'enable' (Bool) renamed to 'go' (Bool)"], True),
        ("a.py", OLD_PYTHON, "'~rate', 10", "'~rate', 20", ["parameter '~rate': default 10 -> 20"], False),
        ("a.py", OLD_PYTHON, "'~rate'", "'~frequency'",
         ["parameter '~rate' (10) renamed to '~frequency' (10)"], True),
        ("a.py", OLD_PYTHON, "queue_size=5", "queue_size=1", ["publisher 'state': queue 5 -> 1"], False),
        ("a.py", OLD_PYTHON, ", latch=True", "", ["publisher 'state': latched yes -> no"], True),
        ("a.py", OLD_PYTHON, "Rate(20)", "Rate(50)", ["rate or period: Rate(20) -> Rate(50)"], False),
        ("a.py", OLD_PYTHON, 'frame_id = "arm_link"', 'frame_id = "tool"',
         ["frame of messages 'arm_link' renamed to 'tool'"], True),
        ("a.py", OLD_PYTHON, '"probe"', '"tip"', ["frame 'probe' renamed to 'tip'"], True),
        ("a.py", OLD_PYTHON, '"probe"', '"/probe"', ["frame 'probe' renamed to '/probe'"], False),
        ("c.cpp", CPP, '"probe"', '"tip"', ["frame 'probe' renamed to 'tip'"], True),
        ("a.py", OLD_PYTHON, '"map", ', '"odom", ',
         ["frame that is looked up 'map' renamed to 'odom'"], False),
        ("b.py", PYTHON, '"--rate"', '"--speed"',
         ["command-line option '--rate' (10.0) renamed to '--speed' (10.0)"], True),
        ("b.py", PYTHON, "default=10.0", "default=5.0", ["command-line option '--rate': default 10.0 -> 5.0"], False),
        ("b.py", PYTHON, '("file")', '("file")\nparser.add_argument("world")',
         ["command-line options added: 'world'"], True),
        ("b.py", PYTHON, '"gain", 1', '"gain", 1.0',
         ["parameter 'gain': default 1 -> 1.0", "parameter 'gain': type int -> float"], True),
        ("b.py", PYTHON, '"image", 10', '"image", qos_profile_sensor_data',
         ["publisher 'image': QoS 10 -> qos_profile_sensor_data"], True),
        ("b.py", PYTHON, "f, qos_profile_sensor_data", "f, 10",
         ["subscription 'raw': QoS qos_profile_sensor_data -> 10"], True),
        ("b.py", PYTHON, "0.1", "0.05", ["rate or period: create_timer(0.1) -> create_timer(0.05)"], False),
        ("c.cpp", CPP, '"state"', '"arm_state"',
         ["publisher 'state' (String) renamed to 'arm_state' (String)"], True),
        ("c.cpp", CPP, '"enable"', '"enabled"', ["subscription 'enable' renamed to 'enabled'"], True),
        ("c.cpp", CPP, "rate, 10.0", "rate, 20.0", ["parameter '~rate': default 10.0 -> 20.0"], False),
        ("c.cpp", CPP, '  private_nh.getParam("port", port);\n', "", ["parameters removed: '~port'"], True),
        ("c.cpp", CPP, '"base", "base_link"', '"base", "base"',
         ["parameter '~base': default \"base_link\" -> \"base\""], False),
        ("c.cpp", CPP, 'param<std::string>("base"', 'param<Name>("base"',
         ["parameter '~base': read as string -> Name"], False),
        ("c.cpp", CPP, "STATE, 5, true", "STATE, 5", ["publisher 'state': latched yes -> no"], True),
        ("c.cpp", CPP, '"reach"', '"reach_for"',
         ["action 'reach' (ReachAction) renamed to 'reach_for' (ReachAction)"], True),
        ("c.cpp", CPP, '"arm_link"', '"arm_base_link"',
         ["frame of messages 'arm_link' renamed to 'arm_base_link'"], True),
        ("c.cpp", CPP, 'argv, "driver"', 'argv, "arm_driver"', ["node 'driver' renamed to 'arm_driver'"], True),
        ("c.cpp", CPP, "loop(20)", "loop(50)", ["rate or period: ros::Rate(20) -> ros::Rate(50)"], False),
        ("d.cpp", CPP2, '<int>("gain", 1)', '<double>("gain", 1.0)',
         ["parameter 'gain': default 1 -> 1.0", "parameter 'gain': type int -> double"], True),
        ("d.cpp", CPP2, '"fast"', '"slow"', ["parameter 'mode': default \"fast\" -> \"slow\""], False),
        ("d.cpp", CPP2, ".transient_local()", "",
         ["publisher 'map': QoS rclcpp::QoS(1).transient_local() -> rclcpp::QoS(1)"], True),
        ("d.cpp", CPP2, "100ms", "50ms",
         ["rate or period: create_wall_timer(100ms) -> create_wall_timer(50ms)"], False),
        ("d.cpp", CPP2, "100ms", "period_", ["rate or period: create_wall_timer(100ms) -> create_wall_timer(period_)"],
         False),
        ("d.cpp", CPP2, "(arm::Driver)", "(arm::ArmDriver)",
         ["exported class 'arm::Driver' renamed to 'arm::ArmDriver'"], True),
        ("e.py", LOOP, "'port': 80", "'port': 8080", ["parameter '~port': default 80 -> 8080"], False),
        ("cfg/Arm.cfg", CFG, "10, 1, 100", "10, 0, 50",
         ["parameter 'rate': minimum 1 -> 0", "parameter 'rate': maximum 100 -> 50"], False),
        ("cfg/Arm.cfg", CFG, '10, 1', "20, 1", ["parameter 'rate': default 10 -> 20"], False),
        ("cfg/Arm.cfg", CFG, "int_t", "double_t", ["parameter 'rate': type int -> double"], True),
        ("cfg/Arm.cfg", CFG, 'gen.add("mode", str_t, 0, "The mode", "fast")\n', "",
         ["parameters removed: 'mode' ('fast')"], True),
        ("cfg/tool.cfg", "[rate]\n", "rate", "speed", [], False),
        ("src/driver.hpp", HEADER, "class Driver", "class Tool",
         ["code added: 'Tool'; code removed: 'Driver'"], False),
        ("arm/tools.py", MODULE, "def grip", "def release",
         ["functions added: 'release'", "functions removed: 'grip'"], True),
        ("scripts/tools.py", MODULE, "def grip", "def release",
         ["code added: 'release()'; code removed: 'grip()'"], False),
        ("arm/tools.py", MODULE, "def _own", "def _mine",
         ["code added: '_mine()'; code removed: '_own()'"], False),
    ],
)  # fmt: skip
def test_changes_of_sources_are_reported(repository, compare, name, text, old, new, expected, is_breaking):
    assert text.count(old) == 1
    repository.commit({**MANIFEST, f"arm/{name}": text})
    repository.write({f"arm/{name}": text.replace(old, new)})
    result = compare(repository)
    assert [sentence for found in result.subjects for sentence in sentences(found)] == expected
    assert bool(breaking(result)) is is_breaking


HANDLES = """int main(int argc, char ** argv) {
  ros::NodeHandle nh, imu_nh("imu"), private_nh("~");
  ros::param::param<int>("~rate", rate, 10);
  imu = nh.advertise<sensor_msgs::Imu>("imu/data", 1);
  state = private_nh.advertise<std_msgs::String>("state", 1);
  reset = nh.advertiseService<arm::Reset::Request, arm::Reset::Response>("reset", &f);
}
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('ros::param::param<int>("~rate"', 'private_nh.param<int>("rate"', []),
        ('nh.advertise<sensor_msgs::Imu>("imu/data"', 'imu_nh.advertise<sensor_msgs::Imu>("data"', []),
        ('nh.advertiseService<arm', 'imu_nh.advertiseService<arm',
         ["service 'reset' (Reset) renamed to 'imu/reset' (Reset)"]),
        ('private_nh.advertise<std_msgs::String>("state"', 'nh.advertise<std_msgs::String>("state"',
         ["publisher '~state' (String) renamed to 'state' (String)"]),
    ],
)  # fmt: skip
def test_names_are_compared_with_the_namespaces_of_node_handles(repository, compare, old, new, expected):
    assert HANDLES.count(old) == 1
    repository.commit({**MANIFEST, "arm/a.cpp": HANDLES})
    repository.write({"arm/a.cpp": HANDLES.replace(old, new)})
    assert breaking(compare(repository)) == expected


def test_script_without_a_suffix_is_read_if_its_first_line_names_python(repository, compare):
    text = "#!/usr/bin/env {}\nnode.declare_parameter('rate', {})\n"
    programs = {"arm/scripts/drive": "python3", "arm/scripts/run": "bash"}
    repository.commit({**MANIFEST, **{path: text.format(program, 10) for path, program in programs.items()}})
    repository.write({path: text.format(program, 20) for path, program in programs.items()})
    (found,) = compare(repository).subjects
    assert (found.path, sentences(found)) == ("arm/scripts/drive", ["parameter 'rate': default 10 -> 20"])


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("print 'a' % b, c\nx = 1\n", 2),
        ("if a: print >>f, 'a: b'\nelse: print\nx = 0644\n", 3),
        ("try:\n    f()\nexcept (A, B), e:\n    raise A, 'x'\n", 4),
        ("exec code in d\nx = `y` <> 0xFFL\n", 2),
        ("print('a',\n  'b')\nx = ur'y'\n", 3),
        ("def f():\n\tif a:\n            print 'a'\n\treturn 0\n", 4),
        ("print 'a'\nx = [8.5e-06, 1E+05, .5e-3, 0xfe-06, 1e5-3]\n", 2),
    ],
)
def test_python_2_can_be_parsed_as_python_3_with_the_same_lines(text, number):
    tree = ast.parse(as_python3(text))
    assert max(node.lineno for node in ast.walk(tree) if hasattr(node, "lineno")) == number


def test_argument_with_a_default_is_no_constant_of_a_source(repository, compare):
    text = 'void f(const std::string & topic = "scan");\nvoid g(Node & n) { n.create_publisher<Scan>(topic, 10); }\n'
    repository.commit({**MANIFEST, "arm/a.cpp": text})
    repository.write({"arm/a.cpp": text.replace('"scan"', '"laser"')})
    (found,) = compare(repository).subjects
    assert sentences(found) == ['values: f(topic="scan" -> "laser")']


def test_a_function_with_the_same_code_and_another_name_is_renamed(repository, compare):
    text = "def convert_or_nan(field):\n    return float(field or 'nan')\n\n\ndef walk(x):\n    return x\n"
    package = PACKAGE_XML.replace("arm_description", "arm")
    repository.commit({"arm/package.xml": package, "arm/arm/__init__.py": "", "arm/arm/values.py": text})
    repository.write({"arm/arm/values.py": text.replace("convert_or_nan", "safe")})
    expected = "function 'convert_or_nan' (field) renamed to 'safe' (field)"
    result = compare(repository)
    assert sentences(subject(result, "arm/arm/values.py"))[0] == expected
    assert breaking(result) == [expected]


@pytest.mark.parametrize(
    ("text", "new", "expected"),
    [
        ('pub = rospy.Publisher("p", PointStamped, queue_size=1)\nmsg.header.frame_id = "arm"\n', "hand",
         ["frame of messages 'arm' renamed to 'hand'"]),
        ('pub = rospy.Publisher("p", PointStamped, queue_size=1)\nmsg.header.frame_id = "arm"\n', "/arm", []),
        ('client = actionlib.SimpleActionClient("p", MoveAction)\ngoal.header.frame_id = "arm"\n', "hand", []),
        ('pub = rospy.Publisher("p", Map, queue_size=1)\na.frame_id = "arm"\nb.frame_id =  "arm"\n', "hand", []),
    ],
)  # fmt: skip
def test_another_frame_of_published_messages_is_breaking(repository, compare, text, new, expected):
    start = "import rospy\nrospy.init_node('arm_node')\n"
    repository.commit({"a.py": start + text})
    repository.write({"a.py": start + text.replace('id = "arm"', f'id = "{new}"')})
    assert breaking(compare(repository)) == expected


CPP_QOS = """#include <rclcpp/rclcpp.hpp>
Rover::Rover() : Node("rover") {{
  {}
  state_ = create_publisher<std_msgs::msg::String>("state", {});
}}
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            ("auto qos = rclcpp::QoS(10);", "qos"),
            ("auto qos = rclcpp::QoS(10).best_effort();", "qos"),
            ["publisher 'state': QoS rclcpp::QoS(10) -> rclcpp::QoS(10).best_effort()"],
        ),
        (
            ("", "10"),
            ("rclcpp::QoS qos(10);\n  qos.best_effort();\n  qos.transient_local();", "qos"),
            [
                "publisher 'state': QoS 10 -> rclcpp::QoS(10).best_effort().transient_local()",
                "code changed in 'Rover::Rover()'",
            ],
        ),
        (
            ("const auto & qos = rclcpp::SensorDataQoS();", "qos"),
            ("const auto & qos = rclcpp::SystemDefaultsQoS();", "qos"),
            ["publisher 'state': QoS rclcpp::SensorDataQoS() -> rclcpp::SystemDefaultsQoS()"],
        ),
        (
            ("auto qos = make(10);", "qos"),
            ("auto qos = make_other(10);", "qos"),
            ["in 'Rover::Rover()': `auto qos = make(10)` -> `auto qos = make_other(10)`"],
        ),
        (
            ("auto qos = rclcpp::QoS(10);", "qos"),
            ("auto qos = rclcpp::QoS(10);\n  qos = read();", "qos"),
            ["code changed in 'Rover::Rover()'"],
        ),
    ],
)
def test_qos_in_a_variable_of_cpp_is_compared(repository, compare, old, new, expected):
    repository.commit({"rover/src/rover.cpp": CPP_QOS.format(*old)})
    repository.write({"rover/src/rover.cpp": CPP_QOS.format(*new)})
    assert sentences(subject(compare(repository), "rover/src/rover.cpp")) == expected


def test_code_that_a_line_about_qos_shows_is_not_told_again(repository, compare):
    text = """class Rover(Node):
    def __init__(self):
        super().__init__("rover")
        qos = QoSProfile(depth=10)
        self.state = self.create_publisher(String, "state", qos)
"""
    repository.commit({"rover/rover.py": text})
    repository.write({"rover/rover.py": text.replace("depth=10", "depth=10, reliability=BEST_EFFORT")})
    assert sentences(subject(compare(repository), "rover/rover.py")) == [
        "publisher 'state': QoS QoSProfile(depth=10) -> QoSProfile(depth=10, reliability=BEST_EFFORT)"
    ]


def test_an_added_description_of_parameters_tells_them_although_the_node_has_them(repository, compare):
    source = 'void f(ros::NodeHandle nh) { int rate; nh.param("rate", rate, 10); }\n'
    repository.commit({**MANIFEST, "arm/src/driver.cpp": source})
    repository.write({"arm/cfg/Arm.cfg": CFG, "arm/src/driver.cpp": source.replace("10", "20")})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert "parameters added: 'rate' (10), 'mode' ('fast')" in lines


@pytest.mark.parametrize(("tool", "is_compared"), [("ament_cmake", False), ("catkin", True)])
def test_descriptions_of_dynamic_reconfigure_only_count_in_ros1(repository, compare, tool, is_compared):
    depend = f"  <buildtool_depend>{tool}</buildtool_depend>\n</package>"
    manifest = {path: text.replace("</package>", depend) for path, text in MANIFEST.items()}
    repository.commit({**manifest, "arm/cfg/Arm.cfg": CFG})
    repository.write({"arm/cfg/Arm.cfg": None})
    assert bool(breaking(compare(repository))) == is_compared


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        ("a=1, b=2, c=3, d=4, e=5, f=6, g=7, h=8", "arguments added: h=8"),
        ("a=1, b=2, c=3, e=5, f=6, g=7", "arguments removed: d=4"),
        ("a=1, b=0, c=3, d=4, e=5, f=6, g=7", "arguments b=2 -> b=0"),
        ("b=2, a=1, c=3, d=4, e=5, f=6, g=7", None),
    ],
)
def test_of_long_lists_of_arguments_only_the_others_are_shown(repository, compare, new, expected):
    old = "a=1, b=2, c=3, d=4, e=5, f=6, g=7"
    manifest = {**MANIFEST, "arm/arm/__init__.py": ""}
    repository.commit({**manifest, "arm/arm/tools.py": f"def grip({old}):\n    return a\n"})
    repository.write({"arm/arm/tools.py": f"def grip({new}):\n    return a\n"})
    line = sentences(subject(compare(repository), "arm/arm/tools.py"))[0]
    assert line == f"function 'grip': {expected or f'arguments ({old}) -> ({new})'}"
