"""Values of parameter files with another name and the same value in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}


@pytest.fixture
def review_values(repository, compare):
    """Review other values below a node, and return the lines."""

    def run(old, new):
        text = "driver:\n  ros__parameters:\n    rate: 10\n"
        repository.commit({**MANIFEST, "arm/config/arm.yaml": text + "".join(f"    {line}\n" for line in old)})
        repository.write({"arm/config/arm.yaml": text + "".join(f"    {line}\n" for line in new)})
        return [line for subject in compare(repository).subjects for line in sentences(subject)]

    return run


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("serial_port: 4", "port: 4"),
        ("angle_min: -1.5", "min_ang: -1.5"),
        ("maxSpeed: 2.0", "max_speed: 2.0"),
        ("offset: 0.0", "offset_x: 0.0"),
    ],
)
def test_a_value_with_another_name_is_renamed(review_values, old, new):
    names = [f"driver.ros__parameters.{line.partition(':')[0]}" for line in (old, new)]
    assert review_values([old], [new]) == [f"{names[0]} renamed to {names[1]}, with the same value"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (["serial_port: 4"], ["port: 5"]),  # another value
        (["max_speed: 2.0"], ["max_turn: 2.0"]),
        (["max_speed: 2.0"], ["min_speed: 2.0"]),
        (["speed_x: 2.0"], ["speed_y: 2.0"]),
        (["offset: 0.0"], ["offset_x: 0.0", "offset_y: 0.0"]),  # two of them
        (["hand: {port: 4}"], ["port: 4"]),  # another part
    ],
)
def test_other_values_are_removed_and_added(review_values, old, new):
    assert not any("renamed" in line for line in review_values(old, new))


def test_values_that_are_renamed_share_a_line(review_values):
    lines = review_values(["serial_port: 4", "angle_min: -1"], ["port: 4", "min_ang: -1"])
    assert len(lines) == 1


@pytest.mark.parametrize(("count", "is_renamed"), [(30, True), (31, False)])
def test_many_equal_values_are_not_paired(review_values, count, is_renamed):
    words = [f"gain{chr(97 + number // 26)}{chr(97 + number % 26)}" for number in range(count)]
    lines = review_values([f"{word}_{word[::-1]}: 0.5" for word in words], [f"{word}: 0.5" for word in words])
    assert any("with the same value" in line for line in lines) is is_renamed
