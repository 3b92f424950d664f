"""The lines of a review about functions that return another number of values, and about helpers of launch files."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MODULE = """def read_login(path):
    if not path:
        return "", "", 0
    return "user", "host", 1


def read_size(path):
    return 1, 2
"""
CHANGED = MODULE.replace('"", "", 0', '"", "", 0, ""').replace('"host", 1', '"host", 1, "name"')
IMPORT = "from arm.login import read_login, read_size\n"
MODULE_PATH, CALLER_PATH = "arm/arm/login.py", "arm/launch/arm.launch.py"
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/setup.py": "from setuptools import setup\n\nsetup(name='arm', packages=['arm'])\n",
    "arm/arm/__init__.py": "",
}
TOLD = "function 'read_login': number of returned values 3 -> 4"
LEFT = f"unpacks 3 values of 'read_login' of '{MODULE_PATH}', which returns 4 now"


@pytest.mark.parametrize("head", ["", "from launch_ros.actions import Node\n"])
def test_a_function_that_returns_more_values_breaks_the_files_that_unpack_them(repository, compare, head):
    caller = f"{IMPORT}user, host, port = read_login('a')\nwidth, height = read_size('a')\n"
    repository.commit({**FILES, MODULE_PATH: head + MODULE, CALLER_PATH: caller})
    repository.write({MODULE_PATH: head + CHANGED})
    result = compare(repository)
    assert TOLD in sentences(subject(result, MODULE_PATH))
    assert breaking(result) == [TOLD, LEFT]


@pytest.mark.parametrize(
    "statement", ["values = read_login('a')", "user, *rest = read_login('a')", "a, b, c, d = read_login('a')"]
)
def test_a_file_that_takes_any_number_of_values_still_works(repository, compare, statement):
    repository.commit({**FILES, MODULE_PATH: MODULE, CALLER_PATH: f"{IMPORT}{statement}\n"})
    repository.write({MODULE_PATH: CHANGED})
    assert breaking(compare(repository)) == [TOLD]


def test_a_function_that_sometimes_returns_something_else_has_no_certain_number(repository, compare):
    repository.commit({**FILES, MODULE_PATH: MODULE})
    repository.write({MODULE_PATH: CHANGED.replace('return "", "", 0, ""', "return read_size(path)")})
    assert breaking(compare(repository)) == []


def test_other_arguments_of_a_helper_of_launch_files_are_told(repository, compare):
    head = "from launch_ros.actions import Node\n"
    repository.commit({**FILES, MODULE_PATH: head + MODULE})
    repository.write({MODULE_PATH: head + MODULE.replace("read_size(path)", "read_size(path, unit)")})
    assert breaking(compare(repository)) == ["function 'read_size': arguments (path) -> (path, unit)"]
