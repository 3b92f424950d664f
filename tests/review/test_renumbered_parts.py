"""Mappings of parameter files whose keys end in numbers, and that have other numbers in the new version."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "p/config/lamps.yaml"
STEPS = {
    "dim": "{name: dim, type: lamps/Dim, level: 2}",
    "blink": "{name: blink, type: lamps/Blink, rate: 3}",
    "glow": "{name: glow, type: lamps/Glow, color: red}",
    "off": "{name: off, type: lamps/Off, delay: 4}",
}
PREFIX = "lamp.ros__parameters.steps."


def compare_steps(repository, compare, old: dict[int, str], new: dict[int, str]):
    for steps in (old, new):
        lines = "".join(f"      step{number}: {text}\n" for number, text in steps.items())
        repository.commit({"p/package.xml": PACKAGE_XML, PATH: f"lamp:\n  ros__parameters:\n    steps:\n{lines}"})
    return compare(repository, "HEAD~1..HEAD")


def number(*names: str, start: int = 1) -> dict[int, str]:
    return {index: STEPS.get(name, name) for index, name in enumerate(names, start)}


def test_a_closed_gap_is_one_line(repository, compare):
    gap = {1: STEPS["dim"], 3: STEPS["blink"], 4: STEPS["glow"], 5: STEPS["off"]}
    review = compare_steps(repository, compare, gap, number(*STEPS))
    (change,) = subject(review, PATH).changes
    assert str(change.sentence) == f"{PREFIX}step3 renamed to {PREFIX}step2"
    assert change.other_names == ("step4 -> step3", "step5 -> step4")
    assert breaking(review) == []


def test_a_removed_mapping_is_told_under_its_old_number(repository, compare):
    review = compare_steps(repository, compare, number(*STEPS), number("dim", "glow", "off"))
    first, second = sentences(subject(review, PATH))
    assert first == f"{PREFIX}step3 renamed to {PREFIX}step2"
    assert second.startswith(f"{PREFIX}step2 (old) removed: name blink")
    assert breaking(review) == [second]


def test_an_added_mapping_moves_the_others(repository, compare):
    review = compare_steps(repository, compare, number("dim", "glow", "off"), number(*STEPS))
    lines = sentences(subject(review, PATH))
    assert lines[0] == f"{PREFIX}step2 renamed to {PREFIX}step3"
    assert lines[1].startswith(f"{PREFIX}step2 added: name blink")
    assert len(lines) == 2


def test_a_changed_mapping_between_moved_ones_is_compared_with_the_old_one(repository, compare):
    new = number(STEPS["dim"], STEPS["blink"].replace("3", "7"), "glow", "off", start=2)
    review = compare_steps(repository, compare, number(*STEPS), new)
    assert f"{PREFIX}step3.rate 3 -> 7" in sentences(subject(review, PATH))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (number("dim", "dim", "blink", "glow"), number("dim", "blink", "glow", start=2)),
        (number("dim", "blink"), number("blink", "dim")),
        (number("dim", "blink", "glow"), number("blink", "glow", "dim")),
    ],
    ids=["equal-mappings", "swapped", "rearranged"],
)
def test_numbers_that_may_be_names_are_compared_one_by_one(repository, compare, old, new):
    lines = sentences(subject(compare_steps(repository, compare, old, new), PATH))
    assert not [line for line in lines if "renamed" in line]
