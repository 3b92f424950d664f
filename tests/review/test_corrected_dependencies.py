"""Dependencies in ``package.xml`` that are spelled with underscores now."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = PACKAGE_XML.replace("<exec_depend>xacro</exec_depend>", "{}").replace("arm_description", "arm")
CMAKE = "project(arm)\nfind_package(ament_cmake REQUIRED)\nament_export_dependencies({})\nament_package()\n"
DASHES = "<depend>gear-box</depend>"


@pytest.mark.parametrize(
    ("new", "cmake", "expected"),
    [
        ("<depend>gear_box</depend>", "gear_box", ["depend: gear-box -> gear_box"]),
        ("<depend>gear_box</depend>", "levers", ["depend added: gear_box", "depend removed: gear-box"]),
        ("<depend>gear_box</depend><depend>gear-box</depend>", "gear_box", ["depend added: gear_box"]),
        (
            "<exec_depend>gear_box</exec_depend>",
            "gear_box",
            ["exec_depend: gear-box -> gear_box", "depend -> exec_depend: gear_box"],
        ),
    ],
    ids=["corrected", "unknown", "both", "other-tag"],
)
def test_a_name_with_dashes_that_has_underscores_now(repository, compare, new, cmake, expected):
    repository.commit({"arm/package.xml": MANIFEST.format(DASHES), "arm/CMakeLists.txt": CMAKE.format(cmake)})
    repository.write({"arm/package.xml": MANIFEST.format(new)})
    review = compare(repository)
    assert sentences(subject(review, "arm/package.xml")) == expected
    assert breaking(review) == [line for line in expected if line.startswith("depend removed")]
