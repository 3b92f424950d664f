"""Fetching a file over HTTP so that what broke goes on where it was: what came so far lies in a ``.part`` file."""

from __future__ import annotations

import http.client
import urllib.error
import urllib.request
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import cast

from linkwright._version import __version__
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, phrase
from linkwright.model_files.installed import by_hand
from linkwright.model_files.table import ModelEntry

Progress = Callable[[int, int | None], None]
"""Takes how many bytes are there, and how many there will be, where the server says so."""

_AT_ONCE = 1 << 16
_SILENCE_SECONDS = 60.0
_VAIN_TRIES = 3
"""So often in a row a connection may break without a byte more before we give up."""

_PARTIAL, _NOT_SATISFIABLE = 206, 416


def fetch(entry: ModelEntry, address: str, part: Path, progress: Progress) -> None:
    """Fetch a file; whatever of it is there already is not fetched again, if the server can begin in its middle.

    The system's settings for proxies hold (``https_proxy``).

    Args:
        entry: the model that it is, for what is said and how much may come.
        address: http or https.
        part: where it is written; it stays when fetching breaks, and the next call goes on with it.
        progress: is told how far it has come.

    Raises:
        LinkwrightError: MODEL103 it cannot be fetched, MODEL106 it cannot be written.
    """
    vain = 0
    while True:
        before = _size(part)
        try:
            if _fetch_rest(entry, address, part, progress):
                return
            problem = phrase("the connection broke off")
        except urllib.error.HTTPError as error:
            with error:
                if error.code != _NOT_SATISFIABLE or not before:
                    answer = phrase("the server answers {status} {reason}", status=error.code, reason=error.reason)
                    raise _failed(entry, address, answer) from None
                if error.headers.get("Content-Range") == f"bytes */{before}":
                    return  # it was whole, and only not put in its place
            part.unlink()
            problem = phrase("what was there was of another file")
        except (urllib.error.URLError, OSError, http.client.HTTPException, ValueError) as error:
            if not isinstance(error, _BrokenError) and _size(part) == before:
                raise _failed(entry, address, foreign(_reason(error))) from None
            problem = foreign(_reason(error))
        vain = 0 if _size(part) > before else vain + 1
        if vain == _VAIN_TRIES:
            raise _failed(entry, address, problem)


class _BrokenError(OSError):
    """A connection that was there broke."""


def _fetch_rest(entry: ModelEntry, address: str, part: Path, progress: Progress) -> bool:
    """One try from where the part ends; whether it is whole then."""
    done = _size(part)
    request = urllib.request.Request(address, headers={"User-Agent": f"linkwright/{__version__}"})  # noqa: S310 - http and https only, see `installing`
    if done:
        request.add_header("Range", f"bytes={done}-")
    with urllib.request.urlopen(request, timeout=_SILENCE_SECONDS) as response:  # noqa: S310 - as above
        if response.status != _PARTIAL:
            done = 0
        length = response.headers.get("Content-Length")
        total = done + int(length) if length is not None else None
        _limit(entry, address, total or 0)
        try:
            file = part.open("ab" if done else "wb")
        except OSError as error:
            raise cannot_write(part, error) from None
        with file:
            while block := _read(response):
                _limit(entry, address, done + len(block))
                try:
                    file.write(block)
                    file.flush()
                except OSError as error:
                    with suppress(OSError):  # from Python 3.14 on it tries again to write what could not be written
                        file.close()
                    raise cannot_write(part, error) from None
                done += len(block)
                progress(done, total)
    return total is None or done >= total


def _read(response: http.client.HTTPResponse) -> bytes:
    try:
        return response.read1(_AT_ONCE)
    except (OSError, http.client.HTTPException) as error:
        raise _BrokenError(_reason(error)) from error


def _limit(entry: ModelEntry, address: str, size: int) -> None:
    if size > entry.most_bytes:
        message = phrase("more comes than the about {megabytes} MB of the model", megabytes=entry.megabytes)
        raise _failed(entry, address, message)


def _size(part: Path) -> int:
    try:
        return part.stat().st_size
    except OSError:
        return 0


def _reason(error: BaseException) -> str:
    """What went wrong, in the words of the system."""
    inner = getattr(error, "reason", None)
    if isinstance(inner, BaseException):
        return _reason(inner)
    return cast("str | None", getattr(error, "strerror", None)) or str(error) or type(error).__name__


def _failed(entry: ModelEntry, address: str, problem: Phrase) -> LinkwrightError:
    message = phrase(
        "the model '{name}' cannot be fetched from {address}: {problem}",
        name=entry.name,
        address=address,
        problem=problem,
    )
    return LinkwrightError(Diagnostic("MODEL103", message, hint=by_hand(entry)))


def cannot_write(path: Path, error: OSError) -> LinkwrightError:
    """The error for a place that cannot be written to (MODEL106)."""
    message = phrase("cannot write '{path}': {strerror}", path=path, strerror=foreign(error.strerror or error))
    hint = phrase("make room, or choose another folder with --to")
    return LinkwrightError(Diagnostic("MODEL106", message, hint=hint))
