"""Makes the standard streams accept any text and write it completely, in any locale.

Descriptions are UTF-8 and can contain names in any script, and messages can be in Chinese. Western editions of
Windows, however, write files and pipes in code page 1252. This module imports little, because short commands load it.
"""

from __future__ import annotations

import errno
import io
import os
import sys

TYPE_CHECKING = False  # defined here, because importing `typing` takes longer than the rest of this module
if TYPE_CHECKING:
    from typing import Any


class _CompleteWriter(io.RawIOBase):
    """A raw stream that writes all data, or raises OSError."""

    def __init__(self, raw: io.RawIOBase) -> None:
        self._raw = raw

    def writable(self) -> bool:
        return True

    def isatty(self) -> bool:
        return self._raw.isatty()

    def fileno(self) -> int:
        return self._raw.fileno()

    def write(self, data: Any, /) -> int:
        remaining = memoryview(data).cast("B")
        size = len(remaining)
        while remaining:
            written_size = self._raw.write(remaining)
            if written_size is None:
                raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN))
            remaining = remaining[written_size:]
        return size


def _write_completely() -> None:
    """Make an unbuffered standard output raise an error if the disk is full.

    Standard output is unbuffered with ``python -u`` or ``PYTHONUNBUFFERED``. If the disk is full, a write to such a
    stream may write only a part of the data, and Python discards the remaining part.
    """
    stdout = sys.stdout
    if isinstance(stdout, io.TextIOWrapper) and isinstance(stdout.buffer, io.FileIO):
        sys.stdout = io.TextIOWrapper(
            _CompleteWriter(stdout.buffer), stdout.encoding, stdout.errors, write_through=True
        )


def accept_any_text() -> None:
    """Make the standard streams accept any text, and write it completely.

    Files and pipes use UTF-8, as description files do, and as Python does from 3.15 on (PEP 686). A character that a
    terminal cannot display is written as an escape sequence, and so is a byte of a file's name that is not UTF-8. The
    encoding in ``PYTHONIOENCODING`` takes precedence.
    """
    _write_completely()
    has_chosen_encoding = bool(os.environ.get("PYTHONIOENCODING"))
    for stream in (sys.stdin, sys.stdout, sys.stderr):
        if not isinstance(stream, io.TextIOWrapper):
            continue
        if stream.encoding.lower().replace("-", "") == "utf8":
            if stream is not sys.stdin and stream.errors == "strict" and not has_chosen_encoding:
                stream.reconfigure(errors="backslashreplace")
            continue
        if not has_chosen_encoding and not stream.isatty():
            stream.reconfigure(encoding="utf-8", errors=stream.errors)
        elif stream is not sys.stdin:
            stream.reconfigure(errors="backslashreplace")
