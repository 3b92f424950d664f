"""Standard streams that take every text, whole, whichever code page, locale and disk the system has.

Descriptions are UTF-8 and may name a link in any script, and messages may be Chinese; a Windows of the West writes into
files and pipes by code page 1252. It imports little, because short commands load it.
"""

from __future__ import annotations

import errno
import io
import os
import sys

TYPE_CHECKING = False  # as that of `typing`, which takes longer to import than everything else here
if TYPE_CHECKING:
    from typing import Any


class _WholeWrites(io.RawIOBase):
    """A file without a buffer that writes all bytes it is given, or raises OSError."""

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
    """Let unbuffered standard output (``python -u``, ``PYTHONUNBUFFERED``) raise an error if a disk is full.

    A write to such a stream may write only a part, on a full disk, and Python drops the rest.
    """
    out = sys.stdout
    if isinstance(out, io.TextIOWrapper) and isinstance(out.buffer, io.FileIO):
        sys.stdout = io.TextIOWrapper(_WholeWrites(out.buffer), out.encoding, out.errors, write_through=True)


def accept_any_text() -> None:
    """Let standard streams write every text, and all of it.

    Files and pipes use UTF-8, like files of descriptions, and like Python itself from 3.15 on (PEP 686). A
    character that a terminal lacks is written as its number, as with an encoding in ``PYTHONIOENCODING``.
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
