"""``linkwright world``."""

from __future__ import annotations

import json

import pytest

from linkwright.cli import main
from linkwright.descriptions import examine_world

MODEL = '<sdf version="1.6"><model name="cube"><link name="l"/></model></sdf>'


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for name, text in {
        "found/cube/model.sdf": MODEL,
        "found/hall.sdf": '<sdf version="1.6"><world name="hall"/></sdf>',
        "found/worlds/yard.world": '<sdf version="1.6"><world name="yard"/></sdf>',
        "found/alone.sdf": MODEL,
    }.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path / "found"))
    return tmp_path


def test_world_list_shows_worlds_and_models_of_search_path(folder, capsys):
    assert main(["world", "list"]) == 0
    worlds, models = capsys.readouterr().out.split("Models")
    assert f" {folder / 'found/hall.sdf'}\n" in worlds
    assert f" {folder / 'found/worlds/yard.world'}\n" in worlds
    assert "alone" not in worlds
    assert f" {folder / 'found/cube'}\n" in models
    assert "  ground_plane " in models


def test_world_list_prints_json(folder, capsys):
    assert main(["world", "list", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert {"kind": "world", "name": "yard", "path": str(folder / "found/worlds/yard.world")} in rows
    assert {"kind": "model", "name": "cube", "path": str(folder / "found/cube")} in rows


@pytest.mark.parametrize(
    ("name", "file"), [("kitchen", "kitchen.world"), ("w/hall & yard.sdf", "w/hall & yard.sdf"), ("v1.2", "v1.2.world")]
)
def test_new_world_has_no_findings(folder, capsys, name, file):
    assert main(["world", "new", name]) == 0
    assert f"Created file {file}" in capsys.readouterr().out
    examined = examine_world(folder / file)
    assert examined.diagnostics == ()
    assert examined.sdf is not None
    world = examined.sdf.worlds[0]
    assert file.endswith((f"{world.name}.world", f"{world.name}.sdf"))
    assert [model.name for model in world.models] == ["ground_plane", "box"]
    assert main(["world", "check", "--strict", file]) == 0


def test_new_world_does_not_overwrite_without_force(folder, capsys):
    (folder / "a.world").write_text("mine")
    assert main(["world", "new", "a"]) == 1
    assert "CLI206" in capsys.readouterr().err
    assert (folder / "a.world").read_text() == "mine"
    assert main(["world", "new", "a", "--force"]) == 0
    assert "<world" in (folder / "a.world").read_text()


def test_world_check_reports_findings(folder, capsys):
    (folder / "bad.world").write_text('<sdf version="1.6"><world name="w"><modle name="m"/></world></sdf>')
    assert main(["world", "check", "bad.world"]) == 0
    assert "SDF150" in capsys.readouterr().err


def test_missing_subcommand_prints_help(capsys):
    assert main(["world"]) == 0
    assert "list" in capsys.readouterr().out
