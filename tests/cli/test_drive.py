"""`linkwright drive`: output, files and refusals; `hosting.simulated` tests the driving."""

from __future__ import annotations

import pytest

from linkwright.cli import main
from tests.hosting.test_driven import MBOT


@pytest.fixture
def file(tmp_path, monkeypatch):
    """Write a robot without physics to the working directory."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mbot.urdf").write_text(MBOT)
    return tmp_path / "mbot.urdf"


def test_show_prints_inferred_elements_with_location_and_reason(file, capsys):
    assert main(["drive", "mbot.urdf", "--show"]) == 0
    printed = capsys.readouterr().out
    assert (
        "mbot.urdf:2: DRIVE102 link 'base_link' has no mass: it gets 6.03 kg, the mass of its shapes at 300 kg/m3\n"
        in printed
    )
    assert "        <left_joint>left_wheel_joint</left_joint>\n" in printed
    assert file.read_text() == MBOT


def test_write_adds_all_inferred_elements(file, capsys):
    assert main(["drive", "mbot.urdf", "--write"]) == 0
    assert "Changed file mbot.urdf" in capsys.readouterr().out
    assert file.read_text() != MBOT
    assert main(["drive", "mbot.urdf", "--show"]) == 0
    assert [line.split()[1] for line in capsys.readouterr().out.splitlines()] == ["DRIVE202"]


def test_unsupported_drive_type_is_rejected(file, capsys):
    assert main(["drive", "mbot.urdf", "--drive", "ackermann"]) == 1
    assert "DRIVE211" in capsys.readouterr().err


@pytest.mark.parametrize(("text", "message"), [("<html/>", "URDF"), ("<sdf/>", "neither a world nor a model")])
def test_file_without_robot_is_rejected(file, capsys, text, message):
    file.write_text(text)
    assert main(["drive", "mbot.urdf"]) == 1
    assert message in capsys.readouterr().err


@pytest.mark.parametrize("words", [["--seconds", "0"], ["--rate", "fast"], ["--drive", "legs"]])
def test_invalid_option_values_are_usage_errors(file, words):
    assert main(["drive", str(file), *words]) == 2


def test_exit_status_of_simulation_is_returned(file, monkeypatch):
    monkeypatch.setattr("linkwright.hosting.simulated.run_simulated", lambda *_, **__: 130)
    assert main(["drive", "mbot.urdf", "--headless"]) == 130


@pytest.mark.parametrize("command", ["drive", "sim"])
def test_terminal_option_requires_page(file, capsys, command):
    words = ["drive", "mbot.urdf"] if command == "drive" else ["sim", "playground", "mbot.urdf"]
    assert main([*words, "--headless", "--terminal"]) == 1
    error = capsys.readouterr().err
    assert "CLI334" in error
    assert "leave out one of the two options" in error
