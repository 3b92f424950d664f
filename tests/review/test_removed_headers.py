"""The lines of a review about removed headers, whose classes are told."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

CMAKE = """cmake_minimum_required(VERSION 3.8)
project(arm)
add_library(arm src/arm.cpp)
install(DIRECTORY include/ DESTINATION include)
install(TARGETS arm DESTINATION lib)
"""
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/CMakeLists.txt": CMAKE,
    "arm/src/arm.cpp": "int arm() { return 1; }\n",
    "arm/include/arm/lamp.hpp": "namespace arm {\nclass Lamp {\n};\n}\n",
    "arm/include/arm/rate.hpp": "#define RATE 10\n",
    "arm/include/arm/sun.hpp": "namespace arm {\nclass Sun {\n};\n}\n",
}
LAMP, RATE, SUN = (path for path in FILES if path.endswith(".hpp"))
CLASS = "classes removed: 'Lamp'"


@pytest.mark.parametrize(
    ("removed", "expected"),
    [
        ([LAMP], [CLASS]),
        ([RATE], ["no longer installed: 'include/arm/rate.hpp'"]),
        ([LAMP, RATE], ["no longer installed: 'include/arm/rate.hpp'", CLASS]),
        ([LAMP, SUN], [CLASS, "classes removed: 'Sun'"]),
    ],
)
def test_a_removed_header_has_one_line(repository, compare, removed, expected):
    repository.commit(FILES)
    repository.write(dict.fromkeys(removed))
    assert breaking(compare(repository)) == expected


def test_a_header_that_is_left_but_not_installed_is_told_by_the_build_file(repository, compare):
    repository.commit(FILES)
    installed = "install(DIRECTORY include/ DESTINATION include)"
    repository.write({"arm/CMakeLists.txt": CMAKE.replace(installed, ""), RATE: "#define RATE 20\n"})
    assert any(sentence.startswith("no longer installed: ") for sentence in breaking(compare(repository)))
