"""The lines of a review about options of CMake, tests without a library, and build files that nothing reads."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"a/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "a/config/a.yaml": "rate: 10\n"}
BUILD = """cmake_minimum_required(VERSION 3.8)
project(arm)
find_package(ament_cmake_auto REQUIRED)
{option}if(WITH_CHECKS)
  add_definitions(-DCHECKS)
  install(FILES config/a.yaml DESTINATION share/arm)
endif()
if(BUILD_TESTING)
  ament_auto_add_gtest(test_core test/core.cpp)
endif()
ament_auto_package()
"""
NESTED = "add_executable(probe probe.cpp)\ninstall(TARGETS probe DESTINATION lib/arm)\n"


@pytest.mark.parametrize(
    ("default", "expected"),
    [
        ("OFF", []),
        ("ON", ["add_definitions removed: -DCHECKS", "no longer installed: 'share/arm/a.yaml'"]),
    ],
)
def test_a_removed_option_is_off(repository, compare, default, expected):
    option = f'option(WITH_CHECKS "check" {default})\n'
    repository.commit({**MANIFEST, "a/CMakeLists.txt": BUILD.format(option=option)})
    repository.write({"a/CMakeLists.txt": BUILD.format(option="")})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert sorted(lines) == sorted([f"settings removed: 'WITH_CHECKS {default}'", *expected])


def test_a_test_is_no_library(repository, compare):
    text = BUILD.format(option="")
    repository.commit({**MANIFEST, "a/CMakeLists.txt": text})
    repository.write({"a/CMakeLists.txt": text.replace("test_core test/core.cpp", "test_more test/more.cpp")})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["tests added: 'test_more'", "tests removed: 'test_core'"]


@pytest.mark.parametrize(
    ("command", "is_read"),
    [
        ("", False),
        ("add_subdirectory(tools/probe)\n", True),
        ('add_subdirectory("${CMAKE_CURRENT_SOURCE_DIR}/tools/probe")\n', True),
        ("foreach(folder core probe)\n  add_subdirectory(tools/${folder})\nendforeach()\n", True),
    ],
)
def test_a_build_file_that_the_package_does_not_add_has_no_contents(repository, compare, command, is_read):
    repository.commit(
        {**MANIFEST, "a/CMakeLists.txt": f"project(arm)\n{command}", "a/tools/probe/CMakeLists.txt": NESTED}
    )
    repository.write({"a/tools/probe/CMakeLists.txt": None})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert any("probe" in line for line in lines) is is_read
