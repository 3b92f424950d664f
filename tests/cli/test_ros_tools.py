"""The commands of ROS 2 under their own names."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.cli.tools.programs import TOOLS, main
from linkwright.cli.tools.ros2 import COMMANDS
from linkwright.shell import PROGRAMS

MODEL = """\
<robot name="cart">
  <link name="base"/>
  <link name="wheel"/>
  <joint name="axle" type="fixed"><parent link="base"/><child link="wheel"/></joint>
</robot>
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "cart.urdf"
    path.write_text(MODEL)
    return path


def test_shell_programs_match_tools() -> None:
    assert {word for _, word in PROGRAMS.values() if word} == set(TOOLS)


def test_ros2_help_lists_commands(capsys: pytest.CaptureFixture[str]) -> None:
    assert main("ros2", []) == 0
    commands = {line.split()[0] for line in capsys.readouterr().out.splitlines() if line.startswith("  ")}
    assert commands == set(COMMANDS)


@pytest.mark.parametrize("name", COMMANDS)
def test_ros2_command_help_shows_ros2_usage(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main("ros2", [name, "-h"]) == 0
    assert capsys.readouterr().out.startswith("usage: ros2 ")


@pytest.mark.parametrize(
    ("word", "message"), [("lunch", "launch"), ("security", "real ROS 2"), ("xyzzy", "`ros2 --help`")]
)
def test_unknown_ros2_command_suggests_alternative(word: str, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main("ros2", [word]) == 2
    assert message in capsys.readouterr().err


def test_python_default_buffering_option_is_accepted(capsys: pytest.CaptureFixture[str]) -> None:
    assert main("ros2", ["--use-python-default-buffering", "pkg", "list"]) == 0
    assert "my_robot_description" in capsys.readouterr().out.splitlines()


def test_check_urdf_prints_tree(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main("check_urdf", [str(model)]) == 0
    assert capsys.readouterr().out == (
        "robot name is: cart\n"
        "---------- Successfully Parsed XML ---------------\n"
        "root Link: base has 1 child(ren)\n"
        "    child(1):  wheel\n"
    )


def test_check_urdf_rejects_model_rejected_by_urdfdom(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model.write_text(MODEL.replace('child link="wheel"', 'child link="whel"'))
    assert main("check_urdf", [str(model)]) == 255
    output = capsys.readouterr()
    assert output.out == ""
    assert "ERROR: Model Parsing the xml failed" in output.err
    assert "whel" in output.err


def test_check_urdf_reports_missing_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main("check_urdf", [str(tmp_path / "none.urdf")]) == 255
    assert "none.urdf" in capsys.readouterr().err


def test_check_urdf_requires_file(capsys: pytest.CaptureFixture[str]) -> None:
    assert main("check_urdf", []) == 255
    assert capsys.readouterr().err == "Expect URDF xml file to parse\n"


def test_urdf_to_graphviz_writes_both_files(
    model: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main("urdf_to_graphviz", [str(model)]) == 0
    assert capsys.readouterr().out == "Created file cart.gv\nCreated file cart.pdf\n"
    assert (tmp_path / "cart.pdf").read_bytes().startswith(b"%PDF")
    assert main("urdf_to_graphviz", [str(model), "other"]) == 0
    assert (tmp_path / "other.gv").exists()


def test_urdf_to_graphviz_requires_file(capsys: pytest.CaptureFixture[str]) -> None:
    assert main("urdf_to_graphviz", []) == 255
    assert "Usage: urdf_to_graphviz" in capsys.readouterr().err


def test_xacro_expands_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "cart.xacro"
    path.write_text('<robot name="cart" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="${1 + 1}"/></robot>')
    assert main("xacro", [str(path)]) == 0
    assert '<link name="2"/>' in capsys.readouterr().out


def test_xacro_usage_shows_program_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert main("xacro", ["-h"]) == 0
    assert capsys.readouterr().out.startswith("usage: xacro ")
