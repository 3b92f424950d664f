"""Files that were made for a page: each can be fetched once, and soon."""

from __future__ import annotations

import secrets
import time
from dataclasses import dataclass, field
from urllib.parse import quote

_KEPT_SECONDS = 60.0
_MOST_KEPT = 4


@dataclass(frozen=True, slots=True)
class Download:
    """A file that waits to be fetched."""

    name: str
    content_type: str
    data: bytes
    made: float = field(default_factory=time.monotonic)


class Downloads:
    """Files by a key that only the page knows that asked."""

    def __init__(self) -> None:
        self._files: dict[str, Download] = {}

    def put(self, file: Download) -> str:
        """Keep a file; its address."""
        while len(self._files) >= _MOST_KEPT:
            del self._files[next(iter(self._files))]
        key = secrets.token_urlsafe(16)
        self._files[key] = file
        return f"/export/{key}/{quote(file.name)}"

    def take(self, key: str) -> Download | None:
        """The file with a key, which is forgotten."""
        now = time.monotonic()
        for old in [old for old, file in self._files.items() if now - file.made > _KEPT_SECONDS]:
            del self._files[old]
        return self._files.pop(key, None)
