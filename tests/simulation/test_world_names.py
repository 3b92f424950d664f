"""The names of worlds on the search path."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.packages import PackageFinder
from linkwright.sdf.resources import ResourceFinder
from linkwright.simulation.server.worlds import load_world

WORLD = '<sdf version="1.9"><world name="{}"/></sdf>'


def test_empty_world_of_gz_has_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert load_world("empty.sdf").world.name == "empty"


def test_file_with_named_suffix_is_preferred(tmp_path: Path) -> None:
    folder = tmp_path / "worlds"
    folder.mkdir()
    for suffix in ("sdf", "world"):
        (folder / f"arena.{suffix}").write_text(WORLD.format(suffix), encoding="utf-8")
    (folder / "yard.world").write_text(WORLD.format("yard"), encoding="utf-8")
    finder = ResourceFinder(PackageFinder(start=[]), {"GZ_SIM_RESOURCE_PATH": str(tmp_path)})
    assert finder.world("arena.world") == folder / "arena.world"
    assert finder.world("arena") == finder.world("arena.sdf") == folder / "arena.sdf"
    assert finder.world("yard.sdf") == folder / "yard.world"
    assert finder.world("attic.sdf") is None


def test_empty_world_of_gz_is_preferred_to_one_in_a_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "bar"
    (package / "worlds").mkdir(parents=True)
    (package / "package.xml").write_text('<package format="3"><name>bar</name></package>', encoding="utf-8")
    for name in ("empty", "cellar"):
        (package / "worlds" / f"{name}.sdf").write_text(WORLD.format(f"{name}_of_bar"), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    gazebo = tmp_path / "ros_gz_sim"  # the sources of this package contain no worlds
    gazebo.mkdir()
    (gazebo / "package.xml").write_text('<package format="3"><name>ros_gz_sim</name></package>', encoding="utf-8")
    assert load_world("cellar.sdf").world.name == "cellar_of_bar"
    assert load_world("empty.sdf").world.name == "empty"
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(package / "worlds"))
    assert load_world("empty.sdf").world.name == "empty_of_bar"
