"""``package.xml``: completion, hover and definition."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.language.formats import Place, make_packages


@pytest.fixture
def position_at(tmp_path: Path):
    folder = make_packages(tmp_path)
    return lambda text: Place(folder / "package.xml", f'<package format="3"><name>lamp_bringup</name>{text}</package>')


def test_dependency_completion_omits_declared_packages(position_at):
    assert position_at("<buildtool_depend>|</buildtool_depend>").labels()[0] == "ament_cmake"
    assert position_at("<exec_depend>lamp|</exec_depend>").labels() == ["lamp_nodes"]
    assert position_at("<depend>lamp_nodes</depend><exec_depend>lamp|</exec_depend>").labels() == []
    assert position_at("<test_depend>\n    ament_l|</test_depend>").labels()[0] == "ament_lint_auto"


def test_packages_used_in_launch_files_come_first(position_at):
    place = position_at("<exec_depend>|</exec_depend>")
    launch = place.document.file.parent / "launch" / "a.launch.xml"
    launch.write_text('<launch><node pkg="lamp_nodes" exec="blink"/><node pkg="rviz2" exec="rviz2"/></launch>')
    assert set(place.labels()[:2]) == {"lamp_nodes", "rviz2"}


def test_texts_and_attribute_values_are_completed(position_at):
    assert position_at("<export><build_type>|</build_type></export>").labels()[:2] == ["ament_cmake", "ament_python"]
    assert position_at("<license>|</license>").labels()[0] == "Apache-2.0"
    assert position_at('<url type="|">').labels() == ["website", "bugtracker", "repository"]


def test_single_occurrence_elements_are_offered_once(position_at):
    assert position_at("<|").labels()[0] == "version"
    assert "name" not in position_at("|").labels()
    assert position_at("<export><build|").labels() == ["build_type"]


def test_dependency_has_hover_and_definition(position_at):
    place = position_at("<exec_depend>lamp_n|odes</exec_depend>")
    assert "Nodes of a lamp." in place.hover()
    assert place.targets() == ["package.xml:"]
    assert "needed to run" in position_at("<exec_de|pend>").hover()


def test_symbols_are_elements_with_texts(position_at):
    place = position_at("|<depend>lamp_nodes</depend>")
    (package,) = place.format.symbols(place.document)
    assert (package.name, [child.detail for child in package.children]) == (
        "lamp_bringup",
        ["lamp_bringup", "lamp_nodes"],
    )
