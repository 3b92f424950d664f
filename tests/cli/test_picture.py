"""``linkwright picture``."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

from linkwright.cli import main
from tests.picture.robots import RED, joint, link, urdf

MODEL = """\
<robot name="box" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="size" default="1"/>
  <link name="base"><visual><geometry><box size="$(arg size) 1 1"/></geometry></visual></link>
</robot>
"""
ARM = urdf(
    link("base", '<box size="1 1 1"/>', RED),
    link("arm", '<box size="1 1 1"/>', RED, "0 0 2"),
    joint("turn", "base", "arm", "continuous", content='<axis xyz="1 0 0"/>'),
)
WORLD = """\
<sdf version="1.9"><world name="w">
  <model name="box"><pose>0 0 1 0 0 0.5</pose><link name="l"><visual name="v">
    <geometry><box><size>1 2 1</size></box></geometry>
    <material><diffuse>0.9 0.1 0.1 1</diffuse></material></visual></link></model>
</world></sdf>
"""
SMALL = ["--size", "64x48"]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "box.xacro").write_text(MODEL)
    (tmp_path / "arm.urdf").write_text(ARM)
    (tmp_path / "room.world").write_text(WORLD)
    return tmp_path


def image_size(path: Path) -> tuple[int, ...]:
    """Return the width and height of a PNG file."""
    data = path.read_bytes()
    assert data.startswith(b"\x89PNG")
    return struct.unpack_from(">II", data, 16)


def test_picture_applies_size_and_arguments(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["picture", "box.xacro", "size:=4", "-o", "out/a.png", "--size", "80x60"]) == 0
    assert capsys.readouterr().out == f"Created file {Path('out/a.png')}\n"
    assert image_size(folder / "out" / "a.png") == (80, 60)
    assert main(["picture", "box.xacro", "-o", "b.png", "--size", "80x60"]) == 0
    assert (folder / "b.png").read_bytes() != (folder / "out" / "a.png").read_bytes()
    assert main(["picture", "box.xacro", "-o", "c.png", "--size", "80x60"]) == 0
    assert (folder / "b.png").read_bytes() == (folder / "c.png").read_bytes()


@pytest.mark.parametrize(
    "words",
    [
        ["--view", "left"],
        ["--view=-30,20"],
        ["--joint", "turn=1.57"],
        ["--transparent"],
        ["--grid"],
        ["--labels", "links"],
    ],
    ids=" ".join,
)
def test_option_changes_image(words: list[str], folder: Path) -> None:
    assert main(["picture", "arm.urdf", "-o", "plain.png", *SMALL]) == 0
    assert main(["picture", "arm.urdf", "-o", "other.png", *SMALL, *words]) == 0
    assert (folder / "plain.png").read_bytes() != (folder / "other.png").read_bytes()


def test_picture_draws_world(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["picture", "room.world", "-o", "room.png", *SMALL]) == 0
    assert image_size(folder / "room.png") == (64, 48)
    assert main(["picture", "room.world", "-o", "room.png", "--joint", "a=1"]) == 1
    assert "error[PIC111]" in capsys.readouterr().err


def test_turntable_writes_animated_png(folder: Path) -> None:
    assert main(["picture", "arm.urdf", "-o", "arm.png", *SMALL, "--turntable", "0.5"]) == 0
    data = (folder / "arm.png").read_bytes()
    assert data.count(b"fcTL") == 6
    assert b"acTL" in data


@pytest.mark.extra("image")
def test_turntable_writes_animated_webp(folder: Path) -> None:
    assert main(["picture", "arm.urdf", "-o", "arm.webp", *SMALL, "--turntable", "0.5"]) == 0
    assert (folder / "arm.webp").read_bytes()[8:12] == b"WEBP"


def test_webp_without_pillow_suggests_installation(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "PIL", None)
    assert main(["picture", "arm.urdf", "-o", "arm.webp", *SMALL, "--turntable"]) == 1
    assert "error[PIC120]" in (error := capsys.readouterr().err)
    assert "image" in error
    assert not (folder / "arm.webp").exists()


def test_missing_mesh_is_reported_and_rest_is_drawn(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    broken = ARM.replace('<box size="1 1 1"/>', '<mesh filename="package://nowhere/arm.stl"/>', 1)
    (folder / "broken.urdf").write_text(broken)
    assert main(["picture", "broken.urdf", "-o", "broken.png", *SMALL]) == 1
    error = capsys.readouterr().err
    assert "warning[PIC101]: link 'base' is drawn without the mesh 'package://nowhere/arm.stl'" in error
    assert image_size(folder / "broken.png") == (64, 48)


def test_unsupported_label_characters_are_reported(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "arm.urdf").write_text(ARM.replace('"arm"', '"手臂"'), encoding="utf-8")
    assert main(["picture", "arm.urdf", "-o", "arm.png", *SMALL, "--labels", "links"]) == 0
    assert "warning[PIC104]" in capsys.readouterr().err


def test_robot_without_visuals_is_an_error(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "none.urdf").write_text('<robot name="r"><link name="base"/></robot>')
    assert main(["picture", "none.urdf", "-o", "none.png"]) == 1
    assert "error[PIC110]" in capsys.readouterr().err
    assert not (folder / "none.png").exists()


def test_unknown_joint_is_an_error(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["picture", "arm.urdf", "-o", "arm.png", "--joint", "elbow=1"]) == 1
    assert "error[KIN101]: the robot has no joint 'elbow'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["-o", "a.jpg"], "'a.jpg' should end with .png"),
        (["-o", "a.webp"], "'a.webp' should end with .png"),
        (["-o", "a.gif", "--turntable"], "should end with .png or .webp"),
        (["-o", "a.png", "--view", "behind"], "'behind' is not one of iso, front, left, top, or AZIMUTH,ELEVATION"),
        (["-o", "a.png", "--view", "20,100"], "'20,100' is not one of"),
        (["-o", "a.png", "--view", "nan,10"], "'nan,10' is not one of"),
        (["-o", "a.png", "--size", "800"], "'800' is not WIDTHxHEIGHT"),
        (["-o", "a.png", "--size", "8x8"], "each side must have 16 to"),
        (["-o", "a.png", "--size", "16000x16000"], "at most 25 million"),
        (["-o", "a.png", "--joint", "turn"], "'turn' is not NAME=VALUE"),
        (["-o", "a.png", "--joint", "turn=inf"], "'turn=inf' is not NAME=VALUE"),
        (["-o", "a.png", "--turntable", "0"], "'0' is not a duration from 0.5 to 60 s"),
        (["-o", "a.png", "--turntable", "60", "--size", "4000x3000"], "400 million pixels together"),
        ([], "-o"),
    ],
)
def test_invalid_usage_is_one_message(
    words: list[str], message: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["picture", "arm.urdf", *words]) == 2
    assert message in capsys.readouterr().err
    assert not list(folder.glob("a.*"))
