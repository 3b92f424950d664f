"""Keys that a YAML file repeats in a mapping."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

PATH = "p/config/lamp.yaml"
LINE = "key 'lamp.bulb' is repeated in its mapping"


@pytest.mark.parametrize(
    ("old", "new", "is_told"),
    [
        ("lamp:\n  bulb: {w: 1}\n", "lamp:\n  bulb: {w: 1}\n  bulb: {w: 2}\n", True),
        ("lamp:\n  bulb: 1\n  bulb: 2\n", "lamp:\n  bulb: 1\n  bulb: 3\n", False),
        ("lamp:\n  bulb: 1\n", "lamp:\n  bulb: 1\nother:\n  bulb: 2\n", False),
    ],
)
def test_a_key_that_only_the_new_version_repeats_is_told(repository, compare, old, new, is_told):
    repository.commit({"p/package.xml": PACKAGE_XML, PATH: old})
    repository.write({PATH: new})
    lines = subject(compare(repository), PATH).changes
    assert [change.location.line for change in lines if str(change.sentence) == LINE] == ([3] if is_told else [])


def test_a_repeated_key_whose_list_item_moves_is_not_new(repository, compare):
    repository.commit({"p/package.xml": PACKAGE_XML, PATH: "lamps:\n- bulb: 1\n  bulb: 2\n"})
    repository.write({PATH: "lamps:\n- color: 1\n- bulb: 1\n  bulb: 2\n"})
    lines = subject(compare(repository), PATH).changes
    assert lines
    assert not [change for change in lines if "is repeated in its mapping" in str(change.sentence)]


@pytest.mark.parametrize(
    ("new", "is_told"),
    [
        ("lamps:\n  upper:\n    bulb: 1\n    bulb: 2\n", False),
        ("lamps:\n  upper:\n    color: 1\n    color: 2\n", True),
        ("lamps:\n  left:\n    bulb: 1\n    bulb: 2\n  upper:\n    bulb: 1\n    bulb: 2\n", True),
    ],
    ids=["renamed-mapping", "other-key", "another-mapping"],
)
def test_a_repeated_key_of_a_renamed_mapping_is_not_new(repository, compare, new, is_told):
    repository.commit({"p/package.xml": PACKAGE_XML, PATH: "lamps:\n  left:\n    bulb: 1\n    bulb: 2\n"})
    repository.write({PATH: new})
    lines = [str(change.sentence) for change in subject(compare(repository), PATH).changes]
    assert any("is repeated in its mapping" in line for line in lines) == is_told
