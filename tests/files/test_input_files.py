"""Pipes and devices are read like other files, or refused without waiting for a writer."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from linkwright.cli.entry import main
from linkwright.diagnostics import LinkwrightError
from linkwright.files.input_files import NoWriterError, read_file, read_text
from linkwright.geometry.meshes import read_mesh
from linkwright.graph.parameters.files import read_parameter_file
from linkwright.launch.frontend.python_file import read_launch_file
from linkwright.rviz.config.file import read as read_configuration
from linkwright.xmltree.reader import read_bytes

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no named pipes")

XACRO = '<robot xmlns:xacro="http://ros.org/wiki/xacro" name="r"><link name="${1 + 1}"/></robot>'
LONG = bytes(range(256)) * 2000
"""More bytes than a pipe can hold."""


@pytest.fixture
def pipe(tmp_path: Path) -> Path:
    path = tmp_path / "pipe.urdf"
    os.mkfifo(path)
    return path


@pytest.fixture
def piped() -> Iterator[str]:
    """Return the path of a pipe with a xacro file, as from ``<(command)`` in a shell."""
    read_end, write_end = os.pipe()
    os.write(write_end, XACRO.encode())
    os.close(write_end)
    yield f"/dev/fd/{read_end}"
    os.close(read_end)


@pytest.mark.parametrize("at_most", [0, 10, 1 << 17, len(LONG) - 1, len(LONG), len(LONG) + 1])
def test_read_file_stops_at_maximum_size(tmp_path: Path, at_most: int) -> None:
    (tmp_path / "long").write_bytes(LONG)
    (tmp_path / "short").write_bytes(LONG[:10])
    assert read_file(tmp_path / "long", at_most) == LONG[:at_most]
    assert read_file(tmp_path / "short", at_most) == LONG[: min(at_most, 10)]


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has these files")
def test_file_with_declared_size_zero_is_read_to_end() -> None:
    assert read_file("/proc/self/stat", 100_000).endswith(b"\n")
    assert len(read_file("/proc/self/stat", 5)) == 5


def test_folder_is_rejected_with_its_path(tmp_path: Path) -> None:
    with pytest.raises(IsADirectoryError) as caught:
        read_file(tmp_path, 100)
    assert caught.value.filename == str(tmp_path)


def test_pipe_without_writer_is_rejected(pipe: Path) -> None:
    with pytest.raises(NoWriterError, match="it is a pipe without a writer"):
        read_file(pipe, 100)


def test_pipe_is_read_until_closed_and_can_be_reread(pipe: Path) -> None:
    # The writer can open the pipe only with a reader. This reader is closed before the pipe is read.
    first = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    write_end = os.open(pipe, os.O_WRONLY)
    writer = threading.Thread(target=lambda: (os.write(write_end, LONG), os.close(write_end)))
    writer.start()
    assert read_file(pipe, 10 * len(LONG)) == LONG
    writer.join()
    os.close(first)
    assert read_file(pipe, 10 * len(LONG)) == LONG


def test_pipe_waits_for_slow_writer(pipe: Path) -> None:
    first = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    write_end = os.open(pipe, os.O_WRONLY)
    writer = threading.Timer(0.05, lambda: (os.write(write_end, b"late"), os.close(write_end)))
    writer.start()
    assert read_text(pipe) == "late"
    os.close(first)


def test_endless_device_is_read_up_to_maximum_size() -> None:
    assert read_file("/dev/zero", 1000) == bytes(1000)


def test_read_text_converts_line_ends_like_python(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"a\r\nb\rc\n")
    assert read_text(path) == path.read_text(encoding="utf-8") == "a\nb\nc\n"


@pytest.mark.parametrize(
    "read", [read_bytes, read_launch_file, read_parameter_file, read_configuration], ids=lambda read: read.__name__
)
def test_readers_report_pipe_without_writer(read: object, pipe: Path) -> None:
    with pytest.raises(LinkwrightError, match="it is a pipe without a writer"):
        read(pipe)


@pytest.mark.parametrize("ending", [".stl", ".dae", ".obj", ".glb"])
def test_mesh_must_be_regular_file(tmp_path: Path, ending: str) -> None:
    os.mkfifo(tmp_path / f"pipe{ending}")
    (tmp_path / f"device{ending}").symlink_to("/dev/zero")
    for name in ("pipe", "device"):
        with pytest.raises(LinkwrightError, match="it is not a regular file"):
            read_mesh(tmp_path / f"{name}{ending}")


@pytest.mark.parametrize(
    "words",
    [
        ["check"],
        ["xacro"],
        ["xacro", "--args"],
        ["inertia"],
        ["diagram"],
        ["export", "out.glb"],
        ["view", "--no-open"],
        ["launch", "--print"],
        ["launch", "--show-args"],
        ["bag", "info"],
        ["bag", "play"],
    ],
    ids=" ".join,
)
def test_commands_reject_pipe_without_writer(
    words: list[str], pipe: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(pipe.parent)
    assert main([*words, pipe.name]) == 1
    output = capsys.readouterr().err
    assert f"'{pipe.name}'" in output or f"'{pipe}'" in output
    assert "it is a pipe without a writer" in output or "it is neither a file nor a folder" in output


@pytest.mark.parametrize("words", [["check"], ["xacro"], ["xacro", "--args"], ["inertia"], ["export", "out.html"]])
def test_process_substitution_is_read(
    words: list[str], piped: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main([*words, piped]) == 0, capsys.readouterr().err


@pytest.mark.parametrize("command", ["check", "xacro"])
def test_dev_stdin_is_read(command: str) -> None:
    result = subprocess.run(
        [sys.executable, "-m", "linkwright", command, "/dev/stdin"],
        check=False,
        input=XACRO.encode(),
        capture_output=True,
    )
    assert result.returncode == 0, result.stderr.decode()
    assert b"2" in result.stdout
