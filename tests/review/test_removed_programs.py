"""The lines of a review about the options of removed programs."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PROGRAM = """import argparse
parser = argparse.ArgumentParser()
parser.add_argument('--speed', default=1.0)
args = parser.parse_args()
"""
INSTALLED = "project(arm)\ninstall(PROGRAMS {}scripts/b.py DESTINATION lib/${{PROJECT_NAME}})\n"


@pytest.mark.parametrize(
    ("old_name", "expected"),
    [
        ("scripts/go.py ", ["installed executables removed: 'go.py'"]),
        ("", ["command-line options removed: '--speed' (1.0)"]),
    ],
)
def test_options_are_not_breaking_beside_the_removal_of_their_program(repository, compare, old_name, expected):
    program = "arm/scripts/go.py"
    build = {"arm/CMakeLists.txt": INSTALLED.format(old_name), "arm/scripts/b.py": "print(1)\n"}
    repository.commit({**MANIFEST, **build, program: PROGRAM})
    repository.write({"arm/CMakeLists.txt": INSTALLED.format(""), program: None})
    result = compare(repository)
    assert breaking(result) == expected
    (found,) = (subject for subject in result.subjects if subject.path == program)
    assert [str(change.sentence) for change in found.changes] == ["command-line options removed: '--speed' (1.0)"]
