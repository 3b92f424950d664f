"""The token of a port, kept for the next start, so that open pages go on when the program is started again.

There is a file for each port, which only its user can read. A token lives for a week from when it was made, so that
one that leaked does not open what is shown for ever. Servers that other machines can reach do not keep theirs: it goes
over the network in plain text.
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

from linkwright.viewer.config.locations import state_folder
from linkwright.whole_files import write_whole_file

_LIFETIME = 7 * 24 * 3600.0
"""Seconds."""

_TOKEN = re.compile(r"[\w-]{32}")
_LONGEST = 1000
"""Bytes of such a file."""


def new_token() -> str:
    """A token that nobody can guess, 192 bits."""
    return secrets.token_urlsafe(24)


@dataclass(frozen=True)
class PortToken:
    """The token of a port.

    Attributes:
        token: what pages show.
        pages_wait: whether pages were open when the program before ended, which look for this one now.
    """

    token: str
    pages_wait: bool = False


def token_folder() -> Path:
    """The folder of the files, below the user's state."""
    return state_folder() / "page-tokens"


def keep_token(port: int) -> PortToken:
    """The token that the user's last program on a port had, or a new one, which is kept from now on."""
    now = time.time()
    made, kept = _read(token_folder() / str(port))
    if kept is None or not 0.0 <= now - made < _LIFETIME:
        made, kept = now, PortToken(new_token())
    _write(port, made, PortToken(kept.token))
    return kept


def leave_token(port: int, token: str, *, pages_wait: bool) -> None:
    """Note, as a program ends, whether its pages wait for the next; nothing where the file has another token."""
    made, kept = _read(token_folder() / str(port))
    if kept is not None and kept.token == token:
        _write(port, made, PortToken(token, pages_wait))


def _read(path: Path) -> tuple[float, PortToken | None]:
    """When a token was made, seconds since the epoch, and the token; None where no file of this user alone has one."""
    with suppress(OSError, ValueError, TypeError, KeyError, RecursionError):
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
        with open(descriptor, "rb") as file:  # noqa: PTH123 - a descriptor, not a path
            if _is_private(os.fstat(descriptor)):
                told = json.loads(file.read(_LONGEST))
                made, token = float(told["made"]), str(told["token"])
                if _TOKEN.fullmatch(token):
                    return made, PortToken(token, told.get("pages wait") is True)
    return 0.0, None


def _is_private(facts: os.stat_result) -> bool:
    """Whether nobody but this user can have read or written a file; Windows guards the user's folders itself."""
    if not stat.S_ISREG(facts.st_mode):
        return False
    user = getattr(os, "getuid", None)
    return user is None or (facts.st_uid == user() and not facts.st_mode & 0o077)


def _write(port: int, made: float, kept: PortToken) -> None:
    """Keep a token; where the state cannot be written, the next program has another, which is no error."""
    folder = token_folder()
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        told = {"token": kept.token, "made": made, "pages wait": kept.pages_wait}
        write_whole_file(folder / str(port), json.dumps(told), mode=0o600)
