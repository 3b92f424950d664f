"""The lines of a review about the options and executors of nodes in C++."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

PATH = "arm/src/arm.cpp"
MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
NODE = """class Arm : public rclcpp::Node {{
  Arm() : Node("arm", rclcpp::NodeOptions(){}) {{}}
}};
"""
MAIN = """int main(int argc, char ** argv) {
  rclcpp::executors::MultiThreadedExecutor executor;
  executor.add_node(std::make_shared<Arm>());
  executor.spin();
}
"""
REGISTRATION = "RCLCPP_COMPONENTS_REGISTER_NODE(Arm)\n"
CMAKE = "project(arm)\nfind_package(ament_cmake)\nadd_library(arm SHARED src/arm.cpp)\n{}ament_package()\n"
COMPONENT = 'rclcpp_components_register_node(arm PLUGIN "Arm" EXECUTABLE arm_node{})\n'


def review_source(repository, compare, old, new, build=""):
    repository.commit({**MANIFEST, PATH: old, "arm/CMakeLists.txt": CMAKE.format("")})
    repository.write({PATH: new, "arm/CMakeLists.txt": CMAKE.format(build)})
    lines = sentences(subject(compare(repository), PATH))
    return [line for line in lines if line.startswith(("options of the node", "executor"))]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("", ".use_intra_process_comms(true)", "use_intra_process_comms true added"),
        (".enable_rosout(false)", "", "enable_rosout false removed"),
        (".enable_rosout(false)", ".enable_rosout(true)", "enable_rosout false -> true"),
    ],
)
def test_options_of_a_node_are_compared(repository, compare, old, new, expected):
    component = NODE.replace("Arm()", "explicit Arm(rclcpp::NodeOptions options)").replace(
        "rclcpp::NodeOptions(){}", "options{}"
    )
    found = review_source(repository, compare, NODE.format(old), component.format(new))
    assert found == [f"options of the node: {expected}"]


@pytest.mark.parametrize(
    ("executor", "expected"),
    [
        ("", ["executor: MultiThreadedExecutor -> SingleThreadedExecutor"]),
        (" EXECUTOR MultiThreadedExecutor", []),
        (None, []),
    ],
)
def test_executor_of_a_generated_program_is_compared(repository, compare, executor, expected):
    build = "" if executor is None else COMPONENT.format(executor)
    old, new = NODE.format("") + MAIN, NODE.format("") + REGISTRATION
    assert review_source(repository, compare, old, new, build) == expected
