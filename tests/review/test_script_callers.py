"""Arguments in scripts and launch files that programs no longer read, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

READING = "#!/usr/bin/env python3\nimport sys\naddress = sys.argv[1]\n"
IGNORING = "#!/usr/bin/env python3\nimport rospy\naddress = rospy.get_param('~address')\n"
PARSING = """import argparse
p = argparse.ArgumentParser()
p.add_argument("--port")
p.add_argument("--rate")
p.parse_args()
"""
SCRIPT = "arm/scripts/driver.py"
MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
IGNORED = "arguments are passed to 'driver.py', which no longer reads them"


@pytest.mark.parametrize(
    ("path", "text", "is_breaking"),
    [
        ("start.sh", "python3 arm/scripts/driver.py $1 $2\n", True),
        ("start.sh", "rosrun arm driver.py 10.0.0.1 &\n", True),
        ("start.sh", "python3 driver.py 10.0.0.1 > log\n", True),
        ("start.sh", "python3 arm/scripts/driver.py > log\n", False),
        ("start.sh", "rosrun arm driver.py _rate:=5 # the driver\n", False),
        ("start.sh", "# python3 arm/scripts/driver.py $1\n", False),
        ("start.sh", "python3 other/driver.py $1\n", False),
        ("arm/arm.launch", '<launch><node pkg="arm" type="driver.py" name="d" args="10.0.0.1"/></launch>', True),
        ("arm/arm.launch", '<launch><node pkg="arm" type="driver.py" name="d" args="a:=b"/></launch>', False),
    ],
)
def test_arguments_that_a_program_no_longer_reads_are_lost(repository, compare, path, text, is_breaking):
    repository.commit({**MANIFEST, SCRIPT: READING, path: text})
    repository.write({SCRIPT: IGNORING})
    assert (IGNORED in breaking(compare(repository))) == is_breaking


@pytest.mark.parametrize("new", [READING.replace("[1]", "[2]"), PARSING])
def test_a_program_that_still_reads_arguments_is_not_reported(repository, compare, new):
    repository.commit({**MANIFEST, SCRIPT: READING, "start.sh": "python3 arm/scripts/driver.py $1\n"})
    repository.write({SCRIPT: new})
    assert IGNORED not in breaking(compare(repository))


@pytest.mark.parametrize(("word", "is_breaking"), [("--port=1", True), ("--rate 1", False), ("--other 1", False)])
@pytest.mark.parametrize("path", ["start.sh", "Makefile", ".github/workflows/ci.yml"])
def test_a_command_that_passes_a_removed_option_fails(repository, compare, path, word, is_breaking):
    repository.commit({**MANIFEST, SCRIPT: PARSING, path: f"python3 arm/scripts/driver.py {word}\n"})
    repository.write({SCRIPT: PARSING.replace('p.add_argument("--port")\n', "")})
    assert ("'--port' is passed to 'driver.py'" in breaking(compare(repository))) == is_breaking
