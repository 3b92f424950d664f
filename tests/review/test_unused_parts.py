"""Removed files of descriptions that nothing could use, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject


@pytest.mark.parametrize(
    ("installed", "include", "is_breaking"),
    [
        ("urdf", "", True),
        ("config", "", False),
        ("config", '<xacro:include filename="$(find arm_description)/urdf/cap.xacro"/>', True),
        ("config", '<xacro:include filename="$(find arm_description)/other/cap.xacro"/>', False),
        ("config", '<xacro:include filename="$(find arm_description)/urdf/${kind}.xacro"/>', True),
    ],
)
def test_removed_part_that_nothing_could_use_breaks_nothing(package, compare, installed, include, is_breaking):
    part = "arm_description/urdf/cap.xacro"
    build = (
        f"project(arm_description)\ninstall(DIRECTORY {installed} DESTINATION share/arm_description)\nament_package()\n"
    )
    macros = f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{include}<xacro:macro name="other"/></robot>'
    package.commit(
        {
            "arm_description/CMakeLists.txt": build,
            "arm_description/config/a.yaml": "a: 1\n",
            "arm_description/urdf/macros.xacro": macros,
            part: '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="cap"/></robot>',
        }
    )
    package.write({part: None})
    result = compare(package)
    assert any("removed" in sentence for sentence in sentences(subject(result, part)))
    assert any("removed" in sentence for sentence in breaking(result)) == is_breaking


@pytest.mark.parametrize(("count", "is_told"), [(2, False), (1, True)])
def test_an_include_that_a_file_has_twice_changes_nothing_if_one_leaves(package, compare, count, is_told):
    path = "arm_description/urdf/tools.xacro"
    include = '<xacro:include filename="$(find arm_description)/urdf/segment.xacro"/>'
    macro = '<xacro:macro name="tool"><link name="t"/></xacro:macro>'
    text = f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{{}}{macro}</robot>'
    package.commit({path: text.format(include * count)})
    package.write({path: text.format(include * (count - 1))})
    assert any(item.path == path for item in compare(package).subjects) == is_told
