"""The lines of a review about the enumerators of installed headers."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

PATH = "arm/include/arm/arm.hpp"
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/CMakeLists.txt": "project(arm)\ninstall(DIRECTORY include/ DESTINATION include)\n",
}
HEADER = """#pragma once
namespace arm {{
enum class Mode : uint8_t {{
  IDLE,  // waits
  {mode}
}};
class Arm {{
public:
  enum {{ A = 0x10, {anonymous} }};
private:
  enum Hidden {{ {hidden} }};
}};
}}
"""
SAME = {"mode": "RUN, DONE = BASE,", "anonymous": "B", "hidden": "X"}


@pytest.mark.parametrize(
    ("change", "expected", "is_breaking"),
    [
        ({"mode": "DONE = BASE"}, ["enumerators removed: 'Mode::RUN'"], True),
        ({"mode": "GO, DONE = BASE"}, ["enumerator 'Mode::RUN' renamed to 'Mode::GO'"], True),
        ({"mode": "RUN = 4, DONE = BASE"}, ["values of enumerators: Mode::RUN 1 -> 4"], True),
        ({"mode": "RUN, DONE = BASE, LAST"}, ["enumerators added: 'Mode::LAST'"], False),
        (
            {"mode": "NEW, RUN, DONE = BASE"},
            ["enumerators added: 'Mode::NEW'", "values of enumerators: Mode::RUN 1 -> 2"],
            True,
        ),
        ({"mode": "RUN = 1, DONE = BASE"}, ["code changed in 'Mode'"], False),
        ({"anonymous": "B = 18"}, ["values of enumerators: Arm::B 17 -> 18"], True),
        ({"hidden": "Y"}, ["code changed in 'Arm'"], False),
    ],
)
def test_enumerators_of_an_installed_header_are_compared(repository, compare, change, expected, is_breaking):
    repository.commit({**FILES, PATH: HEADER.format(**SAME)})
    repository.write({PATH: HEADER.format(**{**SAME, **change})})
    result = compare(repository)
    assert sentences(result.subjects[0]) == expected
    assert bool(breaking(result)) == is_breaking
