"""The options of `linkwright view`, with and without a recording."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.hosting import bag_view, view
from linkwright.hosting.plans import HostOptions
from tests.panels.test_timeline import recorded

RVIZ = "Panels: []\nVisualization Manager:\n  Displays: []\n  Global Options:\n    Fixed Frame: odom\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the working directory with a robot, a recording `drive` and an .rviz file."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "r.urdf").write_text("<robot name='r'><link name='a'/></robot>")
    (tmp_path / "v.rviz").write_text(RVIZ)
    recorded(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["drive", "a:=b"], "'drive' is a recording, so show it by itself: omit a:=b"),
        (["drive", "r.urdf"], "omit r.urdf"),
        (["drive", "--against", "HEAD"], "omit --against HEAD"),
        (["r.urdf", "drive"], "'drive' is a recording, so show it without other files: linkwright view drive"),
        (["drive", "drive"], "several files are shown as one recording, and 'drive' is a folder: name its files"),
        (["r.urdf", "r.urdf", "-d", "v.rviz"], "omit -d"),
    ],
)
@pytest.mark.usefixtures("folder")
def test_contradictory_arguments_are_rejected(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["view", *words]) == 2
    assert message in capsys.readouterr().err


def test_several_files_are_viewed_as_one_recording(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (file,) = (folder / "drive").glob("*.mcap")
    files_shown: list[Path] = []
    monkeypatch.setattr(bag_view, "run_bag_view", lambda files, *_, **__: files_shown.extend(files) or 0)
    assert main(["view", str(file), str(file.relative_to(folder))]) == 0
    assert [path.absolute() for path in files_shown] == [file, file]


def test_ros1_recording_error_suggests_conversion(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "old.bag").write_bytes(b"#ROSBAG V2.0\n\0\1")
    assert main(["view", "old.bag"]) == 1
    output = capsys.readouterr().err
    assert "'old.bag' cannot be read as a recording: it is a ROS 1 recording" in output
    assert "rosbags-convert" in output


@pytest.mark.parametrize("words", [["missing.urdf"], ["r.urdf", "missing.urdf"], ["r.urdf", "--port", "{port}"]])
def test_startup_error_is_printed_alone(
    folder: Path, words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROS_LOG_DIR", str(folder / "log"))
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = str(server.getsockname()[1])
        assert main(["view", "--no-open", *(word.format(port=port) for word in words)]) == 1
    output = capsys.readouterr()
    assert output.out == ""
    error, hint = output.err.splitlines()
    assert error.startswith("error[")
    assert hint.startswith("   = hint: ")


@pytest.mark.parametrize("text", [None, "nothing: [of the kind"])
def test_unreadable_rviz_file_is_reported_before_start(
    folder: Path, text: str | None, capsys: pytest.CaptureFixture[str]
) -> None:
    if text is not None:
        (folder / "broken.rviz").write_text(text)
    assert main(["view", "drive", "-d", "broken.rviz"]) == 1
    assert "broken.rviz" in capsys.readouterr().err


@pytest.mark.parametrize("file", ["r.urdf", "drive"])
def test_displays_of_rviz_file_are_used(folder: Path, file: str, monkeypatch: pytest.MonkeyPatch) -> None:
    host_options: list[HostOptions] = []

    def show(path: object, *arguments: object, **_: object) -> int:
        host_options.extend(argument for argument in arguments if isinstance(argument, HostOptions))
        return 0

    monkeypatch.setattr(bag_view, "run_bag_view", show)
    monkeypatch.setattr(view, "run_view", show)
    assert main(["view", file, "-d", "v.rviz"]) == 0
    assert [options.rviz for options in host_options] == [folder / "v.rviz"]
    assert view._load_config(folder / "v.rviz").options.text("Fixed Frame") == "odom"
