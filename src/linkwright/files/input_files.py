"""Read files that may be pipes or devices, without waiting for an absent writer.

Opening a named pipe (FIFO) normally blocks until a program opens its other end, which may never happen. The functions
of this module always return. The module imports little, because short commands load it.
"""

from __future__ import annotations

import errno
import io
import os
import stat

_FIRST_READ_BYTES = 1 << 17  # most files are shorter, and a larger buffer takes longer to allocate
_NON_BLOCKING = getattr(os, "O_NONBLOCK", 0)  # Windows does not have such pipes
_OPEN_FLAGS = os.O_RDONLY | _NON_BLOCKING | getattr(os, "O_BINARY", 0)  # Windows reads in text mode by default
_pipe_contents: dict[tuple[int, int], bytes] = {}
"""Maps the device and inode of a pipe to its contents.

A command may read a pipe twice, but a pipe yields its contents only once.
"""


MAX_TEXT_BYTES = 100_000_000
"""Texts with this number of bytes or more are not read."""


class NoWriterError(OSError):
    """Raised when a pipe is empty, and no program has opened it for writing."""


def read_file(path: str | os.PathLike[str], max_bytes: int) -> bytes:
    """Return the contents of a file, up to a maximum number of bytes.

    For a pipe, such as ``<(command)`` in a shell, the contents are everything that is written until all writers have
    closed the pipe. If a pipe that was read before has no writer now, the same contents are returned again.

    Raises:
        OSError: the file cannot be read. `NoWriterError`: the file is an empty pipe without a writer.
    """
    descriptor = os.open(path, _OPEN_FLAGS)
    try:
        return _read_content(descriptor, path, max_bytes)
    finally:
        os.close(descriptor)


def _read_content(descriptor: int, path: str | os.PathLike[str], max_bytes: int) -> bytes:
    status = os.fstat(descriptor)
    if stat.S_ISDIR(status.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), os.fspath(path))
    data = b""
    if stat.S_ISREG(status.st_mode):
        data = os.read(descriptor, min(max_bytes, _FIRST_READ_BYTES))
        if len(data) == min(max_bytes, status.st_size):  # the usual case, which takes half the time of a file object
            return data
    with open(descriptor, "rb", closefd=False) as file:
        if stat.S_ISREG(status.st_mode):
            return data + file.read(max_bytes - len(data))
        first_byte: bytes | None = (
            file.read(1) if stat.S_ISFIFO(status.st_mode) else None
        )  # None: a writer, but no data yet
        identity = status.st_dev, status.st_ino
        if first_byte == b"" and identity not in _pipe_contents:
            raise NoWriterError(errno.ENXIO, "it is a pipe without a writer", os.fspath(path))
        if first_byte == b"":
            return _pipe_contents[identity][:max_bytes]
        if _NON_BLOCKING:
            os.set_blocking(file.fileno(), True)
        data = (first_byte or b"") + file.read(max_bytes - len(first_byte or b""))
        if stat.S_ISFIFO(status.st_mode):
            _pipe_contents[identity] = data
        return data


def read_text(path: str | os.PathLike[str], encoding: str = "utf-8") -> str:
    """Return the contents of a text file, in which all line ends are line feeds.

    Raises:
        OSError: as for `read_file`, or the file has `MAX_TEXT_BYTES` bytes or more.
        UnicodeDecodeError: the contents are not valid in the given encoding.
    """
    data = read_file(path, MAX_TEXT_BYTES)
    if len(data) == MAX_TEXT_BYTES:
        reason = f"it has more than {MAX_TEXT_BYTES // 1_000_000} million bytes"
        raise OSError(errno.ENXIO, reason, os.fspath(path))
    return io.StringIO(data.decode(encoding), newline=None).read()
