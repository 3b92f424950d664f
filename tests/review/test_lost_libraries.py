"""Worlds and plugin descriptions, in a review, that load a library that their package stopped building."""

from __future__ import annotations

import pytest

from linkwright.review.changes import Effect
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

BUILD = """project(arm_description)
add_library(drive SHARED src/drive.cpp)
install(TARGETS drive DESTINATION lib)
"""
WORLD = '<sdf version="1.9"><world name="w"><plugin filename="{}" name="drive"/></world></sdf>\n'
LOADS = "loads the library 'drive', which is no longer built"


@pytest.mark.parametrize(
    ("path", "text", "build", "expected"),
    [
        ("a/worlds/w.sdf", WORLD.format("drive"), BUILD.replace("drive ", "motor "), [LOADS]),
        ("a/worlds/w.sdf", WORLD.format("libdrive.so"), "project(arm_description)\n", [LOADS]),
        ("a/worlds/w.sdf", WORLD.format("libdrives.so"), "project(arm_description)\n", []),
        ("a/worlds/w.sdf", f"<!-- {WORLD.format('drive')} -->", "project(arm_description)\n", []),
        (
            "a/plugins.xml",
            '<library path="drive"><class type="a::B"/></library>',
            BUILD.replace("drive ", "motor "),
            [LOADS],
        ),
        ("a/worlds/w.sdf", WORLD.format("drive"), BUILD + "# the same\n", []),
    ],
)
def test_file_that_loads_a_lost_library_is_breaking(repository, compare, path, text, build, expected):
    repository.commit({"a/package.xml": PACKAGE_XML, "a/CMakeLists.txt": BUILD, path: text})
    repository.commit({"a/CMakeLists.txt": build})
    found = breaking(compare(repository, "HEAD~1..HEAD"))
    assert [item for item in found if item.startswith("loads")] == expected


PLUGINS = '<library path="{}"><class type="a::B" base_class_type="a::Base"/></library>\n'
NAMES = "names the library 'driver', which no target of the package builds"


def find_names(result):
    changes = [change for item in result.subjects for change in item.changes]
    return [(str(item.sentence), item.effect) for item in changes if str(item.sentence).startswith("names")]


@pytest.mark.parametrize(
    ("build", "plugins"),
    [
        (BUILD, PLUGINS.format("driver").replace("a::Base", "rqt_gui_py::Plugin")),
        (BUILD, PLUGINS.format("lib/libdrive.so")),
        (BUILD + 'set_target_properties(drive PROPERTIES OUTPUT_NAME "driver")\n', PLUGINS.format("driver")),
        (BUILD + "make_plugins(driver)\n", PLUGINS.format("driver")),
        ("project(arm_description)\n", PLUGINS.format("driver")),
    ],
)
def test_library_of_an_added_plugin_description_that_may_be_built_is_not_told(repository, compare, build, plugins):
    repository.commit({"a/package.xml": PACKAGE_XML, "a/CMakeLists.txt": build})
    repository.commit({"a/plugins.xml": plugins})
    assert find_names(compare(repository, "HEAD~1..HEAD")) == []


def test_library_that_a_plugin_description_newly_names_but_nothing_builds_is_told(repository, compare):
    repository.commit({"a/package.xml": PACKAGE_XML, "a/CMakeLists.txt": BUILD})
    repository.commit({"a/plugins.xml": PLUGINS.format("driver")})
    assert find_names(compare(repository, "HEAD~1..HEAD")) == [(NAMES, Effect.CHANGED)]
    repository.commit({"a/plugins.xml": PLUGINS.format("drive")})
    repository.commit({"a/plugins.xml": PLUGINS.format("driver")})
    assert find_names(compare(repository, "HEAD~1..HEAD")) == [(NAMES, Effect.BREAKING)]


def test_parsing_of_arguments_in_a_function_is_no_change(repository, compare):
    new = """project(arm_description)
function(add_plugin name)
  cmake_parse_arguments(add_plugin "" "" "SOURCES" ${ARGN})
  add_library(${name} SHARED ${add_plugin_SOURCES})
  install(TARGETS ${name} DESTINATION lib)
endfunction()
add_plugin(drive SOURCES src/drive.cpp)
"""
    repository.commit({"a/package.xml": PACKAGE_XML, "a/CMakeLists.txt": BUILD})
    repository.commit({"a/CMakeLists.txt": new})
    result = compare(repository, "HEAD~1..HEAD")
    assert not [str(change.sentence) for item in result.subjects for change in item.changes]
