"""``linkwright export``."""

from __future__ import annotations

import pytest

from linkwright.cli import main
from linkwright.panels.export import html

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


def test_export_writes_glb_with_arguments(model, capsys):
    assert main(["export", "out/box.glb", "box.xacro", "size:=4"]) == 0
    data = (model / "out" / "box.glb").read_bytes()
    assert data.startswith(b"glTF")
    assert b'"max":[2.0,0.5,0.5]' in data
    assert "Created file out/box.glb" in capsys.readouterr().out


def test_export_writes_html(model, monkeypatch):
    folder = model / "page" / "export"
    folder.mkdir(parents=True)
    for name in ("export.js", "export.css"):
        (folder / name).write_text("")
    monkeypatch.setattr(html, "PAGE_FOLDER", model / "page")
    assert main(["export", "box.html", "box.xacro"]) == 0
    assert (model / "box.html").read_text().startswith("<!doctype html>")


def test_unbuilt_page_is_reported(model, monkeypatch, capsys):
    monkeypatch.setattr(html, "PAGE_FOLDER", model / "nowhere")
    assert main(["export", "box.html", "box.xacro"]) == 1
    assert "VIEW202" in capsys.readouterr().err


def test_wrong_suffix_and_swapped_files_are_usage_errors(model, capsys):
    assert main(["export", "box.obj", "box.xacro"]) == 2
    assert "should end with .html or .glb" in capsys.readouterr().err
    assert main(["export", "box.xacro", "box.glb"]) == 2
    assert "the file to write comes first" in capsys.readouterr().err


def test_missing_mesh_is_reported_and_rest_is_exported(model, capsys):
    (model / "arm.urdf").write_text(MODEL.replace('<box size="$(arg size) 1 1"/>', '<mesh filename="file:///no.stl"/>'))
    assert main(["export", "arm.glb", "arm.urdf"]) == 1
    printed = capsys.readouterr()
    assert "VIEW203" in printed.err
    assert "/no.stl" in printed.err
    assert (model / "arm.glb").is_file()


def test_invalid_model_is_reported_and_not_exported(model, capsys):
    (model / "broken.urdf").write_text("<robot name='x'><link/></robot>")
    assert main(["export", "x.glb", "broken.urdf"]) == 1
    assert "broken.urdf" in capsys.readouterr().err
    assert not (model / "x.glb").exists()


def test_exported_files_from_outside_packages_are_listed(model, capsys, monkeypatch):
    """Files below the description's folder, and files in packages, are not listed."""
    home, other, package = (model / name for name in ("home", "other", "package"))
    for folder in (home / "parts", other, package):
        folder.mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>package</name></package>")
    empty = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"/>'
    for path in (home / "parts" / "own.xacro", other / "secret.xacro", package / "shared.xacro"):
        path.write_text(empty)
    (other / "secret.yaml").write_text("size: 3")
    (other / "secret.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (home / "box.xacro").write_text(f"""\
<robot name="box" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="parts/own.xacro"/>
  <xacro:include filename="{package}/shared.xacro"/>
  <xacro:include filename="../other/secret.xacro"/>
  <xacro:property name="read" value="${{xacro.load_yaml('../other/secret.yaml')}}"/>
  <link name="base"><visual><geometry><box size="${{read.size}} 1 1"/></geometry></visual>
    <visual><geometry><mesh filename="file://{other}/secret.obj"/></geometry></visual></link>
</robot>
""")
    monkeypatch.chdir(home)
    assert main(["export", "box.glb", "box.xacro"]) == 0
    output = capsys.readouterr().err
    assert "the export contains 3 files from outside the packages" in output
    secrets = [word for word in output.split() if "secret" in word or "own" in word or "shared" in word]
    assert [name.rpartition("/")[2] for name in secrets] == ["secret.xacro", "secret.yaml", "secret.obj"]


def test_comparison_page_contains_no_local_paths(model, monkeypatch):
    folder = model / "page" / "export"
    folder.mkdir(parents=True)
    for name in ("export.js", "export.css"):
        (folder / name).write_text("")
    monkeypatch.setattr(html, "PAGE_FOLDER", model / "page")
    (model / "new.xacro").write_text(MODEL.replace('default="1"', 'default="2"'))
    assert main(["export", "review.html", "box.xacro", "new.xacro"]) == 0
    page = (model / "review.html").read_text()
    assert '"type":"compared_descriptions"' in page
    assert '"old":"box 1 1 1","new":"box 2 1 1","unit":"m"' in page
    assert '"text":"box.xacro:3:' in page
    assert page.count('"type":"robot_scene"') == 2
    assert str(model) not in page
    assert main(["export", "same.html", "box.xacro", "new.xacro", "size:=3"]) == 0
    assert '"items":[]' in (model / "same.html").read_text()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["r.glb", "box.xacro", "box.xacro"], "'r.glb' should end with .html"),
        (["r.html", "box.xacro", "box.xacro", "box.xacro"], "pass one file, two to compare"),
        (["r.html", "box.xacro", "box.xacro", "--against", "HEAD"], "pass one file, two to compare"),
    ],
)
def test_invalid_comparison_arguments_are_usage_errors(model, words, message, capsys):
    assert main(["export", *words]) == 2
    assert message in capsys.readouterr().err
    assert not list(model.glob("r.*"))


def test_error_in_old_description_is_reported_with_location(model, capsys):
    (model / "old.xacro").write_text(MODEL.replace("</robot>", ""))
    assert main(["export", "r.html", "old.xacro", "box.xacro"]) == 1
    assert "old.xacro:" in capsys.readouterr().err
    assert not (model / "r.html").exists()
