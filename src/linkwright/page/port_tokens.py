"""The token of a port, stored for the next start, so that open pages reconnect when the program is started again.

There is a file for each port, which only its user can read. A token is valid for a week after its creation, so that
a leaked one does not give access for ever. Servers that other machines can reach do not store theirs: it goes over
the network in plain text.
"""

from __future__ import annotations

import json
import os
import re
import secrets
import stat
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from linkwright.files.user_folders import state_folder
from linkwright.files.whole_files import write_whole_file

_LIFETIME = 7 * 24 * 3600.0
"""Seconds."""

_TOKEN = re.compile(r"[\w-]{32}")
_LONGEST = 1000
"""Most bytes of such a file."""


def new_token() -> str:
    """Return a random token of 192 bits."""
    return secrets.token_urlsafe(24)


@dataclass(frozen=True)
class PortToken:
    """The token of a port.

    Attributes:
        token: the token that pages send.
        pages_wait: whether pages were open at the end of the former program, which now look for this one.
    """

    token: str
    pages_wait: bool = False


def token_folder() -> Path:
    """The folder of the files, below the user's state."""
    return state_folder() / "page-tokens"


def keep_token(port: int) -> PortToken:
    """Return the token of the user's last program on a port, or a new one, and store it."""
    now = time.time()
    made, stored = _read(token_folder() / str(port))
    if stored is None or not 0.0 <= now - made < _LIFETIME:
        made, stored = now, PortToken(new_token())
    _write(port, made, PortToken(stored.token))
    return stored


def leave_token(port: int, token: str, *, pages_wait: bool) -> None:
    """Store at the end of a program whether its pages wait for the next one, unless the file has another token."""
    made, stored = _read(token_folder() / str(port))
    if stored is not None and stored.token == token:
        _write(port, made, PortToken(token, pages_wait))


def _read(path: Path) -> tuple[float, PortToken | None]:
    """Return a token's creation time, seconds since the epoch, and the token; None unless the file is private."""
    with suppress(OSError, ValueError, TypeError, KeyError, RecursionError):
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
        with open(descriptor, "rb") as file:  # noqa: PTH123 - a descriptor, not a path
            if _is_private(os.fstat(descriptor)):
                stored = json.loads(file.read(_LONGEST))
                made, token = float(stored["made"]), str(stored["token"])
                if _TOKEN.fullmatch(token):
                    return made, PortToken(token, stored.get("pages wait") is True)
    return 0.0, None


def _is_private(facts: os.stat_result) -> bool:
    """Whether only this user can have read or written a file; Windows protects the user's folders itself."""
    if not stat.S_ISREG(facts.st_mode):
        return False
    user = getattr(os, "getuid", None)
    return user is None or (facts.st_uid == user() and not facts.st_mode & 0o077)


def _write(port: int, made: float, port_token: PortToken) -> None:
    """Store a token; if the state cannot be written, the next program has another, which is not an error."""
    folder = token_folder()
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        content = {"token": port_token.token, "made": made, "pages wait": port_token.pages_wait}
        write_whole_file(folder / str(port), json.dumps(content), mode=0o600)
