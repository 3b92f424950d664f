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
from linkwright.model_files.installed import manual_download_hint
from linkwright.model_files.table import ModelEntry

Progress = Callable[[int, int | None], None]
"""A callback for the number of received bytes, and the total or None if the server does not report it."""

_BLOCK_BYTES = 1 << 16
_TIMEOUT_S = 60.0
_MAX_FAILED_TRIES = 3
"""The maximum number of consecutive broken connections without a new byte."""

_HTTP_PARTIAL_CONTENT, _HTTP_RANGE_NOT_SATISFIABLE = 206, 416


def fetch(entry: ModelEntry, address: str, part_file: Path, progress: Progress) -> None:
    """Download a file, or resume its download if there is a part and the server supports it.

    The system's proxy settings apply (``https_proxy``).

    Args:
        entry: the model, for messages and the size limit.
        address: an http or https URL.
        part_file: the file to write. It stays after an error, and the next call resumes it.
        progress: the function that receives the progress.

    Raises:
        LinkwrightError: MODEL103 if the file cannot be downloaded, or MODEL106 if it cannot be written.
    """
    failed_tries = 0
    while True:
        size_before = _get_file_size(part_file)
        try:
            if _fetch_rest(entry, address, part_file, progress):
                return
            problem = phrase("the connection was lost")
        except urllib.error.HTTPError as error:
            with error:
                if error.code != _HTTP_RANGE_NOT_SATISFIABLE or not size_before:
                    response_text = phrase(
                        "the server responds with {status} {reason}", status=error.code, reason=error.reason
                    )
                    raise _download_error(entry, address, response_text) from None
                if error.headers.get("Content-Range") == f"bytes */{size_before}":
                    return  # The file was complete, but not yet installed.
            part_file.unlink()
            problem = phrase("the partial download belongs to another file")
        except (urllib.error.URLError, OSError, http.client.HTTPException, ValueError) as error:
            if not isinstance(error, _ConnectionLostError) and _get_file_size(part_file) == size_before:
                raise _download_error(entry, address, foreign(_get_reason(error))) from None
            problem = foreign(_get_reason(error))
        failed_tries = 0 if _get_file_size(part_file) > size_before else failed_tries + 1
        if failed_tries == _MAX_FAILED_TRIES:
            raise _download_error(entry, address, problem)


class _ConnectionLostError(OSError):
    """Raised when an established connection breaks."""


def _fetch_rest(entry: ModelEntry, address: str, part_file: Path, progress: Progress) -> bool:
    """Request the rest of a file once, append it, and return whether the file is complete."""
    received = _get_file_size(part_file)
    request = urllib.request.Request(address, headers={"User-Agent": f"linkwright/{__version__}"})  # noqa: S310 - http and https only, see `installation`
    if received:
        request.add_header("Range", f"bytes={received}-")
    with urllib.request.urlopen(request, timeout=_TIMEOUT_S) as response:  # noqa: S310 - as above
        if response.status != _HTTP_PARTIAL_CONTENT:
            received = 0
        length = response.headers.get("Content-Length")
        total = received + int(length) if length is not None else None
        _check_size(entry, address, total or 0)
        try:
            file = part_file.open("ab" if received else "wb")
        except OSError as error:
            raise write_error(part_file, error) from None
        with file:
            while block := _read_block(response):
                _check_size(entry, address, received + len(block))
                try:
                    file.write(block)
                    file.flush()
                except OSError as error:
                    with suppress(OSError):  # from Python 3.14 on, closing retries the failed write
                        file.close()
                    raise write_error(part_file, error) from None
                received += len(block)
                progress(received, total)
    return total is None or received >= total


def _read_block(response: http.client.HTTPResponse) -> bytes:
    try:
        return response.read1(_BLOCK_BYTES)
    except (OSError, http.client.HTTPException) as error:
        raise _ConnectionLostError(_get_reason(error)) from error


def _check_size(entry: ModelEntry, address: str, size: int) -> None:
    if size > entry.max_bytes:
        message = phrase("the download is larger than the expected {megabytes} MB", megabytes=entry.megabytes)
        raise _download_error(entry, address, message)


def _get_file_size(part_file: Path) -> int:
    try:
        return part_file.stat().st_size
    except OSError:
        return 0


def _get_reason(error: BaseException) -> str:
    """Return the system's error message."""
    cause = getattr(error, "reason", None)
    if isinstance(cause, BaseException):
        return _get_reason(cause)
    return cast("str | None", getattr(error, "strerror", None)) or str(error) or type(error).__name__


def _download_error(entry: ModelEntry, address: str, problem: Phrase) -> LinkwrightError:
    message = phrase(
        "the model '{name}' cannot be downloaded from {address}: {problem}",
        name=entry.name,
        address=address,
        problem=problem,
    )
    return LinkwrightError(Diagnostic("MODEL103", message, hint=manual_download_hint(entry)))


def write_error(path: Path, error: OSError) -> LinkwrightError:
    """Return the error for a path that is not writable (MODEL106)."""
    message = phrase("cannot write '{path}': {reason}", path=path, reason=foreign(error.strerror or error))
    hint = phrase("free disk space, or choose another folder with --to")
    return LinkwrightError(Diagnostic("MODEL106", message, hint=hint))
