"""The list of a world that `linkwright check` prints."""

from __future__ import annotations

from linkwright.cli import main
from tests.sdf.worlds import write_files

WORLD = """<sdf version="1.9"><world name="w">
<include><uri>model://ground_plane</uri></include><include><uri>model://sun</uri></include>
<include><uri>model://nowhere</uri></include><actor name="walker"/>
<model name="car"><link name="body"><sensor name="s" type="imu"/></link><link name="wheel"/>
<joint name="j" type="fixed"><parent>body</parent><child>wheel</child></joint><plugin filename="p" name="n"/>
<model name="arm"><link name="tip"/></model></model></world></sdf>"""


def test_check_lists_world_contents(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    write_files(tmp_path, {"w.world": WORLD})
    assert main(["check", "w.world"]) == 0
    captured = capsys.readouterr()
    assert captured.out == (
        "world w\n  model car: 2 links, 1 joint, 1 sensor, 1 plugin\n    model arm: 1 link\n"
        "  static model ground_plane: 1 link\n  actor walker\n  light sun: directional\n  model://nowhere: not found\n"
    )
    assert "info[SDF160]" in captured.err
    assert "0 errors, 0 warnings" in captured.err


def test_world_errors_exit_with_1_and_settings_apply(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    write_files(tmp_path, {"w.sdf": '<sdf version="1.6"><world name="w"><model name="m"/><lite/></world></sdf>'})
    assert main(["check", "w.sdf"]) == 1
    assert "SDF132" in capsys.readouterr().err
    assert main(["check", "--ignore", "SDF150", "."]) == 1
    assert "SDF150" not in capsys.readouterr().err


def test_folder_of_worlds_is_checked(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    write_files(
        tmp_path,
        {"worlds/a.world": WORLD.replace("nowhere", "ground_plan"), "models/m/model.sdf": '<sdf version="1.6"/>'},
    )
    assert main(["check", "."]) == 1
    errors = capsys.readouterr().err
    assert "SDF160" in errors
    assert "SDF131" in errors
