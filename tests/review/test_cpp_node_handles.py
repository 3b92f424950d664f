"""The lines of a review about names of node handles of ROS 1, and of sub-nodes and remapped nodes of ROS 2."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CLASS = "class Arm { public: Arm(); ros::NodeHandle nh, other; ros::Publisher p; };\n"
SOURCE = 'Arm::Arm() { p = nh.advertise<std_msgs::Bool>("ready", 1); }\n'
INCLUDE = "#include <arm/arm.hpp>\n"
PRIVATE_CLASS = CLASS.replace("nh, other", 'nh{"~"}')
PRIVATE_SOURCE = SOURCE.replace("Arm() {", 'Arm() : nh("~") {')
BECOMES_PRIVATE = "publisher 'ready' (Bool) renamed to '~ready' (Bool)"


@pytest.mark.parametrize(
    ("header", "old", "new", "expected"),
    [
        (CLASS, SOURCE, PRIVATE_SOURCE, BECOMES_PRIVATE),
        (CLASS, SOURCE, PRIVATE_SOURCE.replace('("~")', '{"~"}'), BECOMES_PRIVATE),
        ("", CLASS + SOURCE, PRIVATE_CLASS + SOURCE, BECOMES_PRIVATE),
        (CLASS, PRIVATE_SOURCE, PRIVATE_SOURCE.replace('"ready"', '"on"'),
         "publisher '~ready' (Bool) renamed to '~on' (Bool)"),
        (PRIVATE_CLASS, SOURCE, SOURCE.replace("{ p", '{ double g; nh.param("gain", g, 1.0); p'),
         "parameters added: '~gain' (1.0)"),
        (PRIVATE_CLASS, "ros::NodeHandle nh;\n" + SOURCE, "ros::NodeHandle nh;\n" + SOURCE.replace("ready", "on"),
         "publisher 'ready' (Bool) renamed to 'on' (Bool)"),
    ],
)  # fmt: skip
def test_names_of_a_private_node_handle_are_private(repository, compare, header, old, new, expected):
    repository.commit({**MANIFEST, "arm/include/arm/arm.hpp": header, "arm/src/arm.cpp": INCLUDE + old})
    repository.write({"arm/src/arm.cpp": INCLUDE + new})
    (found,) = compare(repository).subjects
    assert sentences(found)[0] == expected
    assert not any(sentence.startswith("values") for sentence in sentences(found))


NODELET = """#include <nodelet/nodelet.h>
void Arm::onInit() {{
  ros::NodeHandle & nh = getNodeHandle();
  ros::NodeHandle pnh(getMTPrivateNodeHandle());
  {}
}}
"""


@pytest.mark.parametrize(
    ("call", "name"),
    [
        ('p = nh.advertise<std_msgs::Bool>("ready", 1);', "ready"),
        ('p = pnh.advertise<std_msgs::Bool>("ready", 1);', "~ready"),
        ('p = getPrivateNodeHandle().advertise<std_msgs::Bool>("ready", 1);', "~ready"),
        ('p = this->getMTNodeHandle().advertise<std_msgs::Bool>("ready", 1);', "ready"),
        ('nh_ = getPrivateNodeHandle(); p = nh_.advertise<std_msgs::Bool>("ready", 1);', "~ready"),
        ('ros::NodeHandle left(getPrivateNodeHandle(), "left"); p = left.advertise<std_msgs::Bool>("ready", 1);',
         "~left/ready"),
        ('nh_.reset(new ros::NodeHandle("~")); p = nh_->advertise<std_msgs::Bool>("ready", 1);', "~ready"),
        ('nh_ = std::make_shared<ros::NodeHandle>("left"); p = nh_->advertise<std_msgs::Bool>("ready", 1);',
         "left/ready"),
        ('nh_ = getPrivateNodeHandle(); nh_ = getNodeHandle(); p = nh_.advertise<std_msgs::Bool>("ready", 1);',
         "ready"),
    ],
)  # fmt: skip
def test_names_of_the_handles_of_a_nodelet(repository, compare, call, name):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": NODELET.format(call)})
    repository.write({"arm/src/arm.cpp": NODELET.format(call.replace("ready", "done"))})
    (found,) = compare(repository).subjects
    assert sentences(found) == [f"publisher '{name}' (Bool) renamed to '{name.replace('ready', 'done')}' (Bool)"]


NODE = """#include <rclcpp/rclcpp.hpp>
Arm::Arm() : Node("arm") {{
  {}
}}
"""


@pytest.mark.parametrize(
    ("call", "name"),
    [
        ('auto sub = this->create_sub_node("left"); p_ = sub->create_publisher<Bool>("ready", 10);', "left/ready"),
        ('p_ = create_sub_node("left")->create_publisher<Bool>("ready", 10);', "left/ready"),
        ('auto a = create_sub_node("left"); auto b = a->create_sub_node("tip"); b->create_publisher<Bool>("ready", 1);',
         "left/tip/ready"),
        ('auto sub = create_sub_node("left"); p_ = sub->create_publisher<Bool>("~/ready", 10);', "~/ready"),
        ('auto sub = create_sub_node("left"); p_ = create_publisher<Bool>("ready", 10);', "ready"),
    ],
)  # fmt: skip
def test_names_of_a_sub_node(repository, compare, call, name):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": NODE.format(call)})
    repository.write({"arm/src/arm.cpp": NODE.format(call.replace("ready", "done"))})
    (found,) = compare(repository).subjects
    assert sentences(found) == [f"publisher '{name}' (Bool) renamed to '{name.replace('ready', 'done')}' (Bool)"]


def test_other_namespace_of_a_sub_node_renames_its_topics(repository, compare):
    call = 'auto sub = create_sub_node("left");\n  p_ = sub->create_publisher<Bool>("ready", 10);'
    repository.commit({**MANIFEST, "arm/src/arm.cpp": NODE.format(call)})
    repository.write({"arm/src/arm.cpp": NODE.format(call.replace("left", "right"))})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["publisher 'left/ready' (Bool) renamed to 'right/ready' (Bool)"]


REMAPPED = """#include <rclcpp/rclcpp.hpp>
int main() {
  auto options = rclcpp::NodeOptions().arguments({"--ros-args", "-r", "ready:=left/ready", "--remap", "__ns:=/cell"});
  auto node = std::make_shared<rclcpp::Node>("arm", options);
  auto p = node->create_publisher<Bool>("ready", 10);
}
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("left/ready", "right/ready",
         ["publisher '/cell/left/ready' (Bool) renamed to '/cell/right/ready' (Bool)"]),
        ("/cell", "/hall", ["publisher '/cell/left/ready' (Bool) renamed to '/hall/left/ready' (Bool)"]),
        ("__ns:=/cell", "__node:=tool",
         ["publisher '/cell/left/ready' (Bool) renamed to 'left/ready' (Bool)", "node 'arm' renamed to 'tool'"]),
        ('"-r", "ready:=left/ready", ', "",
         ["publisher '/cell/left/ready' (Bool) renamed to '/cell/ready' (Bool)"]),
    ],
)  # fmt: skip
def test_names_of_a_node_with_remappings_in_its_options(repository, compare, old, new, expected):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": REMAPPED})
    repository.write({"arm/src/arm.cpp": REMAPPED.replace(old, new)})
    (found,) = compare(repository).subjects
    assert [sentence for sentence in sentences(found) if "renamed" in sentence] == expected


