"""Topics and options of Python modules that nothing starts are not breaking in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

BUILD_TYPE = "<export><build_type>ament_python</build_type></export></package>"
SETUP = """from setuptools import setup

setup(name='arm', packages=['arm'], entry_points={'console_scripts': ['drive = arm.drive:main']})
"""
MODULE = """import rclpy
from std_msgs.msg import Bool


def main():
    node = rclpy.create_node('trial')
    node.create_publisher(Bool, 'state', 10)
"""
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm").replace("</package>", BUILD_TYPE),
    "arm/setup.py": SETUP,
    "arm/arm/__init__.py": "",
    "arm/arm/drive.py": "def main():\n    pass\n",
    "arm/arm/trial.py": MODULE,
}


@pytest.mark.parametrize(
    ("files", "is_breaking"),
    [
        ({}, False),
        ({"arm/setup.py": SETUP.replace("arm.drive:main'", "arm.drive:main', 'trial = arm.trial:main'")}, True),
        ({"arm/arm/drive.py": "from arm.trial import main\n"}, True),
        ({"README.md": "Run `python3 arm/arm/trial.py`.\n"}, True),
        ({"arm/arm/drive.py": "import importlib\n\n\ndef main():\n    importlib.import_module('x')\n"}, True),
        ({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}, True),
    ],
)
def test_removed_module_without_a_program_breaks_only_its_importers(repository, compare, files, is_breaking):
    repository.commit({**FILES, **files})
    repository.commit({"arm/arm/trial.py": None})
    result = compare(repository, "HEAD~..HEAD")
    line = "publishers removed: 'state' (Bool)"
    assert line in [text for subject in result.subjects for text in sentences(subject)]
    assert (line in breaking(result)) is is_breaking
