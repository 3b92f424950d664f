"""``linkwright diff``."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from hashlib import sha256
from pathlib import Path

import pytest

from linkwright.cli import main

BODY = """\
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="body" params="name mass">
    <link name="${name}"><inertial><mass value="${mass}"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
      <visual><geometry><mesh filename="package://arm/meshes/body.stl"/></geometry></visual></link>
  </xacro:macro>
</robot>
"""
ARM = """\
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="mass" default="1"/>
  <xacro:include filename="$(find arm)/urdf/body.xacro"/>
  <xacro:body name="base" mass="$(arg mass)"/>
  <gazebo><plugin name="p"><parameters>$(find arm)/config.yaml</parameters></plugin></gazebo>
</robot>
"""
MANIFEST = "<package format='3'><name>arm</name><version>1.0.0</version></package>"

needs_git = pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed")


@pytest.fixture
def package(tmp_path, monkeypatch) -> Path:
    """Create a package with a robot, outside any repository."""
    files = {"package.xml": MANIFEST, "urdf/body.xacro": BODY, "urdf/arm.urdf.xacro": ARM, "meshes/body.stl": "solid"}
    for name, text in files.items():
        path = tmp_path / "arm" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    monkeypatch.chdir(tmp_path / "arm")
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    return tmp_path / "arm"


def run_git(folder: Path, *words: str) -> None:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    identity = {
        f"GIT_{role}_{field}": "test@example.org" for role in ("AUTHOR", "COMMITTER") for field in ("NAME", "EMAIL")
    }
    without_user_config = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull}
    subprocess.run(
        ["git", *words],
        cwd=folder,
        env={**environment, **identity, **without_user_config},
        check=True,
        capture_output=True,
    )


@pytest.fixture
def committed(package) -> Path:
    """Create the package, and commit it."""
    run_git(package, "init")
    run_git(package, "add", "--all")
    run_git(package, "commit", "--message", "first")
    return package


def replace_in_file(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_equal_files_exit_with_0(package, capsys):
    shutil.copy("urdf/arm.urdf.xacro", "urdf/other.urdf.xacro")
    assert main(["diff", "urdf/arm.urdf.xacro", "urdf/other.urdf.xacro"]) == 0
    assert capsys.readouterr().out == "no differences\n"


def test_different_files_exit_with_1(package, capsys):
    Path("urdf/other.urdf.xacro").write_text(ARM.replace('name="base"', 'name="foot"').replace('p"', 'q"'))
    assert main(["diff", "urdf/arm.urdf.xacro", "urdf/other.urdf.xacro", "mass:=3"]) == 1
    assert capsys.readouterr().out == (
        "link 'base' renamed to 'foot'\n"
        "  urdf/body.xacro:3:17 called at urdf/arm.urdf.xacro:4:3 -> "
        "urdf/body.xacro:3:17 called at urdf/other.urdf.xacro:4:3\n"
        "extension 'gazebo': plugin q @name p -> q\n"
        "  urdf/arm.urdf.xacro:5:25 -> urdf/other.urdf.xacro:5:25\n"
        "2 differences\n"
    )


def test_meshes_at_same_uri_are_compared_by_content(package, tmp_path, monkeypatch, capsys):
    other = tmp_path / "before/arm"
    shutil.copytree(package, other)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    words = ["diff", *(str(folder / "urdf/arm.urdf.xacro") for folder in (other, package)), "--format", "json"]
    main(words)
    assert [
        difference
        for difference in json.loads(capsys.readouterr().out)["differences"]
        if difference["subject"] == "link"
    ] == []
    replace_in_file(package / "meshes/body.stl", "solid", "solid body")
    assert main(words) == 1
    (mesh,) = (
        difference
        for difference in json.loads(capsys.readouterr().out)["differences"]
        if difference["subject"] == "link"
    )
    assert mesh["property"] == "visual mesh package://arm/meshes/body.stl"
    assert (mesh["old"], mesh["new"], mesh["unit"]) == ("5", "10", "bytes")
    replace_in_file(package / "meshes/body.stl", "solid body", "dilos")
    main(words)
    (mesh,) = (
        difference
        for difference in json.loads(capsys.readouterr().out)["differences"]
        if difference["subject"] == "link"
    )
    first, second = (sha256(content).hexdigest()[:8] for content in (b"solid", b"dilos"))
    assert (mesh["old"], mesh["new"], mesh["unit"]) == (first, second, "(SHA-256), both of 5 bytes")


def test_pointers_of_git_lfs_are_compared_by_the_files_they_replace(package, tmp_path, monkeypatch, capsys):
    other = tmp_path / "before/arm"
    shutil.copytree(package, other)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    for folder, hash_of_file, size in ((other, "4" * 64, 37), (package, "5" * 64, 41)):
        pointer = f"version https://git-lfs.github.com/spec/v1\noid sha256:{hash_of_file}\nsize {size}\n"
        (folder / "meshes/body.stl").write_text(pointer)
    main(["diff", *(str(folder / "urdf/arm.urdf.xacro") for folder in (other, package)), "--format", "json"])
    meshes = [
        difference
        for difference in json.loads(capsys.readouterr().out)["differences"]
        if "mesh" in difference["property"]
    ]
    assert {(mesh["old"], mesh["new"], mesh["unit"]) for mesh in meshes} == {("37", "41", "bytes")}


@needs_git
def test_unchanged_file_has_no_differences_against_commit(committed, capsys):
    assert main(["diff", "urdf/arm.urdf.xacro", "--against", "HEAD"]) == 0
    assert capsys.readouterr().out == "no differences\n"


@needs_git
def test_against_uses_includes_and_meshes_of_commit(committed, capsys):
    replace_in_file(committed / "urdf/body.xacro", 'mass value="${mass}"', 'mass value="${2 * mass}"')
    replace_in_file(committed / "meshes/body.stl", "solid", "solid body")
    assert main(["diff", "urdf/arm.urdf.xacro", "--against", "HEAD", "--format", "json"]) == 1
    output = json.loads(capsys.readouterr().out)
    assert (output["old"], output["new"]) == ("HEAD:urdf/arm.urdf.xacro", "urdf/arm.urdf.xacro")
    mass, mesh = output["differences"]
    assert (mass["subject"], mass["name"], mass["property"]) == ("link", "base", "inertial mass")
    assert (mass["old"], mass["new"], mass["unit"]) == ("1", "2", "kg")
    assert mass["old_place"] == {
        "file": "HEAD:urdf/body.xacro",
        "line": 3,
        "column": 49,
        "calls": [{"file": "HEAD:urdf/arm.urdf.xacro", "line": 4, "column": 3}],
    }
    assert mass["new_place"]["file"] == "urdf/body.xacro"
    assert (mesh["old"], mesh["new"], mesh["unit"]) == ("5", "10", "bytes")


@needs_git
def test_against_leaves_repository_and_temporary_folder_unchanged(committed, monkeypatch, tmp_path):
    monkeypatch.setenv("TMPDIR", str(tmp_path / "temporary"))
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr("tempfile.tempdir", None)
    before = (committed / ".git/index").read_bytes()
    assert main(["diff", "urdf/arm.urdf.xacro", "--against", "HEAD"]) == 0
    assert (committed / ".git/index").read_bytes() == before
    assert list((tmp_path / "temporary").glob("linkwright-*/files")) == []


@needs_git
def test_errors_in_commit_are_reported_with_commit_name(committed, capsys):
    replace_in_file(committed / "urdf/body.xacro", "</link>", "</lnk>")
    run_git(committed, "commit", "--all", "--message", "broken")
    run_git(committed, "checkout", "HEAD~1", "--", ".")
    assert main(["diff", "urdf/arm.urdf.xacro", "--against", "HEAD"]) == 2
    assert "--> HEAD:urdf/body.xacro:5:" in capsys.readouterr().err


@needs_git
@pytest.mark.parametrize("staged", [False, True])
def test_renamed_file_is_found_in_commit(committed, capsys, staged):
    before = (committed / ".git/index").read_bytes()
    if staged:
        run_git(committed, "mv", "urdf/arm.urdf.xacro", "urdf/hand.urdf.xacro")
    else:
        (committed / "urdf/arm.urdf.xacro").rename(committed / "urdf/hand.urdf.xacro")
    replace_in_file(committed / "urdf/body.xacro", 'mass value="${mass}"', 'mass value="${2 * mass}"')
    assert main(["diff", "urdf/hand.urdf.xacro", "--against", "HEAD", "--format", "json"]) == 1
    output = json.loads(capsys.readouterr().out)
    assert (output["old"], output["new"]) == ("HEAD:urdf/arm.urdf.xacro", "urdf/hand.urdf.xacro")
    assert [difference["property"] for difference in output["differences"]] == ["inertial mass"]
    assert staged or (committed / ".git/index").read_bytes() == before


@needs_git
def test_file_missing_from_commit_is_explained(committed, capsys):
    (committed / "urdf/new.urdf").write_text("<robot name='r'><link name='a'/></robot>")
    assert main(["diff", "urdf/new.urdf", "--against", "HEAD"]) == 2
    assert "no commit contains the file yet" in capsys.readouterr().err
    run_git(committed, "add", "--all")
    run_git(committed, "commit", "--all", "--message", "new")
    assert main(["diff", "urdf/new.urdf", "--against", "HEAD~1"]) == 2
    assert "run `git log -- urdf/new.urdf` to list the commits that contain the file" in capsys.readouterr().err


@needs_git
@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["urdf/arm.urdf.xacro", "--against", "nonsense"], "CLI343"),
        (["urdf/arm.urdf.xacro", "--against=--all"], "CLI343"),
        (["urdf/new.urdf", "--against", "HEAD"], "CLI344"),
        (["urdf/missing.urdf", "--against", "HEAD"], "CLI344"),
        (["../outside.urdf", "--against", "HEAD"], "CLI342"),
    ],
)
def test_unknown_commits_and_files_exit_with_2(committed, capsys, words, code):
    for name in ("urdf/new.urdf", "../outside.urdf"):
        Path(name).write_text("<robot name='r'><link name='a'/></robot>")
    assert main(["diff", *words]) == 2
    assert f"error[{code}]" in capsys.readouterr().err


def test_missing_git_is_reported(package, capsys, monkeypatch):
    monkeypatch.setenv("PATH", "")
    assert main(["diff", "urdf/arm.urdf.xacro", "--against", "HEAD"]) == 2
    assert "error[CLI341]: git is not installed" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words", [["a.urdf"], ["a.urdf", "b.urdf", "c.urdf"], ["a.urdf", "b.urdf", "--against", "HEAD"]]
)
def test_wrong_number_of_files_is_rejected(package, capsys, words):
    assert main(["diff", *words]) == 2
    assert capsys.readouterr().err == "linkwright diff: pass two files, or one and --against COMMIT\n"


def test_missing_file_exits_with_2(package, capsys):
    assert main(["diff", "urdf/arm.urdf.xacro", "missing.urdf"]) == 2
    assert "error[XML101]" in capsys.readouterr().err
