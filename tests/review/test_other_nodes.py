"""Names that a node loses or gets although another node of its package has the same names."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
STOP = '    stop_ = create_subscription<String>("stop", 1, std::bind(&Drive::onStop, this, _1));\n'
RATE = '    declare_parameter("rate", 10.0);\n'
CLIENT = '    reset_ = create_client<Empty>("reset");\n'
NODE = f"""class Drive : public rclcpp::Node {{
public:
  Drive() : Node("drive") {{
{STOP}{RATE}{CLIENT}  }}
}};
"""
OTHER = NODE.replace("Drive", "Arm").replace('"drive"', '"arm"')
PYTHON_NODE = """class Drive(Node):
    def __init__(self):
        super().__init__("drive")
        self.create_publisher(String, "state", 10)
        self.speed = 1
"""
STATE = '        self.create_publisher(String, "state", 10)\n'


@pytest.fixture
def review_node(repository, compare):
    """Review other texts of sources, and return the sentences and the breaking ones with their reasons."""

    def run(old, new):
        repository.commit({**MANIFEST, **old})
        repository.write(new)
        result = compare(repository)
        reasons = [f"{change.sentence}: {change.reason}" for _, change in result.breaking_changes]
        assert len(reasons) == len(breaking(result))
        return [sentence for subject in result.subjects for sentence in sentences(subject)], reasons

    return run


@pytest.mark.parametrize(
    ("lost", "reasons"),
    [
        (
            STOP,
            [
                (
                    "subscriptions removed: 'stop' (String): "
                    "this node no longer has 'stop'; only another node of the package still has it"
                )
            ],
        ),
        (RATE, ["parameters removed: 'rate' (10.0): values of 'rate' for this node have no effect"]),
        (CLIENT, []),
    ],
)
def test_name_that_one_of_two_nodes_loses_is_reported(review_node, lost, reasons):
    lines, broken = review_node(
        {"arm/src/drive.cpp": NODE, "arm/src/arm.cpp": OTHER}, {"arm/src/drive.cpp": NODE.replace(lost, "")}
    )
    assert len(lines) == 1
    assert broken == reasons


def test_publisher_that_one_of_two_python_nodes_gets_is_reported(review_node):
    lines, broken = review_node(
        {"arm/arm/drive.py": PYTHON_NODE.replace(STATE, ""), "arm/arm/arm.py": PYTHON_NODE},
        {"arm/arm/drive.py": PYTHON_NODE},
    )
    assert lines == ["publishers added: 'state' (String)"]
    assert not broken


def test_name_that_moves_to_another_node_is_no_change(review_node):
    lines, broken = review_node(
        {"arm/src/drive.cpp": NODE, "arm/src/arm.cpp": OTHER.replace(RATE, "")},
        {"arm/src/drive.cpp": NODE.replace(RATE, ""), "arm/src/arm.cpp": OTHER},
    )
    assert not broken
    assert not any(line.startswith("parameters") for line in lines)


@pytest.mark.parametrize(
    "other",
    [
        "void declare(rclcpp::Node & node) {\n" + RATE.replace("declare", "node.declare") + "}\n",  # no node of its own
        '#include "drive.hpp"\n' + OTHER,  # may be derived from the node
    ],
)
def test_name_in_a_source_of_the_same_node_is_not_lost(review_node, other):
    lines, broken = review_node(
        {"arm/src/drive.cpp": NODE, "arm/src/helper.cpp": other}, {"arm/src/drive.cpp": NODE.replace(RATE, "")}
    )
    assert not broken
    assert not any(line.startswith("parameters") for line in lines)


PLUGIN = """PLUGINLIB_EXPORT_CLASS(arm::{0}, arm::Finder)
bool {0}::init(ros::NodeHandle & nh) {{
  nh.param<std::string>("topic", topic_, "{0}");
}}
"""
DEBUG = '  nh.param<bool>("debug", debug_, false);\n'


def add_debug(text: str) -> str:
    return text.replace("  nh.", DEBUG + "  nh.", 1)


@pytest.mark.parametrize(
    ("other", "kept", "is_told"),
    [
        (add_debug(PLUGIN.format("Disk")), True, True),
        (add_debug(PLUGIN.format("Disk")), False, False),  # the parameter moves
        (add_debug(PLUGIN.format("Disk")).partition("\n")[2], True, False),  # may be a part of the plugin
        ('#include "ring.hpp"\n' + add_debug(PLUGIN.format("Disk")), True, False),
    ],
)
def test_parameter_that_one_of_two_plugins_gets(review_node, other, kept, is_told):
    old = {"arm/src/ring.cpp": PLUGIN.format("Ring"), "arm/src/disk.cpp": other}
    new = {"arm/src/ring.cpp": add_debug(PLUGIN.format("Ring"))}
    if not kept:
        new["arm/src/disk.cpp"] = other.replace(DEBUG, "")
    lines, broken = review_node(old, new)
    assert ("parameters added: 'debug' (false)" in lines) is is_told
    assert not broken


def test_the_only_node_of_a_source_is_renamed_although_another_node_has_the_old_name(repository, compare):
    text = 'int main() {{ rclcpp::Node::make_shared("{}"); spin(); }}\n'
    files = {f"arm/src/{name}.cpp": text.format("serial") for name in ("can", "serial")}
    repository.commit({"arm/package.xml": PACKAGE_XML, **files})
    repository.write({"arm/src/can.cpp": text.format("can")})
    assert breaking(compare(repository)) == ["node 'serial' renamed to 'can'"]


BUILD = """project(arm)
find_package(catkin REQUIRED COMPONENTS roscpp)
catkin_package()
add_library(drive src/drive.cpp)
add_library(arm src/arm.cpp)
add_executable(drive_node src/drive_main.cpp)
target_link_libraries(drive_node drive)
add_executable(arm_node src/arm_main.cpp)
target_link_libraries(arm_node arm{})
add_library(arm_plugins src/plugins.cpp)
target_link_libraries(arm_plugins drive arm)
"""
READER = 'Drive::Drive(ros::NodeHandle & nh) {\n  nh.param<std::string>("frame_id", frame_, "base");\n}\n'
PANEL = 'void Panel::load() {\n  nh_.param<std::string>("frame_id", frame_, "");\n}\n'


@pytest.mark.parametrize(
    ("linked", "plugin", "is_lost"),
    [
        ("", "PLUGINLIB_EXPORT_CLASS(arm::Panel, rviz::Panel)\n", True),
        (" drive", "PLUGINLIB_EXPORT_CLASS(arm::Panel, rviz::Panel)\n", False),  # a program has both
        ("", "PLUGINLIB_EXPORT_CLASS(arm::Panel, arm::Part)\n", False),  # the node may load the plugin
    ],
)
def test_parameter_that_a_class_loses_although_programs_without_it_have_the_same(review_node, linked, plugin, is_lost):
    main = "int main() {{ {} node; }}\n"
    files = {
        "arm/CMakeLists.txt": BUILD.format(linked),
        "arm/src/drive.cpp": READER,
        "arm/src/arm.cpp": READER.replace("Drive", "Arm"),
        "arm/src/drive_main.cpp": main.format("Drive"),
        "arm/src/arm_main.cpp": main.format("Arm"),
        "arm/src/plugins.cpp": PANEL + plugin,
    }
    lines, broken = review_node(files, {"arm/src/drive.cpp": READER.replace('"frame_id"', '"target_frame_id"')})
    renamed = "parameter 'frame_id' (\"base\") renamed to 'target_frame_id' (\"base\")"
    assert (renamed in lines) is is_lost
    assert bool(broken) is is_lost


CMAKE = """project(arm)
add_executable(drive src/drive.cpp)
{}
install(TARGETS drive hardware DESTINATION lib/arm)
ament_package()
"""
HARDWARE = """void Hardware::start(rclcpp::Node & node) {
  stop_ = node.create_subscription<String>("stop", 1, std::bind(&Hardware::onStop, this, _1));
}
"""


@pytest.mark.parametrize(
    ("target", "is_told"),
    [
        ("add_executable(hardware src/hardware.cpp)", True),
        ("target_sources(drive PRIVATE src/hardware.cpp)", False),
        ("add_library(hardware src/hardware.cpp)\ntarget_link_libraries(drive hardware)", False),
    ],
)
def test_an_added_source_of_another_program_gets_the_names_of_the_first(review_node, target, is_told):
    old = {"arm/src/drive.cpp": NODE, "arm/CMakeLists.txt": CMAKE.format("")}
    lines, _ = review_node(old, {"arm/src/hardware.cpp": HARDWARE, "arm/CMakeLists.txt": CMAKE.format(target)})
    assert ("subscriptions added: 'stop' (String)" in lines) == is_told
    lines, reasons = review_node({}, {"arm/src/hardware.cpp": None, "arm/CMakeLists.txt": CMAKE.format("")})
    assert not [line for line in (*lines, *reasons) if "'stop'" in line]


@pytest.mark.parametrize(("kept", "is_told"), [('"state"', True), ('"other"', False)])
def test_an_added_node_has_a_name_that_another_changed_node_keeps(review_node, kept, is_told):
    new = PYTHON_NODE.replace("speed = 1", "speed = 2").replace('"state"', kept)
    added = PYTHON_NODE.replace("Drive", "Arm").replace('"drive"', '"arm"')
    lines, _ = review_node({"arm/drive.py": PYTHON_NODE}, {"arm/drive.py": new, "arm/arm.py": added})
    assert ("publishers added: 'state' (String)" in lines) == is_told
