"""Files are written completely or not at all, on any disk and in any folder."""

from __future__ import annotations

import errno
import os
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.files.whole_files import write_whole_file

OLD, NEW = b"what was there\n" * 100, b"something new\n" * 1000


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "file.rviz"
    path.write_bytes(OLD)
    return path


@pytest.fixture
def fill_disk(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Let this process write a number of bytes, and then refuse to write as a full disk does."""

    def fill(room: int) -> None:
        left = room
        write = os.write

        def limited(descriptor: int, data: bytes) -> int:
            nonlocal left
            if left == 0:
                raise OSError(errno.ENOSPC, "No space left on device")
            written = write(descriptor, data[:left])
            left -= written
            return written

        monkeypatch.setattr("os.write", limited)

    return fill


@pytest.fixture
def no_replacing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Create a file that is a mount point, as in containers."""

    def refuse(*_: object) -> None:
        raise OSError(errno.EBUSY, "Device or resource busy")

    monkeypatch.setattr("os.replace", refuse)


def test_replaced_file_keeps_its_permissions(file: Path) -> None:
    file.chmod(0o640)
    write_whole_file(file, NEW)
    assert (file.read_bytes(), file.stat().st_mode & 0o777) == (NEW, 0o640)
    assert list(file.parent.iterdir()) == [file]


def test_text_keeps_its_line_ends(tmp_path: Path) -> None:
    write_whole_file(tmp_path / "new", "a\r\nü\n", mode=0o700)
    assert (tmp_path / "new").read_bytes() == "a\r\nü\n".encode()
    assert (tmp_path / "new").stat().st_mode & 0o777 == 0o700


def test_symlink_is_kept(file: Path) -> None:
    link = file.with_name("link")
    link.symlink_to(file)
    write_whole_file(link, NEW)
    assert link.is_symlink()
    assert file.read_bytes() == NEW


@pytest.mark.parametrize("room", [0, 1, len(OLD), len(NEW) - 1])
@pytest.mark.parametrize("mount", [False, True])
def test_full_disk_leaves_file_unchanged(
    file: Path,
    room: int,
    mount: bool,
    fill_disk: Callable[[int], None],
    request: pytest.FixtureRequest,
) -> None:
    if mount:
        request.getfixturevalue("no_replacing")
    fill_disk(room)
    with pytest.raises(OSError, match="No space left"):
        write_whole_file(file, NEW)
    assert file.read_bytes() == OLD
    assert list(file.parent.iterdir()) == [file]


@pytest.mark.parametrize("room", [0, 1, 500])
def test_full_disk_leaves_no_partial_file(
    tmp_path: Path,
    room: int,
    fill_disk: Callable[[int], None],
) -> None:
    fill_disk(room)
    with pytest.raises(OSError, match="No space left"):
        write_whole_file(tmp_path / "new", NEW)
    assert list(tmp_path.iterdir()) == []


def test_irreplaceable_file_is_written_in_place(file: Path, no_replacing: None) -> None:
    number = file.stat().st_ino
    write_whole_file(file, NEW[:10])
    assert (file.read_bytes(), file.stat().st_ino) == (NEW[:10], number)
    assert list(file.parent.iterdir()) == [file]


def test_write_in_place_restores_content_after_failure(
    file: Path,
    no_replacing: None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    truncated: list[int] = []
    truncate = os.ftruncate

    def refuse_once(descriptor: int, size: int) -> None:
        if not truncated:
            truncated.append(size)
            raise OSError(errno.EIO, "Input/output error")
        truncate(descriptor, size)

    monkeypatch.setattr("os.ftruncate", refuse_once)
    with pytest.raises(OSError, match="Input/output error"):
        write_whole_file(file, NEW)
    assert file.read_bytes() == OLD
    assert list(file.parent.iterdir()) == [file]


def test_copy_is_kept_and_named_if_restore_fails(
    file: Path, no_replacing: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr("os.ftruncate", refuse)
    with pytest.raises(OSError, match="its former content is now in") as caught:
        write_whole_file(file, NEW)
    (copy,) = (path for path in file.parent.iterdir() if path != file)
    assert copy.read_bytes() == OLD
    assert str(copy) in str(caught.value)


def test_longest_file_name_is_written(tmp_path: Path) -> None:
    path = tmp_path / ("ü" * 127)
    for content in (OLD, NEW):
        write_whole_file(path, content)
        assert path.read_bytes() == content


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has /dev/full")
def test_device_is_written_and_not_replaced() -> None:
    with pytest.raises(OSError, match="No space left"):
        write_whole_file("/dev/full", NEW)
    assert not Path("/dev/full").is_file()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no named pipes")
def test_pipe_is_written(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    received: list[bytes] = []
    reader = threading.Thread(target=lambda: received.append(pipe.read_bytes()))
    reader.start()
    write_whole_file(pipe, NEW)
    reader.join()
    assert received == [NEW]
