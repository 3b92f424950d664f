"""The command-line options of `rviz2`."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.hosting.rviz2_arguments import asks_for_help, read_viewer_config
from linkwright.launch import run_viewer

CONFIG = """
Visualization Manager:
  Displays: []
  Global Options:
    Fixed Frame: base_link
"""


def test_display_config_option_loads_file(tmp_path: Path) -> None:
    path = tmp_path / "a.rviz"
    path.write_text(CONFIG)
    for option in ("-d", "--display-config"):
        config, findings = read_viewer_config([option, str(path), "--ros-args", "-r", "a:=b"])
        assert config.options.text("Fixed Frame") == "base_link"
        assert findings == []


def test_values_may_be_joined_to_options(tmp_path: Path) -> None:
    path = tmp_path / "a.rviz"
    path.write_text(CONFIG)
    for option in (f"-d{path}", f"--display-config={path}"):
        config, findings = read_viewer_config([option])
        assert config.options.text("Fixed Frame") == "base_link"
        assert findings == []
    assert read_viewer_config(["-fodom"])[0].options.text("Fixed Frame") == "odom"


def test_fixed_frame_option_sets_frame() -> None:
    config, findings = read_viewer_config(["-f", "odom"])
    assert config.options.text("Fixed Frame") == "odom"
    assert findings == []


def test_unreadable_file_falls_back_to_default(tmp_path: Path) -> None:
    config, (finding,) = read_viewer_config(["-d", str(tmp_path / "none.rviz")])
    assert finding.code == "RVIZ101"
    assert config.options.text("Fixed Frame") == "map"


def test_empty_file_name_is_accepted() -> None:
    assert read_viewer_config(["-d", ""])[1] == []


def test_unknown_and_incomplete_arguments_are_reported() -> None:
    messages = [finding.message for finding in read_viewer_config(["--display-confg", "-l", "-d"])[1]]
    assert messages == ["rviz2 has no argument '--display-confg'", "argument '-d' of rviz2 needs a value"]


@pytest.mark.parametrize("arguments", [["--help"], ["-d", "x.rviz", "-h"]])
def test_help_option_prints_usage_and_starts_nothing(arguments, capsys):
    assert run_viewer("rviz2", "rviz2", arguments) == 0
    assert capsys.readouterr().out.startswith("usage: rviz2 ")


def test_help_option_in_ros_arguments_is_ignored():
    assert not asks_for_help(["-d", "x.rviz", "--ros-args", "-p", "a:=-h", "--help"])
