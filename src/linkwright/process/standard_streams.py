"""Makes the standard streams write any text completely, in any locale.

Descriptions are UTF-8 and can contain names in any script, and messages can be Chinese, but Western editions of Windows
write files and pipes in code page 1252. This module imports little, because short commands load it.
"""

from __future__ import annotations

import errno
import io
import os
import sys

TYPE_CHECKING = False  # defined here, because importing `typing` takes longer than the rest of this module
if TYPE_CHECKING:
    from typing import Any


class _WholeWrites(io.RawIOBase):
    """An unbuffered file that writes all given bytes, or raises OSError."""

    def __init__(self, raw: io.RawIOBase) -> None:
        self._raw = raw

    def writable(self) -> bool:
        return True

    def isatty(self) -> bool:
        return self._raw.isatty()

    def fileno(self) -> int:
        return self._raw.fileno()

    def write(self, data: Any, /) -> int:
        rest = memoryview(data).cast("B")
        size = len(rest)
        while rest:
            taken = self._raw.write(rest)
            if taken is None:
                raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN))
            rest = rest[taken:]
        return size


def _write_completely() -> None:
    """Make unbuffered standard output raise an error if the disk is full.

    Standard output is unbuffered with ``python -u`` or ``PYTHONUNBUFFERED``. If the disk is full, a write to such a
    stream may write only a part of the data, and Python discards the rest.
    """
    out = sys.stdout
    if isinstance(out, io.TextIOWrapper) and isinstance(out.buffer, io.FileIO):
        sys.stdout = io.TextIOWrapper(_WholeWrites(out.buffer), out.encoding, out.errors, write_through=True)


def accept_any_text() -> None:
    """Make the standard streams write any text, and write it completely.

    Files and pipes use UTF-8, like description files, and like Python from 3.15 on (PEP 686). A character that a
    terminal cannot display is written as an escape sequence, as with an encoding in ``PYTHONIOENCODING``.
    """
    _write_completely()
    chosen = bool(os.environ.get("PYTHONIOENCODING"))
    for stream in (sys.stdin, sys.stdout, sys.stderr):
        if not isinstance(stream, io.TextIOWrapper) or stream.encoding.lower().replace("-", "") == "utf8":
            continue
        if not chosen and not stream.isatty():
            stream.reconfigure(encoding="utf-8", errors=stream.errors)
        elif stream is not sys.stdin:
            stream.reconfigure(errors="backslashreplace")
