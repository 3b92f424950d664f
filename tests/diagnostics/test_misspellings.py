"""Names that are considered misspellings of others."""

from __future__ import annotations

import pytest

from linkwright.diagnostics.misspellings import find_misspelled
from linkwright.lint.extension_names import CHILD_TAGS


@pytest.mark.parametrize(
    ("written", "intended"),
    [
        ("camera_lnk", "camera_link"),
        ("baselink", "base_link"),
        ("Base_Link", "base_link"),
        ("lfet_wheel", "left_wheel"),
        ("slefCollide", "selfCollide"),
        ("positon", "position"),
    ],
)
def test_single_typo_is_a_misspelling(written, intended):
    assert find_misspelled(written, [intended, "something_else"]) == intended


@pytest.mark.parametrize(
    ("written", "other"),
    [
        ("wheel_2", "wheel_1"),
        ("joint12", "joint1"),
        ("fl_wheel", "fr_wheel"),
        ("lwheel", "rwheel"),
        ("wheelL", "wheelR"),
        ("stopKp", "stopErp"),
        ("stopKp", "stopKd"),
        ("camera_link", "camera_joint"),
        ("camera", "camera_link"),
        ("left_front", "left_rear"),
    ],
)
def test_sibling_name_is_not_a_misspelling(written, other):
    assert find_misspelled(written, [other]) is None


def test_ambiguous_misspelling_matches_nothing():
    assert find_misspelled("weel_link", ["wheel_link", "welel_link"]) is None


def test_spellings_of_same_name_are_not_ambiguous():
    assert find_misspelled("slefCollide", ["selfCollide", "self_collide"]) == "selfCollide"


@pytest.mark.parametrize("path", CHILD_TAGS)
def test_known_elements_are_not_misspellings_of_each_other(path):
    names = CHILD_TAGS[path]
    spellings = {name: "".join(filter(str.isalpha, name)).casefold() for name in names}
    for name in names:
        others = [other for other in names if spellings[other] != spellings[name]]
        assert find_misspelled(name, others) is None
