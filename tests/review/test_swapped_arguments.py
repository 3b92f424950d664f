"""Parameters of C++ functions that change places are breaking in a review, although calls still build."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

BUILD = """project(arm_description)
find_package(ament_cmake REQUIRED)
{}
install(DIRECTORY include/ DESTINATION include)
ament_package()
"""
HEADER = """#pragma once
namespace arm {{
struct Box {{
  Box({});
}};
double volume({}) {{ return 0.0; }}
}}
"""
PATH = "a/include/a/box.h"
LIBRARY = "add_library(arm src/box.cpp)\ninstall(TARGETS arm DESTINATION lib)"
PROGRAM = "add_executable(arm src/box.cpp)\ninstall(TARGETS arm DESTINATION lib/arm_description)"
OLD = "const Pose & center, const double & length, double height = 0.0"
NEW = "const Pose & center, const double & height, double length = 0.0"
CHANGE = "function 'Box::Box': parameters ({}) -> ({}) change places"


@pytest.mark.parametrize(
    ("build", "old", "new", "expected"),
    [
        (LIBRARY, "double x, double y", "double y, double x", [CHANGE.format("x, y", "y, x")]),
        (LIBRARY, OLD, NEW, [CHANGE.format("center, length, height", "center, height, length")]),
        (LIBRARY, "double x, double y", "double a, double b", []),
        (LIBRARY, "double x, double y", "double, double", []),
        (LIBRARY, "double x, double y", "double x, double y", []),
        (PROGRAM, "double x, double y", "double y, double x", []),
    ],
)  # fmt: skip
def test_parameters_that_change_places(repository, compare, build, old, new, expected):
    files = {"a/package.xml": PACKAGE_XML, "a/CMakeLists.txt": BUILD.format(build)}
    repository.commit({**files, PATH: HEADER.format(old, "double x")})
    repository.write({PATH: HEADER.format(new, "double x, double y = 0.0")})
    assert breaking(compare(repository)) == expected


def test_function_of_a_header_counts_without_a_library(repository, compare):
    files = {"a/package.xml": PACKAGE_XML, "a/CMakeLists.txt": BUILD.format(PROGRAM)}
    repository.commit({**files, PATH: HEADER.format("", "double x, double y")})
    repository.write({PATH: HEADER.format("", "double y, double x")})
    assert breaking(compare(repository)) == ["function 'volume': parameters (x, y) -> (y, x) change places"]


CODE = """#include "a/box.h"
namespace arm {{
Box::Box({}) {{ size_ = {}; }}
}}
"""


@pytest.mark.parametrize(
    ("build", "declared", "old", "new", "is_breaking"),
    [
        (LIBRARY, "double, double", ("double x, double y", "x / y"), ("double y, double x", "x / y"), True),
        (PROGRAM, "double, double", ("double x, double y", "x / y"), ("double y, double x", "x / y"), False),
        (LIBRARY, "double, double", ("double x, double y", "x / y"), ("double y, double x", "y / x"), None),
        (LIBRARY, "double, double", ("double x, double y", "x / y"), ("double a, double b", "a / b"), None),
        (LIBRARY, "double x, double y", ("double x, double y", "x / y"), ("double y, double x", "x / y"), None),
    ],
)
def test_parameters_that_only_the_definition_names(repository, compare, build, declared, old, new, is_breaking):
    files = {"a/package.xml": PACKAGE_XML, "a/CMakeLists.txt": BUILD.format(build), PATH: HEADER.format(declared, "")}
    repository.commit({**files, "a/src/box.cpp": CODE.format(*old)})
    repository.write({"a/src/box.cpp": CODE.format(*new)})
    found = [change for subject in compare(repository).subjects for change in subject.changes]
    swapped = [change.reason is not None for change in found if "change places" in str(change.sentence)]
    assert swapped == ([] if is_breaking is None else [is_breaking])
