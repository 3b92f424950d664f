"""Writes files atomically: if writing fails, the existing file does not change.

All commands write their files with this module. It imports neither pathlib nor secrets, because short commands load
it.
"""

from __future__ import annotations

import errno
import os
import stat

DISK_ERRORS = frozenset({errno.ENOSPC, errno.EFBIG, errno.EIO, getattr(errno, "EDQUOT", errno.ENOSPC)})
"""Errors of a full or defective disk, or an exceeded limit.

After such an error, writing in place would destroy the file.
"""

_MAX_NAME_BYTES = 200  # in bytes; file systems allow 255, and the name of the temporary file is a little longer


def write_whole_file(path: str | os.PathLike[str], data: str | bytes, *, mode: int | None = None) -> None:
    """Write a file atomically, by replacing the existing file with a temporary one.

    A symbolic link remains a link. If the folder does not permit another file, or if the file is a separate mount, as
    in Docker, the file is written in place. In that case, a copy of the old contents exists next to the file, or in
    the system's folder for temporary files, until writing is complete.

    Args:
        path: the path of the file, whose folder must exist. Devices and pipes are written directly.
        data: the new contents. A string is encoded as UTF-8, without converting its line ends.
        mode: the permissions; None for the permissions of the existing file, or the usual permissions of a new file.

    Raises:
        OSError: the file cannot be written. Its contents are unchanged, unless writing in place failed and the old
            contents cannot be restored. In that case, the error names their copy.
    """
    content = data.encode("utf-8") if isinstance(data, str) else data
    target = os.path.realpath(os.fspath(path))
    permissions = _read_permissions(target)
    if permissions is None and os.path.exists(target):
        with open(target, "wb", buffering=0) as device:
            _write_all(device.fileno(), content)
        return
    mode = permissions if mode is None else mode
    try:
        _replace(target, content, mode)
    except OSError as error:
        if permissions is None or error.errno in DISK_ERRORS:
            raise
        _write_in_place(target, content)


def _read_permissions(path: str) -> int | None:
    """Return the permissions of an existing regular file, or None for anything else."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return stat.S_IMODE(status.st_mode) if stat.S_ISREG(status.st_mode) else None


def _replace(target: str, content: bytes, mode: int | None) -> None:
    draft_path = _create_temporary_path(target, "draft")
    _create(draft_path, content, 0o666 if mode is None else mode)
    try:
        if mode is not None:
            os.chmod(draft_path, mode)
        os.replace(draft_path, target)
    except BaseException:
        _remove(draft_path)
        raise


def _write_in_place(target: str, content: bytes) -> None:
    """Overwrite a file, and restore its old contents if writing fails.

    If the old contents cannot be restored either, their copy is kept.
    """
    with open(target, "r+b", buffering=0) as file:
        old_content = file.readall()
        copy_path = _create_copy(target, old_content)
        try:
            _overwrite(file.fileno(), content)
        except BaseException as error:
            try:
                _overwrite(file.fileno(), old_content)
            except OSError:
                if isinstance(error, OSError):
                    error.strerror = f"{error.strerror}; its former content is now in '{copy_path}'"
                raise error from None
            _remove(copy_path)
            raise
        _remove(copy_path)


def _create_copy(target: str, content: bytes) -> str:
    import tempfile

    copy_path = _create_temporary_path(target, "before")
    try:
        _create(copy_path, content)
    except OSError:
        copy_path = os.path.join(tempfile.gettempdir(), os.path.basename(copy_path))
        _create(copy_path, content)
    return copy_path


def _create_temporary_path(target: str, purpose: str) -> str:
    folder, name = os.path.split(target)
    name = os.fsdecode(os.fsencode(name)[:_MAX_NAME_BYTES])
    return os.path.join(folder, f".{name}.{purpose}-{os.urandom(4).hex()}")


def _create(path: str, content: bytes, mode: int = 0o666) -> None:
    """Create a file with some content, and flush it to the disk.

    The file is removed if writing fails.

    The umask of the process is applied to `mode`.
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
    remaining = memoryview(content)
    while remaining:
        remaining = remaining[os.write(descriptor, remaining) :]


def _remove(path: str) -> None:
    from contextlib import suppress  # imported here because its import is slow and it is seldom needed

    with suppress(OSError):
        os.unlink(path)
