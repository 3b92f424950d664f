"""Whole packages: fixes outside descriptions, real robots, and robust package rules."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from linkwright.lint.apply import fix_file
from linkwright.lint.engine import examine_package
from linkwright.lint.package import PackageContext, find_package
from linkwright.lint.settings import Settings
from tests.places import PACKAGE, PUBLISHED, without_meshes

_ALL = Settings(select=("LW8",))
_LAUNCH = """\
# räder
from launch_ros.actions import Node


def generate_launch_description():
    one = Command(["xacro", LaunchConfiguration("model")])
    two = Command([FindExecutable(name='xacro'), LaunchConfiguration('model')])
    three = get_package_share_path("my_robot") / "robot.urdf"
    four = Node(package="rviz2", executable="rviz2")
    return {'robot_description': ParameterValue(Command(['xacro ', one]))}, two
"""
_MANIFEST = """\
<package format="3">
  <name>my_robot</name>
  <depend>xacro</depend> <!-- for the model -->
  <exec_depend>xacro</exec_depend>
</package>
"""
_SETUP = """\
from glob import glob

from setuptools import setup

setup(
    name="my_robot_description",
    version="0.1.0",
    data_files=[
        ("share/my_robot_description/urdf", glob("urdf/*.*")),
        ("share/my_robot_description/urdf/sensors", glob("urdf/sensors/*.*")),
    ],
)
"""


def test_launch_file_and_manifest_are_fixed(tmp_path):
    (tmp_path / "robot.urdf").write_text("<robot name='r'><!-- links: one --><link name='base_link'/></robot>")
    (tmp_path / "package.xml").write_text(_MANIFEST)
    (tmp_path / "launch").mkdir()
    launch = tmp_path / "launch" / "show.launch.py"
    launch.write_text(_LAUNCH, encoding="utf-8")
    settings = Settings(select=("LW809", "LW845", "LW846", "LW848"))
    fix_file(tmp_path / "package.xml", lambda _text: examine_package(tmp_path, settings).diagnostics)
    assert launch.read_text(encoding="utf-8") == _LAUNCH.replace('"xacro", L', '"xacro ", L').replace(
        "name='xacro'), L", "name='xacro'), ' ', L"
    ).replace("['xacro ', one]))", "['xacro ', one]), value_type=str)")
    assert (tmp_path / "package.xml").read_text() == (
        '<package format="3">\n'
        "  <name>my_robot</name>\n"
        "  <depend>xacro</depend> <!-- for the model -->\n"
        "  <exec_depend>rviz2</exec_depend>\n"
        "</package>\n"
    )
    assert not examine_package(tmp_path, settings).diagnostics


def test_shipped_package_has_no_findings():
    assert not examine_package(PACKAGE, Settings()).diagnostics


def copy_with_mistakes(folder: Path) -> Path:
    """Return a copy of the shipped package with the mistakes of the tutorial."""
    package = without_meshes(PACKAGE, folder)
    (package / "setup.py").write_text(_SETUP)
    manifest = package / "package.xml"
    text = manifest.read_text(encoding="utf-8")
    text = re.sub(r'email="[^"]*"', 'email="lll@todo.todo"', text)
    manifest.write_text(re.sub(r"  <exec_depend>.*</exec_depend>\n", "", text), encoding="utf-8")
    return package


@pytest.mark.parametrize("which", ["ours", *(["published"] if PUBLISHED.is_dir() else [])])
def test_tutorial_package_has_known_findings(which, tmp_path):
    package = PUBLISHED if which == "published" else copy_with_mistakes(tmp_path)
    findings = {(diagnostic.code, diagnostic.message) for diagnostic in examine_package(package, _ALL).diagnostics}
    assert ("LW821", "the pattern 'urdf/sensors/*.*' in setup.py matches no file") in findings
    assert ("LW808", "the e-mail address 'lll@todo.todo' is a placeholder") in findings
    assert any(code == "LW848" for code, _ in findings)


def test_package_is_found_by_nearest_manifest_upward(tmp_path):
    (tmp_path / "package.xml").write_text("<package>")
    (tmp_path / "urdf").mkdir()
    package = find_package(tmp_path / "urdf" / "robot.urdf")
    assert package is not None
    assert package.folder == tmp_path
    assert package.manifest is None
    assert package.name == tmp_path.name


def test_package_files_exclude_hidden_build_and_nested_package_files(tmp_path):
    for name in ("package.xml", ".git/x", "build/x", "inner/package.xml", "inner/x", "urdf/a/b.urdf", "urdf/.hidden"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("")
    package = PackageContext(tmp_path)
    assert package.files == ("package.xml", "urdf/a/b.urdf")
    assert package.folders == {"urdf", "urdf/a"}


@pytest.mark.parametrize(
    "text", ["", "<package/>", "<package><name/></package>", "<a><depend/></a>", "\xff", "<package>"]
)
@pytest.mark.parametrize("other", ["", "setup()", "\0", "setup(name=3, data_files=[(1, 2), 3, ('a',)], packages=[1])"])
def test_package_rules_never_raise(tmp_path: Path, text: str, other: str):
    (tmp_path / "package.xml").write_text(text, encoding="latin-1")
    for name in ("setup.py", "CMakeLists.txt", "a.launch.py", "a.rviz", "a.xacro", "setup.cfg"):
        (tmp_path / name).write_text(other)
    examine_package(tmp_path, _ALL)
