"""The lines of a review about headers that a package newly offers to other packages."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

BUILD = "project(arm)\nfind_package(ament_cmake REQUIRED)\n{install}ament_package()\n"
INSTALL = "install(DIRECTORY include/ DESTINATION include)\n"
HEADER = "#pragma once\nnamespace arm {\nclass Leg {\n public:\n  void bend();\n};\n}\n"
LINES = ["header added: other packages include 'arm/leg.hpp'", "classes added: 'Leg'"]


@pytest.mark.parametrize(
    ("install", "path", "expected"),
    [
        (INSTALL, "arm/include/arm/leg.hpp", LINES),
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
