"""Names of programs that a package of ament builds but does not install."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

CMAKE = """project(arm)
find_package(ament_cmake REQUIRED)
{tool}(drive src/drive.cpp)
add_executable(lift src/lift.cpp)
{command}(TARGETS
  {installed}
  DESTINATION lib/arm)
ament_package()
"""
NODE = """class Drive : public rclcpp::Node {{
public:
  Drive() : Node("drive") {{ pub_ = create_publisher<String>("{}", 1); }}
}};
"""


@pytest.mark.parametrize(
    ("command", "installed", "tool", "is_breaking"),
    [
        ("install", "lift", "add_executable", False),
        ("INSTALL", "lift drive", "add_executable", True),
        ("install", "lift ${OTHERS}", "add_executable", True),
        ("foreach", "lift", "add_executable", True),
        ("install", "lift", "add_library", False),
        ("target_link_libraries(lift drive)\ninstall", "lift", "add_library", True),
        ("macro(more)\nendmacro()\ninstall", "lift", "add_executable", True),
    ],
)
def test_names_of_a_program_that_nothing_installs_break_nobody(
    repository, compare, command, installed, tool, is_breaking
):
    build = CMAKE.format(command=command, installed=installed, tool=tool)
    repository.commit(
        {
            "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
            "arm/CMakeLists.txt": build,
            "arm/src/drive.cpp": NODE.format("state"),
            "arm/src/lift.cpp": "int main() {}\n",
        }
    )
    repository.write({"arm/src/drive.cpp": NODE.format("level")})
    assert bool(breaking(compare(repository))) is is_breaking


@pytest.mark.parametrize(
    ("build", "is_breaking"),
    [
        ("# add_executable(drive src/drive.cpp)", False),
        ("", False),
        ("add_executable(drive src/drive.cpp)\ninstall(TARGETS drive DESTINATION lib/arm)", True),
        ("add_executable(drive ${SOURCES})\ninstall(TARGETS drive DESTINATION lib/arm)", True),
    ],
)
def test_names_of_a_program_that_nothing_built_break_nobody(repository, compare, build, is_breaking):
    text = "project(arm)\nfind_package(ament_cmake REQUIRED)\nadd_executable(lift src/lift.cpp)\n{}\nament_package()\n"
    repository.commit(
        {
            "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
            "arm/CMakeLists.txt": text.format(build),
            "arm/src/drive.cpp": NODE.format("speed"),
            "arm/src/lift.cpp": "int main() { return 0; }\n",
        }
    )
    repository.write({"arm/src/drive.cpp": NODE.format("velocity")})
    assert bool(breaking(compare(repository))) is is_breaking
