"""The attributes with literal values that only one version of a constructor sets."""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences, subject

PATH = "arm/scripts/arm.py"
CLASS = """class Arm:
    def __init__(self, node):
        self.node = node
        self.side = {}
        {}
"""


def list_lines(repository, compare, old: str, new: str) -> list[str]:
    for code, write in ((old, repository.commit), (new, repository.write)):
        write({PATH: CLASS.format("'left'", code)})
    return sentences(subject(compare(repository), PATH))


@pytest.mark.parametrize(
    "attribute", ["self.limits = {'speed': 0.5, 'effort': 3}", "self.joints = ['lift', 'tilt']", "self.tool = 'hand'"]
)
def test_attribute_of_one_version_is_shown(repository, compare, attribute):
    assert list_lines(repository, compare, "pass", attribute) == [f"attributes added: {attribute}"]


def test_attribute_of_the_old_version_is_shown(repository, compare):
    assert list_lines(repository, compare, "self.tool = 'hand'", "pass") == ["attributes removed: self.tool = 'hand'"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("pass", "self.goals = []"),
        ("pass", "self.is_ready = False"),
        ("pass", "self.count = 0"),
        ("pass", "self.tool = node.tool"),
        ("self.tool = 'hand'", "self.gripper = 'hand'"),
        ("self.tool = 'hand'", "self.tool = 'claw'"),
    ],
)
def test_initial_state_and_other_name_are_not_shown(repository, compare, old, new):
    assert not any(line.startswith("attributes") for line in list_lines(repository, compare, old, new))
