"""The lines of a review about headers that a package newly offers to other packages."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

BUILD = "project(arm)\nfind_package(ament_cmake REQUIRED)\n{install}ament_package()\n"
EXPORTED = "install(DIRECTORY src/include/ DESTINATION include/arm)\nament_export_include_directories({})\n"
INSTALL = "install(DIRECTORY include/ DESTINATION include)\n"
HEADER = "#pragma once\nnamespace arm {\nclass Leg {\n public:\n  void bend();\n};\n}\n"
LINES = ["header added: other packages can include 'arm/leg.hpp'", "classes added: 'Leg'"]


@pytest.mark.parametrize(
    ("install", "path", "expected"),
    [
        (INSTALL, "arm/include/arm/leg.hpp", LINES),
        (EXPORTED.format("include"), "arm/src/include/leg.hpp", LINES),
        (EXPORTED.format("include/${PROJECT_NAME}"), "arm/src/include/arm/leg.hpp", LINES),
        ("", "arm/include/arm/leg.hpp", []),
        (INSTALL, "arm/src/leg.hpp", []),
    ],
)
def test_an_added_header_is_told_if_it_is_installed(repository, compare, install, path, expected):
    files = {
        "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
        "arm/CMakeLists.txt": BUILD.format(install=install),
        "arm/include/arm/arm.hpp": "#pragma once\n",
    }
    repository.commit(files)
    repository.write({path: HEADER})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert [line for line in lines if "Leg" in line or "leg" in line] == expected


@pytest.mark.parametrize(
    ("old", "new", "is_told"),
    [
        (("include", "include"), ("include/arm", "include/arm"), False),
        (("include/arm", "include"), ("include", "include"), False),
        (("include", "include"), ("include/arm", "include"), True),
    ],
)
def test_headers_that_move_are_told_if_other_packages_no_longer_find_them(repository, compare, old, new, is_told):
    install = "install(DIRECTORY include/ DESTINATION {})\nament_export_include_directories({})\n"
    files = {
        "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
        "arm/CMakeLists.txt": BUILD.format(install=install.format(*old)),
        "arm/include/arm/leg.hpp": HEADER,
    }
    repository.commit(files)
    repository.write({"arm/CMakeLists.txt": BUILD.format(install=install.format(*new))})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert any("leg.hpp" in line for line in lines) is is_told
