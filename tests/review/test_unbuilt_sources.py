"""The line of a review about an added source in C++ that no target builds."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

BUILD = """project(arm)
find_package(ament_cmake REQUIRED)
add_library(core src/core.cpp)
install(DIRECTORY include/ DESTINATION include)
ament_package()
"""
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/src/core.cpp": "int core() { return 1; }\n",
    "arm/include/arm/arm.hpp": "class Arm {\n public:\n  void stop();\n};\n",
}
SOURCE = '#include "arm/arm.hpp"\nvoid {}::stop() {{ halt(); }}\n'
LINE = "no target builds the source"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("arm/tools/Makefile", "all:\n\tg++ *.cpp\n"),
        ("arm/tools/platformio.ini", "[env:teensy]\n"),
        ("arm/Makefile", "SRC := tools/list.cpp\n"),
    ],
)
def test_a_source_may_be_built_by_another_tool_in_its_folder(repository, compare, name, text):
    repository.commit({**FILES, "arm/CMakeLists.txt": BUILD, "arm/tools/notes.txt": "x\n"})
    repository.write({"arm/tools/list.cpp": "int main() { return 0; }\n", name: text})
    assert LINE not in [line for subject in compare(repository).subjects for line in sentences(subject)]


@pytest.mark.parametrize(
    ("build", "path", "name", "is_told", "is_breaking"),
    [
        (BUILD, "arm/src/stop.cpp", "Arm", True, True),
        (BUILD, "arm/src/stop.cpp", "Leg", True, False),
        (BUILD.replace("src/core.cpp", "src/core.cpp src/stop.cpp"), "arm/src/stop.cpp", "Arm", False, False),
        (BUILD.replace("src/core.cpp", "${CORE_SOURCES}"), "arm/src/stop.cpp", "Arm", False, False),
        (BUILD + "add_more(stop.cpp)\n", "arm/src/stop.cpp", "Arm", False, False),
        (BUILD.replace("add_library(core src/core.cpp)\n", ""), "arm/src/stop.cpp", "Arm", False, False),
        (
            BUILD.replace("add_library", "file(GLOB FILES src/*.cpp)\nadd_library").replace("src/core.cpp", "${FILES}"),
            *("arm/src/stop.cpp", "Arm", False, False),
        ),
        (BUILD, "arm/test/stop.cpp", "Arm", False, False),
        (BUILD, "arm/src/stop.hpp", "Arm", False, False),
    ],
)
def test_an_added_source_must_be_built(repository, compare, build, path, name, is_told, is_breaking):
    repository.commit({**FILES, "arm/CMakeLists.txt": build})
    repository.write({path: SOURCE.format(name)})
    result = compare(repository)
    assert (LINE in [line for subject in result.subjects for line in sentences(subject)]) is is_told
    assert (LINE in breaking(result)) is is_breaking
