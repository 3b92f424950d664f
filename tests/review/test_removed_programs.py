"""The lines of a review about removed programs: their options, and the names of their nodes."""

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


@pytest.mark.parametrize(("line", "is_breaking"), [("", False), ("node.create_publisher(String, 'state', 10)", True)])
def test_node_that_only_sends_requests_is_not_missed(repository, compare, line, is_breaking):
    text = f"""import rclpy
from gazebo_msgs.srv import SpawnEntity
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node('spawn_camera')
client = node.create_client(SpawnEntity, '/spawn_entity')
{line}
"""
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/arm/spawn.py": text})
    repository.write({"arm/arm/spawn.py": None})
    found = breaking(compare(repository))
    assert ("nodes removed: 'spawn_camera'" in found) is is_breaking
