"""Reads files that can be pipes or devices, without waiting for a missing writer.

Opening a named pipe (FIFO) normally blocks until a program opens its other end, which may never happen. Every read of
this module ends. The module imports little, because short commands load it.
"""

from __future__ import annotations

import errno
import io
import os
import stat

_FIRST_READ = 1 << 17  # most files are shorter, and a larger buffer takes longer to allocate
_NOT_BLOCKING = getattr(os, "O_NONBLOCK", 0)  # Windows does not have such pipes
_FLAGS = os.O_RDONLY | _NOT_BLOCKING | getattr(os, "O_BINARY", 0)  # Windows reads in text mode by default
_pipes: dict[tuple[int, int], bytes] = {}
"""Device and number of a pipe -> its content: a pipe can be read once, and a command may read twice."""


LARGEST_TEXT = 100_000_000
"""A text of so many bytes or more is not read."""


class NoWriterError(OSError):
    """Raised when a pipe is empty and no program has opened it for writing."""


def read_file(path: str | os.PathLike[str], at_most: int) -> bytes:
    """Return the contents of a file, up to `at_most` bytes.

    For a pipe, such as ``<(command)`` in a shell, the contents are everything that is written until all writers have
    closed the pipe. If a pipe that was read before has no writer any more, the same contents are returned again.

    Raises:
        OSError: the file cannot be read; `NoWriterError`, the file is an empty pipe without a writer.
    """
    descriptor = os.open(path, _FLAGS)
    try:
        return _content(descriptor, path, at_most)
    finally:
        os.close(descriptor)


def _content(descriptor: int, path: str | os.PathLike[str], at_most: int) -> bytes:
    kind = os.fstat(descriptor)
    if stat.S_ISDIR(kind.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), os.fspath(path))
    data = b""
    if stat.S_ISREG(kind.st_mode):
        data = os.read(descriptor, min(at_most, _FIRST_READ))
        if len(data) == min(at_most, kind.st_size):  # the usual case, which takes half the time of a file object
            return data
    with open(descriptor, "rb", closefd=False) as file:
        if stat.S_ISREG(kind.st_mode):
            return data + file.read(at_most - len(data))
        first: bytes | None = file.read(1) if stat.S_ISFIFO(kind.st_mode) else None  # None: a writer, but no data yet
        identity = kind.st_dev, kind.st_ino
        if first == b"" and identity not in _pipes:
            raise NoWriterError(errno.ENXIO, "it is a pipe without a writer", os.fspath(path))
        if first == b"":
            return _pipes[identity][:at_most]
        if _NOT_BLOCKING:
            os.set_blocking(file.fileno(), True)
        data = (first or b"") + file.read(at_most - len(first or b""))
        if stat.S_ISFIFO(kind.st_mode):
            _pipes[identity] = data
        return data


def read_text(path: str | os.PathLike[str], encoding: str = "utf-8") -> str:
    """Return the contents of a text file, with line ends converted to line feeds.

    Raises:
        OSError: see `read_file`; also if the file has `LARGEST_TEXT` bytes or more.
        UnicodeDecodeError: the contents are not valid in the encoding.
    """
    data = read_file(path, LARGEST_TEXT)
    if len(data) == LARGEST_TEXT:
        reason = f"it has more than {LARGEST_TEXT // 1_000_000} million bytes"
        raise OSError(errno.ENXIO, reason, os.fspath(path))
    return io.StringIO(data.decode(encoding), newline=None).read()
