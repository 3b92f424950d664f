"""The lines of a review about launch files in Python that import what does not exist."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

LAUNCH = """from launch import LaunchDescription


def generate_launch_description():
    return LaunchDescription([])
"""
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/setup.py": 'from setuptools import setup\n\nsetup(name="arm", version="1.0.0", packages=["arm"])\n',
    "arm/arm/__init__.py": "",
    "arm/arm/tools.py": "LENGTH = 1\n",
}
MISSING = "imports 'grips', which the package 'arm' does not have"
UNDECLARED = "imports the package 'nav2_common', which no package.xml names"


def review_import(repository, compare, statement, files, old=None):
    repository.commit({**FILES, **files, **({"arm/launch/arm.launch.py": old} if old else {})})
    repository.write({"arm/launch/arm.launch.py": f"{statement}\n{LAUNCH}"})
    result = compare(repository)
    found = sentences(subject(result, "arm/launch/arm.launch.py"))
    return [line for line in found if line.startswith("imports ") and "added" not in line], breaking(result)


@pytest.mark.parametrize("old", [None, LAUNCH])
@pytest.mark.parametrize(
    ("statement", "files", "is_missing"),
    [
        ("from arm.grips import close", {}, True),
        ("import arm.grips", {}, True),
        ("from arm.tools import LENGTH", {}, False),
        ("from arm.msg import Grip", {}, False),
        ("from arm import grips", {}, False),
        ("from hand.grips import close", {}, False),
        ("try:\n    import arm.grips\nexcept ImportError:\n    pass", {}, False),
        ("import arm.grips", {"arm/arm/grips/close.py": ""}, False),
        ("import arm.grips", {"arm/src/grips.pyx": ""}, False),
        ("import arm.grips", {"arm/CMakeLists.txt": "project(arm)\npybind11_add_module(grips grips.cpp)\n"}, False),
        ("import arm.grips", {"arm/CMakeLists.txt": "project(arm)\nconfigure_file(a.in ${FILE})\n"}, False),
    ],
)
def test_a_launch_file_that_imports_a_missing_module_fails(repository, compare, statement, files, is_missing, old):
    found, failures = review_import(repository, compare, statement, files, old)
    assert (MISSING in found) == is_missing
    assert (MISSING in failures) == (is_missing and old is not None)  # an added launch file has no users yet


def test_a_missing_module_that_the_old_version_imports_is_not_new(repository, compare):
    statement = "import arm.grips"
    found, _ = review_import(repository, compare, f"{statement}\nimport numpy", {}, f"{statement}\n{LAUNCH}")
    assert found == []


@pytest.mark.parametrize(
    ("statement", "manifest", "expected"),
    [
        ("from nav2_common.launch import RewrittenYaml", "", [UNDECLARED]),
        ("from nav2_common.launch import RewrittenYaml", "<exec_depend>nav2_common</exec_depend></package>", []),
        ("try:\n    import nav2_common\nexcept ImportError:\n    pass", "", []),
        ("import numpy", "", []),
    ],
)
def test_an_added_launch_file_that_imports_an_undeclared_package_is_told(
    repository, compare, statement, manifest, expected
):
    text = FILES["arm/package.xml"]
    files = {"arm/package.xml": text.replace("</package>", manifest) if manifest else text}
    found, failures = review_import(repository, compare, statement, files)
    assert (found, failures) == (expected, [])
