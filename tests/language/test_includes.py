"""The descriptions that include a file, if several files have the same name."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.language.includes import IncludeIndex, real_path
from linkwright.lint.inclusions import Inclusion, inclusions_in

WHEEL = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="wheel"/></robot>'


def write_package(folder: Path, **files: str) -> None:
    """Write a package with files in its folder ``urdf``."""
    (folder / "urdf").mkdir(parents=True)
    (folder / "package.xml").write_text(f"<package><name>{folder.name}</name></package>")
    for name, text in files.items():
        (folder / "urdf" / f"{name}.xacro").write_text(text)


def include_element(filename: str) -> str:
    return f'<robot name="r"><xacro:include filename="{filename}"/><link name="base"/></robot>'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_package(tmp_path / "rover", robot=include_element("$(find rover)/urdf/wheel.xacro"), wheel=WHEEL)
    write_package(tmp_path / "cart", robot=include_element("wheel.xacro"), wheel=WHEEL)
    write_package(tmp_path / "tool", robot=include_element("$(find other)/urdf/wheel.xacro"))
    return real_path(tmp_path)


@pytest.fixture
def index(folder: Path) -> IncludeIndex:
    index = IncludeIndex([folder])
    index.refresh()
    return index


def file_names(folder: Path, files: list[Path]) -> list[str]:
    return sorted(str(file.relative_to(folder)) for file in files)


@pytest.mark.parametrize("package", ["rover", "cart"])
def test_include_is_resolved_within_its_own_package(folder, index, package):
    file = folder / package / "urdf" / "wheel.xacro"
    assert file_names(folder, index.entries(file, {})) == [f"{package}/urdf/robot.xacro"]
    assert file_names(folder, index.related_files(file, {})) == [
        f"{package}/urdf/robot.xacro",
        f"{package}/urdf/wheel.xacro",
    ]


def test_related_files_start_with_the_file_and_its_includes(tmp_path):
    arms = "".join(f'<xacro:include filename="{name}.xacro"/>' for name in ("left", "right", "middle"))
    write_package(
        tmp_path / "arms",
        left=WHEEL,
        right=WHEEL,
        middle=WHEEL,
        one=f"<robot>{arms}</robot>",
        two=f"<robot>{arms}</robot>",
    )
    index = IncludeIndex([real_path(tmp_path)])
    index.refresh()
    folder = real_path(tmp_path) / "arms" / "urdf"
    related = index.related_files(folder / "one.xacro", {})
    assert [file.stem for file in related] == ["one", "middle", "right", "left"]
    assert index.related_files(folder / "left.xacro", {})[0] == folder / "left.xacro"


def test_unknown_package_does_not_match_known_files(folder, index):
    file = folder / "tool" / "urdf" / "robot.xacro"
    assert index.related_files(file, {}) == [file]
    installed = Path("/opt/other/urdf/wheel.xacro")
    assert index.entries(installed, {installed: WHEEL}) == [file]


def test_include_installed_elsewhere_is_matched_by_name(folder, index):
    text = include_element("$(find rover)/description/wheel.xacro")  # CMakeLists.txt may install urdf/ in description/
    main = folder / "rover" / "urdf" / "robot.xacro"
    wheel = folder / "rover" / "urdf" / "wheel.xacro"
    assert index.entries(wheel, {main: text}) == [main]


def test_roots_are_files_that_no_file_includes(folder, index):
    assert [file.name for file in index.roots({})] == ["robot.xacro"] * 3


@pytest.mark.parametrize(
    ("filename", "inclusion"),
    [
        ("$(find a_b)/urdf/c.xacro", Inclusion("a_b", "urdf/c.xacro")),
        ("../c.xacro", Inclusion("", "../c.xacro")),
        ("$(arg kind)/c.xacro", Inclusion("", "big/c.xacro", r"[^/]*/c\.xacro")),
        ("$(find $(arg kind))/c.xacro", Inclusion("big", "c.xacro", r"c\.xacro")),
        ("${folder}/c.xacro", Inclusion("", "${folder}/c.xacro", r"[^/]*/c\.xacro")),
    ],
)
def test_include_is_read_without_expansion(filename, inclusion):
    text = f'<robot><xacro:arg name="kind" default="big"/><xacro:include filename="{filename}"/></robot>'
    assert [*inclusions_in(text)] == [inclusion]
    assert inclusion.name == "c.xacro"
