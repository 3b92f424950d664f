"""Reviews of removed Python scripts that nothing installs as a program or names."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

SCRIPT = """import argparse

import rclpy
from geometry_msgs.msg import Twist


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--port")
    parser.parse_args()
    node = rclpy.create_node("teleop")
    node.create_publisher(Twist, "cmd_vel", 10)


if __name__ == "__main__":
    main()
"""
SETUP = """from setuptools import setup

setup(name="arm", packages=["arm"], entry_points={"console_scripts": [ENTRY]})
"""
EXPORT = "<export><build_type>ament_python</build_type></export>"
PATH = "arm/arm/drive_test.py"


@pytest.mark.parametrize(
    ("entry", "more", "is_breaking"),
    [
        ("", {}, False),
        ("", {"arm/README.md": "# Tests of driving"}, False),
        ('"drive = arm.drive_test:main"', {}, True),
        ("", {"README.md": "Start `python3 arm/arm/drive_test.py`."}, True),
        ("", {"arm/arm/all.py": "from arm.drive_test import main\n"}, True),
    ],
)
def test_names_of_a_script_that_nothing_names_are_not_missed(repository, compare, entry, more, is_breaking):
    package = PACKAGE_XML.replace("arm_description", "arm").replace("</package>", f"{EXPORT}</package>")
    setup = {"arm/setup.py": SETUP.replace("ENTRY", entry), "arm/arm/__init__.py": ""}
    repository.commit({"arm/package.xml": package, PATH: SCRIPT, **setup, **more})
    repository.write({PATH: None})
    lost = [line for line in breaking(compare(repository)) if line.startswith(("publishers", "nodes", "command-line"))]
    assert len(lost) == (3 if is_breaking else 0)


@pytest.mark.parametrize("is_started", [False, True])
def test_names_of_a_changed_script_are_missed_if_a_file_starts_it_now(repository, compare, is_started):
    package = PACKAGE_XML.replace("arm_description", "arm").replace("</package>", f"{EXPORT}</package>")
    setup = {"arm/setup.py": SETUP.replace("ENTRY", ""), "arm/arm/__init__.py": ""}
    repository.commit({"arm/package.xml": package, PATH: SCRIPT, **setup})
    start = {"start.sh": "python3 arm/arm/drive_test.py\n"} if is_started else {}
    repository.write({PATH: SCRIPT.replace('"--port"', '"--device"'), **start})
    assert bool(breaking(compare(repository))) == is_started
