"""Manifests have an error exactly if catkin_pkg, which colcon uses, rejects them."""

from __future__ import annotations

import warnings

import pytest
from catkin_pkg.package import InvalidPackage, parse_package_string

from linkwright.diagnostics import has_errors
from linkwright.lint.engine import examine_package
from linkwright.lint.settings import Settings

pytestmark = pytest.mark.extra("colcon")

_VALUES_BY_TAG = {
    "name": [
        *("my_robot", "depthai-ros", "My-Robot", "MyRobot", "2d_nav", "a", "a__b", "class", "my robot", "my.robot"),
        *("_robot", "-robot", "räder", "", " my_robot "),
    ],
    "version": ["0.1.0", "1.0", "01.0.0", "1.0.0-rc1", "1.2.3.4", "", " 1.0.0 "],
    "description": ["A robot.", "", "<b>A robot.</b>"],
    "license": ["MIT", "", "Apache License 2.0"],
}
_REMAINDERS = [
    '<maintainer email="a@b.cc"/>',
    '<maintainer email="a@b.cc"></maintainer>',
    '<maintainer email="a@b.c">A</maintainer>',
    '<maintainer email="first.last@my-lab.example.org">A</maintainer>',
    '<maintainer email="me@localhost">A</maintainer>',
    '<maintainer email="">A</maintainer>',
    "<maintainer>A</maintainer>",
    '<maintainer email="a@b.cc">A</maintainer><maintainer email="x">B</maintainer>',
    '<maintainer email="a@b.cc">A</maintainer><author>B</author>',
    '<maintainer email="a@b.cc">A</maintainer><author email="x">B</author>',
    '<maintainer email="a@b.cc">A</maintainer><license></license>',
    '<maintainer email="a@b.cc">A</maintainer><exec_depend>xacro</exec_depend>',
    '<maintainer email="a@b.cc">A</maintainer><exec_depend>my_robot</exec_depend>',
    '<maintainer email="a@b.cc">A</maintainer><group_depend>g</group_depend><member_of_group>h</member_of_group>',
]


def _make_manifest(remainder: str = '<maintainer email="lee@my-lab.org">Lee</maintainer>', **values: str | None) -> str:
    values_by_tag = {"name": "my_robot", "version": "0.1.0", "description": "A robot.", "license": "MIT", **values}
    elements = "".join(f"<{tag}>{text}</{tag}>" for tag, text in values_by_tag.items() if text is not None)
    return f'<package format="3">{elements}{remainder}</package>'


_CASES = [
    *(_make_manifest(**{tag: text}) for tag, texts in _VALUES_BY_TAG.items() for text in (*texts, None)),
    *map(_make_manifest, _REMAINDERS),
    _make_manifest("").replace("package", "pkg"),
]


@pytest.mark.parametrize("text", _CASES)
def test_manifest_errors_match_catkin_pkg(tmp_path, text):
    (tmp_path / "package.xml").write_text(text, encoding="utf-8")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # catkin_pkg's own deprecations
            parse_package_string(text)
        is_refused = False
    except InvalidPackage:
        is_refused = True
    findings = examine_package(tmp_path, Settings(select=("LW8",))).diagnostics
    assert has_errors(findings) == is_refused, [finding.message for finding in findings]