def test_options_of_several_nodes_remap_no_names(repository, compare):
    text = REMAPPED.replace("  auto node", '  other.arguments({"--ros-args", "-r", "x:=y"});\n  auto node')
    repository.commit({**MANIFEST, "arm/src/arm.cpp": text})
    repository.write({"arm/src/arm.cpp": text.replace('Bool>("ready"', 'Bool>("done"')})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["publisher 'ready' (Bool) renamed to 'done' (Bool)"]


HANDLES = """#include <ros/ros.h>
class Arm {{ public: ros::NodeHandle nh; ros::NodeHandle pnh{{"~"}}; }};
void Arm::start({}) {{
  {}
}}
"""


@pytest.mark.parametrize(
    ("arguments", "old", "new", "expected"),
    [
        ("", 'nh.getParam("gain", g);', 'pnh.getParam("gain", g);', ["parameter 'gain' renamed to '~gain'"]),
        ("", 'pnh.param("gain", g, 1.0);', 'nh.param("gain", g, 1.0);',
         ["parameter '~gain' (1.0) renamed to 'gain' (1.0)"]),
        ("", 'nh.getParam("/gain", g);', 'nh.getParam("gain", g);', []),
        ("", 'nh.getParam("gain", g);', 'pnh.getParam("gain", g); nh.getParam("gain", g);', []),
        ("ros::NodeHandle & nh", 'nh.getParam("gain", g);', 'pnh.getParam("gain", g);', []),
        ("", 'other.getParam("gain", g);', 'pnh.getParam("gain", g);', []),
        ("", 'nh = make(); nh.getParam("gain", g);', 'pnh.getParam("gain", g);', []),
        ("", 'getRosParam("gain", g);', 'pnh.getParam("gain", g);', []),
        ("", 'pnh.getParam("gain", g);', 'getRosParam("gain", g);', []),
    ],
)  # fmt: skip
def test_parameter_that_becomes_private_is_renamed(repository, compare, arguments, old, new, expected):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": HANDLES.format(arguments, old)})
    repository.write({"arm/src/arm.cpp": HANDLES.format(arguments, new)})
    assert breaking(compare(repository)) == expected


