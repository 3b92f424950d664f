"""Launch files that newly call a function of their package which raises an error."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

CHECKS = """class Checks:
    @staticmethod
    def check(values):
        if "name" not in values:
            raise ValueError("a name is missing")

    def check_file(self, path):
        if not path.exists():
            raise FileNotFoundError(path)


def check_all(values):
    Checks.check(values)


def check_count(values):
    if len(values) > 9:
        raise ValueError("too many values")
    print(values)
"""
LAUNCH = """from launch import LaunchDescription
from arm.checks import Checks, check_all, check_count


def generate_launch_description():
    values = read("values.yaml")
    CALL
    return LaunchDescription([])
"""


@pytest.mark.parametrize(
    ("old", "new", "conditions"),
    [
        ("pass", "Checks.check(values)", "`'name' not in values`"),
        ("pass", "Checks().check(values)\n    check_count(values)", "`'name' not in values`, `len(values) > 9`"),
        ("check_count(values)", "check_count(values[1:])", None),
        ("pass", "Checks().check_file(values)", None),
        ("pass", "check_all(values)", None),
    ],
)
def test_condition_of_an_error_that_a_called_function_raises_is_breaking(repository, compare, old, new, conditions):
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/arm/__init__.py": ""}
    repository.commit({**files, "arm/launch/arm.launch.py": LAUNCH.replace("CALL", old)})
    repository.write({"arm/launch/arm.launch.py": LAUNCH.replace("CALL", new), "arm/arm/checks.py": CHECKS})
    lines = [line for line in breaking(compare(repository)) if "raises errors" in line]
    assert lines == ([] if conditions is None else [f"'checks.py' raises errors now if {conditions}"])
