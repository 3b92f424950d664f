"""`linkwright diagram`: the .gv file and the image."""

from __future__ import annotations

import pytest

from linkwright.cli import main
from tests.places import PACKAGE

MODEL = str(PACKAGE / "urdf" / "mbot_base.urdf")


@pytest.mark.parametrize(
    ("out", "diagram", "magic"), [("m", "m.pdf", b"%PDF"), ("m.svg", "m.svg", b"<?xml"), ("m.png", "m.png", b"\x89PNG")]
)
def test_diagram_writes_graphviz_and_image(tmp_path, monkeypatch, capsys, out, diagram, magic):
    monkeypatch.chdir(tmp_path)
    assert main(["diagram", MODEL, out]) == 0
    assert capsys.readouterr().out == f"Created file m.gv\nCreated file {diagram}\n"
    assert (tmp_path / "m.gv").read_text().startswith("digraph G {\nnode [shape=box];\n")
    assert (tmp_path / diagram).read_bytes().startswith(magic)


def test_default_file_name_is_robot_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["diagram", MODEL]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mbot.gv", "mbot.pdf"]


def test_invalid_robot_writes_no_file(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.urdf").write_text('<robot name="r"/>')
    assert main(["diagram", "bad.urdf"]) == 1
    assert "bad.urdf" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["bad.urdf"]
