"""Messages of the Language Server Protocol on a stream of bytes.

Each message is a header with the length, and the content.
"""

from __future__ import annotations

import re
from typing import IO

_LENGTH = re.compile(rb"Content-Length: *(\d+)", re.IGNORECASE)
_MAX_HEADER_LINES = 10


def add_header(content: bytes) -> bytes:
    """Return a message preceded by its header."""
    return b"Content-Length: %d\r\n\r\n%b" % (len(content), content)


def read_content(stream: IO[bytes]) -> bytes | None:
    """Return the content of the next message, or None at the end of the stream."""
    length = None
    for _ in range(_MAX_HEADER_LINES):
        line = stream.readline()
        length = _LENGTH.match(line) or length
        if line in (b"\r\n", b""):
            break
    if length is None:
        return None
    content = stream.read(int(length[1]))
    return content if len(content) == int(length[1]) else None
