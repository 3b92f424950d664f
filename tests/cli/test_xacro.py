"""`linkwright xacro`."""

from __future__ import annotations

import io

import pytest

from linkwright.cli import main
from linkwright.cli.command import create_parser
from linkwright.cli.xacro import parse_without_options
from tests.imports import loaded_by

ROBOT = """<?xml version="1.0"?>
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="size" default="1"/>
  <link name="l${2*$(arg size)}"/>
</robot>
"""


@pytest.fixture
def model(tmp_path):
    path = tmp_path / "r.xacro"
    path.write_text(ROBOT)
    return path


def test_expanded_text_is_printed(model, capsys):
    assert main(["xacro", str(model)]) == 0
    captured = capsys.readouterr()
    assert '<link name="l2"/>' in captured.out
    assert captured.err == ""


def test_xacro_command_imports_few_modules(model):
    """Slow modules are not imported for a plain expansion: users and build tools run it often."""
    loaded = loaded_by(f"from linkwright.cli import main; main(['xacro', {str(model)!r}])")
    seldom_needed = {"asyncio", "linkwright.packages", "linkwright.xmltree.positions", "locale", "numpy", "pathlib"}
    assert not (seldom_needed | {"tempfile", "unicodedata", "yaml"}) & loaded


def test_arguments_and_output_file_are_applied(model, tmp_path, capsys):
    out = tmp_path / "new" / "r.urdf"
    assert main(["xacro", str(model), "size:=4", "-o", str(out)]) == 0
    assert '<link name="l8"/>' in out.read_text()
    assert capsys.readouterr().out == ""


def test_standard_input_is_expanded(monkeypatch, capsys):
    monkeypatch.setattr("sys.stdin", io.StringIO(ROBOT))
    assert main(["xacro", "-", "size:=3"]) == 0
    assert '<link name="l6"/>' in capsys.readouterr().out


def test_error_shows_location_and_leaves_no_file(model, tmp_path, capsys):
    model.write_text(ROBOT.replace("2*", "2*sise*"))
    out = tmp_path / "r.urdf"
    assert main(["xacro", str(model), "-o", str(out)]) == 1
    assert not out.exists()
    err = capsys.readouterr().err
    assert f"{model}:4:" in err
    assert "'sise'" in err


def test_missing_file_is_reported(tmp_path, capsys):
    assert main(["xacro", str(tmp_path / "none.xacro")]) == 1
    err = capsys.readouterr().err
    assert "none.xacro" in err
    assert "hint" in err


def test_argument_without_colon_is_reported(model, capsys):
    assert main(["xacro", str(model), "size=4"]) == 1
    err = capsys.readouterr().err
    assert "'size=4'" in err
    assert "size:=4" in err


def test_unwritable_output_is_reported(model, tmp_path, capsys):
    assert main(["xacro", str(model), "-o", str(tmp_path)]) == 1
    assert "cannot write" in capsys.readouterr().err


def test_arguments_without_options_match_full_parser():
    words = ["robot.xacro", "a:=1", "b:="]
    assert vars(parse_without_options(words)) == vars(create_parser("xacro").parse_args(words))
    assert parse_without_options([]) is None


def test_plain_command_does_not_import_argparse(tmp_path):
    """The import takes as long as the expansion of a small file."""
    (tmp_path / "small.xacro").write_text('<robot name="r"/>', encoding="utf-8")
    loaded = loaded_by(f"from linkwright.cli import main; main(['xacro', {str(tmp_path / 'small.xacro')!r}, 'a:=1'])")
    slow = {"argparse", "ast", "contextlib", "dataclasses", "gettext", "inspect", "pathlib", "typing", "warnings"}
    assert not (slow | {"xml.parsers"}) & loaded
    assert "linkwright.xacro.expansion" in loaded


def test_expansion_error_avoids_slow_imports(model):
    model.write_text(ROBOT.replace("2*", "2*sise*"))
    loaded = loaded_by(f"from linkwright.cli import main; main(['xacro', {str(model)!r}])")
    assert "linkwright.xacro.expansion" in loaded
    assert not {"argparse", "ast", "contextlib", "pathlib", "typing"} & loaded
