"""Lists of lists in parameter files, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

PATH = "arm/config/nav.yaml"
COSTMAP = "costmap:\n  ros__parameters:\n    footprint: {}\n    rate: 1.0\n"
REASON = "a node that declares the parameter as string does not accept mixed_array"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            "[[0.6, 0.4], [-0.6, 0.4]]",
            '"[[1.2, 0.4], [-1.2, 0.4]]"',
            [("[[0.6, 0.4], [-0.6, 0.4]] -> [[1.2, 0.4], [-1.2, 0.4]]", None)],
        ),
        ("[[1, 2], [3, 4]]", '"[[1, 2], [3, 4]]"', [('[[1, 2], [3, 4]] -> "[[1, 2], [3, 4]]"', None)]),
        ('"[[1, 2], [3, 4]]"', "[[1, 2], [3, 5]]", [("[[1, 2], [3, 4]] -> [[1, 2], [3, 5]]", REASON)]),
    ],
)
def test_a_list_of_lists_that_becomes_a_text_is_one_change(repository, compare, old, new, expected):
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: COSTMAP.format(old)})
    repository.write({PATH: COSTMAP.format(new)})
    prefix = "costmap.ros__parameters.footprint "
    changes = subject(compare(repository), PATH).changes
    lines = [(str(change.sentence).removeprefix(prefix), change.reason and str(change.reason)) for change in changes]
    assert lines == expected


def test_items_of_a_list_of_lists_are_compared_one_by_one(repository, compare):
    text = COSTMAP.format("[[1, 2], [3, 4]]")
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: text})
    repository.write({PATH: text.replace("3", "5")})
    (change,) = subject(compare(repository), PATH).changes
    assert "footprint[1]" in str(change.sentence)
