"""Writes files atomically: if writing fails, the existing file is unchanged.

All commands write their files with this module. It imports neither pathlib nor secrets, because short commands load it.
"""

from __future__ import annotations

import errno
import os
import stat

NO_SPACE = frozenset({errno.ENOSPC, errno.EFBIG, errno.EIO, getattr(errno, "EDQUOT", errno.ENOSPC)})
"""A disk that is full, a quota or limit that is reached, a disk that is broken: writing in place would only destroy."""

_LONGEST_NAME = 200  # in bytes; file systems allow 255, and the name of the temporary file is a little longer


def write_whole_file(path: str | os.PathLike[str], data: str | bytes, *, mode: int | None = None) -> None:
    """Write a file atomically, by replacing the existing file with a temporary one.

    A symbolic link remains a link. If the folder does not permit another file, or the file is a mount of its own, as in
    Docker, the file is written in place. In that case, a copy of the old contents is stored beside the file or in the
    system's temporary folder until writing is complete.

    Args:
        path: the file, whose folder must exist. Devices and pipes are written to directly.
        data: the new contents. A string is encoded as UTF-8, without converting its line ends.
        mode: the permissions; by default those of the existing file, or the usual permissions of a new file.

    Raises:
        OSError: the file cannot be written; its contents are unchanged.
    """
    content = data.encode("utf-8") if isinstance(data, str) else data
    target = os.path.realpath(os.fspath(path))
    permissions = _permissions(target)
    if permissions is None and os.path.exists(target):
        with open(target, "wb", buffering=0) as device:
            _write_all(device.fileno(), content)
        return
    mode = permissions if mode is None else mode
    try:
        _replace(target, content, mode)
    except OSError as error:
        if permissions is None or error.errno in NO_SPACE:
            raise
        _write_in_place(target, content)


def _permissions(path: str) -> int | None:
    """Return the permissions of an existing regular file, otherwise None."""
    try:
        facts = os.stat(path)
    except OSError:
        return None
    return stat.S_IMODE(facts.st_mode) if stat.S_ISREG(facts.st_mode) else None


def _replace(target: str, content: bytes, mode: int | None) -> None:
    draft = _beside(target, "draft")
    _create(draft, content, 0o666 if mode is None else mode)
    try:
        if mode is not None:
            os.chmod(draft, mode)
        os.replace(draft, target)
    except BaseException:
        _remove(draft)
        raise


def _write_in_place(target: str, content: bytes) -> None:
    """Overwrite a file, and restore its old contents if writing fails.

    If the old contents cannot be restored either, the copy of them is not deleted.
    """
    with open(target, "r+b", buffering=0) as file:
        before = file.readall()
        copy = _copy(target, before)
        try:
            _overwrite(file.fileno(), content)
        except BaseException as error:
            try:
                _overwrite(file.fileno(), before)
            except OSError:
                if isinstance(error, OSError):
                    error.strerror = f"{error.strerror}; its former content is now in '{copy}'"
                raise error from None
            _remove(copy)
            raise
        _remove(copy)


def _copy(target: str, content: bytes) -> str:
    import tempfile

    copy = _beside(target, "before")
    try:
        _create(copy, content)
    except OSError:
        copy = os.path.join(tempfile.gettempdir(), os.path.basename(copy))
        _create(copy, content)
    return copy


def _beside(target: str, what: str) -> str:
    folder, name = os.path.split(target)
    name = os.fsdecode(os.fsencode(name)[:_LONGEST_NAME])
    return os.path.join(folder, f".{name}.{what}-{os.urandom(4).hex()}")


def _create(path: str, content: bytes, mode: int = 0o666) -> None:
    """Create a file and flush it to the disk, or remove it if writing fails.

    The process's umask is applied to `mode`.
    """
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), mode)
    try:
        try:
            _write_all(descriptor, content)
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
    except BaseException:
        _remove(path)
        raise


def _overwrite(descriptor: int, content: bytes) -> None:
    os.lseek(descriptor, 0, os.SEEK_SET)
    _write_all(descriptor, content)
    os.ftruncate(descriptor, len(content))
    os.fsync(descriptor)


def _write_all(descriptor: int, content: bytes) -> None:
    rest = memoryview(content)
    while rest:
        rest = rest[os.write(descriptor, rest) :]


def _remove(path: str) -> None:
    from contextlib import suppress  # imported here, because it is slow to import and seldom needed

    with suppress(OSError):
        os.unlink(path)