def test_parameter_of_rospy_that_becomes_private_is_renamed(repository, compare):
    text = "import rospy\nrospy.init_node('arm')\ngain = rospy.get_param('gain', 1)\n"
    repository.commit({**MANIFEST, "arm/arm.py": text})
    repository.write({"arm/arm.py": text.replace("'gain', 1", "'~gain', 2")})
    result = compare(repository)
    assert breaking(result) == ["parameter 'gain' (1) renamed to '~gain' (2)"]
    assert sentences(subject(result, "arm/arm.py")) == breaking(result)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('s = nh.subscribe(prefix + "/pose", 1, &Arm::go, this);', 's = nh.subscribe("joints", 1, &Arm::go, this);',
         ["subscription 'joints' had a computed name: prefix + \"/pose\""]),
        ("", 'nh.param<int>(prefix + "/port", port, 23);',
         ["parameters with computed names added: 'prefix + \"/port\"' (23)"]),
        ("list.subscribe(x);", "list.subscribe(y);", ["code changed in 'Arm::start()'"]),
    ],
)  # fmt: skip
def test_computed_names_of_ros_1(repository, compare, old, new, expected):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": HANDLES.format("", old)})
    repository.write({"arm/src/arm.cpp": HANDLES.format("", new)})
    (found,) = compare(repository).subjects
    assert sentences(found)[:1] == expected


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        ('p_ = rclcpp::create_publisher<Bool>(topics, "ready", rclcpp::QoS(10));', "publisher 'ready' (Bool)"),
        ('s_ = rclcpp::create_service<Trigger>(base, services, "ready", f, qos, group);', "service 'ready' (Trigger)"),
        ('c_ = rclcpp::create_client<Trigger>(base, graph, services, "ready", qos, group);',
         "service client 'ready' (Trigger)"),
    ],
)  # fmt: skip
def test_names_behind_the_interfaces_of_a_node(repository, compare, call, expected):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": NODE.format(call)})
    repository.write({"arm/src/arm.cpp": NODE.format(call.replace("ready", "done"))})
    (found,) = compare(repository).subjects
    new_name = expected[expected.index("'") :].replace("ready", "done")
    assert sentences(found) == [f"{expected} renamed to {new_name}"]
