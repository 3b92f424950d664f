"""Options that launch files pass to scripts of the repository, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML

SCRIPT = """#!/usr/bin/env python3
import argparse

parser = argparse.ArgumentParser()
parser.add_argument("-p", "--port", "--serial-port")
parser.add_argument("--rate", default=10)
args = parser.parse_args()
"""
LAUNCH = """<launch>
  <node pkg="arm" exec="driver.py" args="--port /dev/ttyUSB0 --ra 5"/>
</launch>
"""


@pytest.fixture
def review_reasons(repository, compare):
    """Review a new script and a new launch file.

    Return the breaking changes of the launch file with their reasons.
    """

    def run(script: str, launch: str = LAUNCH):
        manifest = PACKAGE_XML.replace("arm_description", "arm")
        path = "arm/launch/arm.launch.xml"
        repository.commit({"arm/package.xml": manifest, "arm/scripts/driver.py": SCRIPT, path: LAUNCH})
        repository.write({"arm/scripts/driver.py": script, path: launch})
        changes = [change for subject, change in compare(repository).breaking_changes if subject.path == path]
        return {str(change.sentence): str(change.reason) for change in changes}

    return run


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"--port", "--serial-port"', '"--device"'),
        ('"-p", "--port", "--serial-port"', '"port"'),
        ('add_argument("-p", "--port", "--serial-port")', 'add_argument("--no-port", action="store_true")'),
    ],
)
def test_option_that_a_script_no_longer_accepts_is_breaking_where_it_is_passed(review_reasons, old, new):
    assert review_reasons(SCRIPT.replace(old, new)) == {
        "'--port' is passed to 'driver.py'": "'driver.py' does not accept '--port'"
    }


def test_option_that_a_launch_file_begins_to_pass_must_be_accepted(review_reasons):
    assert review_reasons(SCRIPT, LAUNCH.replace("--port", "--tty"))["'--tty' is passed to 'driver.py'"] == (
        "'driver.py' does not accept '--tty'"
    )


def test_option_that_a_script_requires_must_be_passed(review_reasons):
    script = SCRIPT.replace("args =", 'parser.add_argument("--name", required=True)\nargs =')
    assert review_reasons(script) == {"'--name' is not passed to 'driver.py'": "'driver.py' requires '--name'"}
    assert review_reasons(script, LAUNCH.replace("--port", "--name=a --port")) == {}


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"--port", "--serial-port"', '"--serial-port", "--port"'),
        ("parse_args()", "parse_known_args()"),
        ("args = parser", "add_more(parser)\nargs = parser"),
        ('"--port", "--serial-port"', "NAME"),
        ('"--rate"', '"--rates"'),
    ],
)
def test_option_that_a_script_may_accept_is_not_breaking(review_reasons, old, new):
    text = SCRIPT.replace('"--rate"', '"--speed"') if "parse" in old else SCRIPT
    assert review_reasons(text.replace(old, new)) == {}
