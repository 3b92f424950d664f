"""Names that an installed C++ header gives to other types, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/include/arm/arm.hpp"
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/CMakeLists.txt": "project(arm)\nfind_package(ament_cmake REQUIRED)\nadd_library(arm src/arm.cpp)\n"
    "install(TARGETS arm DESTINATION lib)\ninstall(DIRECTORY include/ DESTINATION include)\nament_package()\n",
    "arm/src/arm.cpp": "int arm() { return 1; }\n",
}
HEADER = "#pragma once\nnamespace arm {{\n{}\n}}\n"
LINE = "type 'Ptr': std::shared_ptr<Buffer> -> std::shared_ptr<Listener>"


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("using Ptr = std::shared_ptr<Buffer>;", "using Ptr = std::shared_ptr<Listener>;", [LINE], True),
        ("typedef std::shared_ptr<Buffer> Ptr;", "using Ptr =\n  std::shared_ptr<Listener>;", [LINE], True),
        ("typedef std::shared_ptr<Buffer> Ptr;", "using Ptr = std::shared_ptr< Buffer >;", [], False),
        ("using Ptr = float;", "using Ptr = double;", ["type 'Ptr': float -> double"], False),
        ("class A {\n  using Ptr = Buffer;\n};", "class A {\n  using Ptr = Listener;\n};", [], False),
        (
            "#ifdef A\nusing Ptr = Buffer;\n#else\nusing Ptr = Old;\n#endif",
            "#ifdef A\nusing Ptr = Buffer;\n#else\nusing Ptr = Listener;\n#endif",
            *([], False),
        ),
    ],
)
def test_a_name_for_another_type(repository, compare, old, new, expected, is_breaking):
    repository.commit({**FILES, PATH: HEADER.format(old)})
    repository.write({PATH: HEADER.format(f"\n{new}")})
    result = compare(repository)
    lines = [line for item in result.subjects for line in sentences(item)]
    assert [line for line in lines if line.startswith("type ")] == expected
    assert breaking(result) == expected * is_breaking
    if expected:
        assert subject(result, PATH).changes[0].location.line == 4
