"""``linkwright export``."""

from __future__ import annotations

import pytest

from linkwright.cli import main
from linkwright.viewer.features.export import html

MODEL = """\
<robot name="box" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="size" default="1"/>
  <link name="base"><visual><geometry><box size="$(arg size) 1 1"/></geometry></visual></link>
</robot>
"""


@pytest.fixture
def model(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "box.xacro").write_text(MODEL)
    return tmp_path


def test_glb_is_written_with_the_arguments_given(model, capsys):
    assert main(["export", "out/box.glb", "box.xacro", "size:=4"]) == 0
    data = (model / "out" / "box.glb").read_bytes()
    assert data.startswith(b"glTF")
    assert b'"max":[2.0,0.5,0.5]' in data
    assert "Created file out/box.glb" in capsys.readouterr().out


def test_html_is_written(model, monkeypatch):
    folder = model / "page" / "export"
    folder.mkdir(parents=True)
    for name in ("export.js", "export.css"):
        (folder / name).write_text("")
    monkeypatch.setattr(html, "PAGE_FOLDER", model / "page")
    assert main(["export", "box.html", "box.xacro"]) == 0
    assert (model / "box.html").read_text().startswith("<!doctype html>")


def test_a_page_that_was_not_built_is_said(model, monkeypatch, capsys):
    monkeypatch.setattr(html, "PAGE_FOLDER", model / "nowhere")
    assert main(["export", "box.html", "box.xacro"]) == 1
    assert "VIEW202" in capsys.readouterr().err


def test_other_endings_and_swapped_files_are_wrong_usage(model, capsys):
    assert main(["export", "box.obj", "box.xacro"]) == 2
    assert "should end with .html or .glb" in capsys.readouterr().err
    assert main(["export", "box.xacro", "box.glb"]) == 2
    assert "the file to write comes first" in capsys.readouterr().err


def test_what_is_left_out_is_told_and_the_rest_written(model, capsys):
    (model / "arm.urdf").write_text(MODEL.replace('<box size="$(arg size) 1 1"/>', '<mesh filename="file:///no.stl"/>'))
    assert main(["export", "arm.glb", "arm.urdf"]) == 1
    printed = capsys.readouterr()
    assert "VIEW203" in printed.err
    assert "/no.stl" in printed.err
    assert (model / "arm.glb").is_file()


def test_a_model_that_is_broken_is_explained(model, capsys):
    (model / "broken.urdf").write_text("<robot name='x'><link/></robot>")
    assert main(["export", "x.glb", "broken.urdf"]) == 1
    assert "broken.urdf" in capsys.readouterr().err
    assert not (model / "x.glb").exists()
