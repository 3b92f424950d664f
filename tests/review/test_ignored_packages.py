"""The lines of a review about packages that build tools skip."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = "parts/arm/package.xml"
FILES = {MANIFEST: PACKAGE_XML, "leg/package.xml": PACKAGE_XML.replace("arm", "leg")}


@pytest.mark.parametrize("marker", ["parts/arm/COLCON_IGNORE", "parts/CATKIN_IGNORE", "parts/AMENT_IGNORE"])
def test_a_package_that_is_no_longer_built_is_breaking(repository, compare, marker):
    repository.commit(FILES)
    repository.write({marker: ""})
    result = compare(repository)
    assert breaking(result) == [f"no longer built, because of '{marker}'"]
    assert sentences(subject(result, MANIFEST)) == breaking(result)
    assert list(result.other_files) == []


def test_a_package_that_is_built_now_is_told(repository, compare):
    repository.commit({**FILES, "parts/COLCON_IGNORE": ""})
    repository.write({"parts/COLCON_IGNORE": None})
    result = compare(repository)
    assert sentences(subject(result, MANIFEST)) == ["built now, without 'parts/COLCON_IGNORE'"]
    assert breaking(result) == []


def test_a_second_marker_and_one_beside_an_added_package_change_nothing(repository, compare):
    repository.commit({**FILES, "parts/COLCON_IGNORE": ""})
    repository.write({"parts/arm/COLCON_IGNORE": "", "leg/toe/COLCON_IGNORE": "", "leg/toe/a.txt": ""})
    repository.write({"foot/package.xml": PACKAGE_XML.replace("arm", "foot"), "foot/COLCON_IGNORE": ""})
    assert breaking(compare(repository)) == []
