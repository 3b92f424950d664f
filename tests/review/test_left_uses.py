"""Descriptions that still include a removed file or call a removed macro, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

XACRO = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>\n'
TRACK = XACRO.format('<xacro:macro name="track" params="side"><link name="${side}_track"/></xacro:macro>')
INCLUDE = '<xacro:include filename="$(find arm_description)/urdf/track.xacro"/>'
CALL = '<xacro:macro name="base" params=""><xacro:track side="left"/></xacro:macro>'
FILES = {
    "a/package.xml": PACKAGE_XML,
    "a/urdf/track.xacro": TRACK,
    "a/urdf/base.xacro": XACRO.format(INCLUDE + CALL),
}
FAILS = "descriptions that use the file cannot be expanded"
INCLUDES_REMOVED = f"includes '$(find arm_description)/urdf/track.xacro', which was removed: {FAILS}"


def find_uses(result):
    """Return the changes to files that cannot be expanded any more, with their reasons."""
    changes = [f"{change.sentence}: {change.reason}" for _, change in result.breaking_changes]
    return [item for item in changes if item.endswith(f": {FAILS}")]


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"a/urdf/track.xacro": None}, [INCLUDES_REMOVED]),
        ({"a/urdf/track.xacro": None, "a/urdf/tracks.xacro": TRACK},
         ["includes '$(find arm_description)/urdf/track.xacro', which is now a/urdf/tracks.xacro: " + FAILS]),
        ({"a/urdf/track.xacro": TRACK.replace('"track"', '"tracks"')},
         [f"calls the macro 'track', which no longer exists: {FAILS}"]),
        ({"a/urdf/base.xacro": XACRO.format('<xacro:include filename="track.xacro"/>' + CALL),
          "a/urdf/track.xacro": None},
         [f"includes 'track.xacro', which was removed: {FAILS}"]),
        ({"a/urdf/track.xacro": XACRO.format(""), "a/urdf/other.xacro": TRACK},
         [f"calls the macro 'track', which no included file defines any more: {FAILS}"]),
        ({"a/urdf/track.xacro": None, "a/urdf/base.xacro": XACRO.format("")}, []),
        ({"a/urdf/track.xacro": XACRO.format('<xacro:include filename="other.xacro"/>'), "a/urdf/other.xacro": TRACK},
         []),
    ],
)  # fmt: skip
def test_macro_file_that_uses_a_lost_file_or_macro_is_breaking(repository, compare, changes, expected):
    old = dict(FILES)
    if "a/urdf/base.xacro" in changes and "track.xacro" in changes["a/urdf/base.xacro"]:
        old["a/urdf/base.xacro"] = changes["a/urdf/base.xacro"]
    repository.commit(old)
    repository.commit({path: text for path, text in changes.items() if old.get(path) != text})
    assert find_uses(compare(repository, "HEAD~1..HEAD")) == expected


def test_robot_that_cannot_be_read_is_named_once(repository, compare):
    repository.commit(
        {
            **FILES,
            "a/urdf/base.xacro": XACRO.replace("<robot", '<robot name="r"').format(INCLUDE + '<link name="base"/>'),
        }
    )
    repository.commit({"a/urdf/track.xacro": None})
    result = compare(repository, "HEAD~1..HEAD")
    assert not find_uses(result)
    assert any(item.startswith("can no longer be read") for item in breaking(result))


@pytest.mark.parametrize(
    "expression",
    [
        '"-r " + os.path.join(share, "worlds", "a.sdf")',
        'f"-r {share}/worlds/a.sdf"',
        "\"-v4 \" f\"{Path(share) / 'worlds' / 'a.sdf'}\"",
    ],
)
def test_launch_file_with_a_path_in_a_command_line_is_named(repository, compare, expression):
    launch = f"""import os
from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import SetLaunchConfiguration


def generate_launch_description():
    share = get_package_share_directory("arm_description")
    return LaunchDescription([SetLaunchConfiguration("gz_args", {expression})])
"""
    world = '<sdf version="1.9"><world name="w"/></sdf>\n'
    build = "project(arm_description)\ninstall(DIRECTORY worlds launch DESTINATION share/arm_description)\n"
    repository.commit(
        {
            "a/package.xml": PACKAGE_XML,
            "a/CMakeLists.txt": build,
            "a/launch/a.launch.py": launch,
            "a/worlds/a.sdf": world,
        }
    )
    repository.commit({"a/worlds/a.sdf": None, "a/worlds/b.sdf": world})
    found = breaking(compare(repository, "HEAD~1..HEAD"))
    assert any(item.startswith("names 'worlds/a.sdf' of 'arm_description', which no longer exists") for item in found)
