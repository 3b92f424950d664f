"""Suggestions of similar names."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import as_typed, did_you_mean, is_misspelled, missing_file_hint, nearest

LINKS = ["base_link", "base_footprint", "left_wheel", "right_wheel"]


def test_nearest_name_comes_first():
    assert nearest("left_whel", LINKS)[0] == "left_wheel"
    assert nearest("base_lnk", LINKS) == ["base_link"]


def test_nearest_ignores_case():
    assert nearest("BASE_LINK", LINKS)[0] == "base_link"
    assert nearest("revolute", ["Revolute"]) == ["Revolute"]


def test_nearest_respects_limit():
    assert len(nearest("wheel", [f"wheel{n}" for n in range(9)])) == 3
    assert nearest("wheel1", ["wheel2", "wheel11", "wheel1"], limit=1) == ["wheel1"]


def test_nearest_returns_nothing_for_distant_names():
    assert nearest("camera", LINKS) == []
    assert nearest("camera", []) == []


@pytest.mark.parametrize(
    ("candidates", "hint"),
    [
        (["effort"], "did you mean 'effort'?"),
        (["effort", "effort2"], "did you mean 'effort' or 'effort2'?"),
        (["effort", "effort2", "effort_2"], "did you mean 'effort', 'effort2' or 'effort_2'?"),
        (["velocity"], None),
    ],
)
def test_did_you_mean_formats_candidates(candidates, hint):
    assert did_you_mean("efort", candidates) == hint


def test_missing_file_hint_depends_on_folder_contents(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert missing_file_hint(tmp_path / "no" / "a.urdf") == (
        f"the folder 'no' does not exist; the current folder is '{tmp_path}'"
    )
    assert missing_file_hint(tmp_path / "a.urdf") == f"the current folder is '{tmp_path}'"
    (tmp_path / "robot.urdf").touch()
    (tmp_path / "notes.txt").touch()
    assert missing_file_hint(tmp_path / "a.urdf") == "choose from robot.urdf"
    assert missing_file_hint(tmp_path / "robto.urdf") == "did you mean 'robot.urdf'?"
    assert missing_file_hint(tmp_path / "robot.urfd") == "did you mean 'robot.urdf'?"
    assert missing_file_hint(tmp_path / "robto.udrf") == "did you mean 'robot.urdf'?"
    assert missing_file_hint(tmp_path / "notes.urdf") == "choose from robot.urdf"
    assert missing_file_hint(tmp_path / "x", lambda name: name.endswith(".txt")) == "choose from notes.txt"
    (tmp_path / "urdf").mkdir()
    (tmp_path / "urdf" / "wheel.urdf").touch()
    assert missing_file_hint(tmp_path / "wheel.urdf").replace("\\", "/") == "did you mean 'urdf/wheel.urdf'?"
    assert missing_file_hint(tmp_path / "urdf" / "robot.urdf") == "did you mean 'robot.urdf'?"


def test_missing_file_hint_suggests_longer_suffix(tmp_path):
    (tmp_path / "robot.urdf.xacro").touch()
    assert missing_file_hint(tmp_path / "robot.xacro") == "did you mean 'robot.urdf.xacro'?"
    assert missing_file_hint(tmp_path / "robot.v2.xacro").startswith("choose from ")


@pytest.mark.parametrize("address", ["https://example.org/r.urdf", "http://localhost/r.urdf"])
def test_missing_file_hint_for_url_says_files_are_not_downloaded(tmp_path, address):
    hint = "files are not fetched from the network: download the file, and give its path"
    assert missing_file_hint(Path(address)) == hint
    assert missing_file_hint(tmp_path / address) == hint
    assert as_typed(Path(address)) == as_typed(tmp_path / address) == as_typed(address) == address


@pytest.mark.parametrize("path", ["a/b.urdf", "/a/b.urdf", "//server/b.urdf", "a:/b", "http/b.urdf", "C:\\a\\b.urdf"])
def test_as_typed_keeps_path(path):
    assert as_typed(path) == path


@pytest.mark.parametrize(
    ("name", "other", "intended"),
    [
        ("ur_description", "ur_descriptions", True),
        ("ur_descripton", "ur_description", True),
        ("robot_state_pub", "robot_state_publisher", True),
        ("description_ur", "ur_description", True),
        ("wheelLeft", "wheel_left", True),
        ("my_bot_gazebo", "my_bot_gazebo_plugins", True),
        ("tf2_rs", "tf2_ros", True),
        ("cnt", "count", True),
        ("ur_description", "sr_description", False),
        ("ur_description", "tiago_description", False),
        ("dsr_description", "my_robot_description", False),
        ("kortex_bringup", "husky_bringup", False),
        ("arm_1_link", "arm_2_link", False),
        ("left_wheel", "right_wheel", False),
        ("front_camera_link", "rear_camera_link", False),
        ("joint_state_controller", "joint_trajectory_controller", False),
        ("diff_drive_controller", "tricycle_controller", False),
    ],
)
def test_nearest_rejects_names_that_share_only_a_common_word(name: str, other: str, intended: bool) -> None:
    assert nearest(name, [other]) == ([other] if intended else [])


@pytest.mark.parametrize(
    ("name", "other", "misspelled"),
    [
        ("amr", "arm", True),
        ("taker", "talker", True),
        ("rviz", "rviz2", True),
        ("robot_state_publishr", "robot_state_publisher", True),
        ("my_robot_descripton", "my_robot_description", True),
        ("map_saver_server", "map_server", False),
        ("crazyflie_control", "crazyflie_gazebo", False),
        ("joint_state_publisher_gui", "joint_state_publisher", False),
        ("move_group", "robot", False),
    ],
)
def test_is_misspelled_distinguishes_typos_from_similar_names(name: str, other: str, misspelled: bool) -> None:
    assert is_misspelled(name, ["zzz", other]) is misspelled
