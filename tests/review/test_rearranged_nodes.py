"""The lines of a review about YAML files whose lists or numbered entries only have other keys."""

from __future__ import annotations

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

PATH = "arm/config/a.yaml"
STEPS = ["{Type: Move, Speed: 1, Joint: 2}", "{Type: Turn, Angle: 3, Speed: 2}", "{Type: Open, Width: 4, Force: 1}"]
GRIPPERS = ["{name: a, x: 1}", "{name: b, x: 2}", "{name: c, x: 3}", "{name: d, x: 4}"]


def review(repository, compare, old, new):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: old})
    repository.write({PATH: new})
    return sentences(subject(compare(repository), PATH))


def write_list(items, indent=""):
    return "".join(f"{indent}- {item}\n" for item in items)


def write_map(numbers):
    return "grippers:\n" + "".join(f"  {number}: {GRIPPERS[index]}\n" for index, number in enumerate(numbers))


def test_a_list_that_moves_below_a_key_is_compared_item_by_item(repository, compare):
    new = "robot: arm\nsteps:\n" + write_list(["{Type: Wait, Delay: 5}", *STEPS[:2]], "  ")
    assert review(repository, compare, write_list(STEPS), new) == [
        "the list moved to steps",
        "robot arm added",
        "steps[0] added: Type Wait, Delay 5",
        "steps[old 2] removed: Type Open, Width 4, Force 1",
    ]


def test_another_list_below_a_key_has_not_moved(repository, compare):
    lines = review(repository, compare, write_list(STEPS), "rooms:\n" + write_list(["{Floor: 1}", "{Floor: 2}"], "  "))
    assert "the list moved to rooms" not in lines


def test_renumbered_entries_are_one_line(repository, compare):
    assert review(repository, compare, write_map([0, 1, 2, 3]), write_map([2, 0, 1, 3])) == [
        "entries of grippers renumbered: a 0 -> 2, b 1 -> 0, c 2 -> 1"
    ]


def test_entries_with_other_values_are_not_renumbered(repository, compare):
    new = write_map([2, 0, 1, 3]).replace("x: 4", "x: 5")
    assert not any("renumbered" in line for line in review(repository, compare, write_map([0, 1, 2, 3]), new))
