"""Keys for the contents of mesh files, so that a file that exists twice is read once."""

from __future__ import annotations

import hashlib
from pathlib import Path

ContentKey = tuple[str, bytes]
"""The format and a hash of the bytes."""
_MAX_BYTES = 64 << 20


def content_key(path: Path, unless: bytes | None = None) -> ContentKey | None:
    """Return a key that is equal for files with the same bytes in the same format; None if there is none.

    Args:
        path: the file.
        unless: bytes with which a file has no key, such as those before the name of another file.
    """
    try:
        content = path.read_bytes() if path.is_file() and path.stat().st_size <= _MAX_BYTES else None
    except OSError:
        return None
    if content is None or (unless is not None and unless in content):
        return None
    return path.suffix.lower(), hashlib.sha256(content).digest()
