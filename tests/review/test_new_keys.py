"""The lines of a review about keys that a program newly reads from YAML files."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

PROGRAM = """import sys

import yaml


def main():
    with open(sys.argv[1]) as file:
        steps = yaml.safe_load(file)["Steps"]
    for step in steps:
        if step["Type"] == "Move":
            move(step["Speed"])
{}

main()
"""
PATH = "arm/scripts/run.py"
YAML = "Steps:\n  - Type: Move\n    Speed: 1\n{}  - Type: Grip\n    Speed: 2\n{}"
DELAY = "    Delay: 1\n"
LINE = "reads the key 'Delay', which is missing in 'arm/programs/template.yaml'"


@pytest.mark.parametrize(
    ("new", "is_breaking"),
    [
        ("        wait(step['Delay'])\n", True),
        ("        if step['Delay'] > 0:\n            wait(step['Delay'])\n", True),
        ("        if 'Delay' in step:\n            wait(step['Delay'])\n", False),
        ("        wait(step.get('Delay', 0))\n", False),
        ("        if step['Type'] == 'Wait':\n            wait(step['Delay'])\n", False),
        ("        try:\n            wait(step['Delay'])\n        except KeyError:\n            pass\n", False),
    ],
)
def test_a_key_that_each_entry_needs_now_is_breaking_for_files_without_it(repository, compare, new, is_breaking):
    files = {"arm/package.xml": PACKAGE_XML, "arm/programs/template.yaml": YAML.format("", "")}
    repository.commit({**files, PATH: PROGRAM.format(""), "arm/programs/demo.yaml": YAML.format("", "")})
    repository.write({PATH: PROGRAM.format(new), "arm/programs/demo.yaml": YAML.format(DELAY, DELAY)})
    assert breaking(compare(repository)) == [LINE] * is_breaking


def test_a_key_that_all_files_have_and_files_of_other_programs_break_nothing(repository, compare):
    files = {"arm/package.xml": PACKAGE_XML, "arm/config/rooms.yaml": "rooms:\n  - Type: Kitchen\n    Floor: 1\n"}
    repository.commit({**files, PATH: PROGRAM.format(""), "arm/programs/demo.yaml": YAML.format(DELAY, DELAY)})
    repository.write({PATH: PROGRAM.format("        wait(step['Delay'])\n")})
    assert breaking(compare(repository)) == []
