"""Resumable downloads over HTTP: the received part is stored in a ``.part`` file."""

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
"""Called with the number of received bytes, and the total if the server reports it."""

_AT_ONCE = 1 << 16
_SILENCE_SECONDS = 60.0
_VAIN_TRIES = 3
"""The maximum number of consecutive broken connections without a new byte."""

_PARTIAL, _NOT_SATISFIABLE = 206, 416


def fetch(entry: ModelEntry, address: str, part: Path, progress: Progress) -> None:
    """Download a file; an existing part is resumed if the server supports it.

    The system's proxy settings apply (``https_proxy``).

    Args:
        entry: the model, for messages and the size limit.
        address: an http or https URL.
        part: the file to write; it stays after an error, and the next call resumes it.
        progress: receives the progress.

    Raises:
        LinkwrightError: MODEL103 it cannot be downloaded, MODEL106 it cannot be written.
    """
    vain = 0
    while True:
        before = _size(part)
        try:
            if _fetch_rest(entry, address, part, progress):
                return
            problem = phrase("the connection was lost")
        except urllib.error.HTTPError as error:
            with error:
                if error.code != _NOT_SATISFIABLE or not before:
                    answer = phrase(
                        "the server responds with {status} {reason}", status=error.code, reason=error.reason
                    )
                    raise _failed(entry, address, answer) from None
                if error.headers.get("Content-Range") == f"bytes */{before}":
                    return  # The file was complete, but not yet installed.
            part.unlink()
            problem = phrase("the partial download belongs to another file")
        except (urllib.error.URLError, OSError, http.client.HTTPException, ValueError) as error:
            if not isinstance(error, _BrokenError) and _size(part) == before:
                raise _failed(entry, address, foreign(_reason(error))) from None
            problem = foreign(_reason(error))
        vain = 0 if _size(part) > before else vain + 1
        if vain == _VAIN_TRIES:
            raise _failed(entry, address, problem)


class _BrokenError(OSError):
    """An established connection broke."""


def _fetch_rest(entry: ModelEntry, address: str, part: Path, progress: Progress) -> bool:
    """Try once from the end of the part, and return whether the file is complete."""
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
                    with suppress(OSError):  # from Python 3.14 on, it would retry the failed write
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
        message = phrase("the download is larger than the expected {megabytes} MB", megabytes=entry.megabytes)
        raise _failed(entry, address, message)


def _size(part: Path) -> int:
    try:
        return part.stat().st_size
    except OSError:
        return 0


def _reason(error: BaseException) -> str:
    """Return the system's error message."""
    inner = getattr(error, "reason", None)
    if isinstance(inner, BaseException):
        return _reason(inner)
    return cast("str | None", getattr(error, "strerror", None)) or str(error) or type(error).__name__


def _failed(entry: ModelEntry, address: str, problem: Phrase) -> LinkwrightError:
    message = phrase(
        "the model '{name}' cannot be downloaded from {address}: {problem}",
        name=entry.name,
        address=address,
        problem=problem,
    )
    return LinkwrightError(Diagnostic("MODEL103", message, hint=by_hand(entry)))


def cannot_write(path: Path, error: OSError) -> LinkwrightError:
    """Return the error for a path that is not writable (MODEL106)."""
    message = phrase("cannot write '{path}': {strerror}", path=path, strerror=foreign(error.strerror or error))
    hint = phrase("free disk space, or choose another folder with --to")
    return LinkwrightError(Diagnostic("MODEL106", message, hint=hint))
