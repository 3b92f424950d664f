"""Recordings that pages upload.

A page first announces the files, and receives a key if there is enough space. The files arrive in blocks, and are
stored in a temporary folder. Uploads that are cancelled or stall are removed. Every page with the token may upload.
File names are checked, so that they cannot refer to files outside the folder.
"""

from __future__ import annotations

import asyncio
import re
import secrets
import shutil
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Protocol

import msgspec

from linkwright.bag.scratch import create_scratch_folder
from linkwright.diagnostics import LinkwrightError, Phrase, foreign, join_messages, phrase
from linkwright.diagnostics.translation import localized
from linkwright.page.audience import find_requested_language
from linkwright.page.http_server import web

if TYPE_CHECKING:
    from linkwright.page.audience import Audience

IDLE_TIMEOUT_S = 60.0
"""Seconds without data after which the files of an upload are removed."""

MIN_FREE_BYTES = 256_000_000
"""The number of bytes that uploads leave free on the disk."""

_MAX_UPLOADS = 4
_MAX_FILES = 1000
_BLOCK_SIZE = 1 << 20
_FILE_NAME_PATTERN = re.compile(r"metadata\.yaml|[^/\\\0]{1,200}\.(?:mcap|db3)(?:\.zstd)?")
_NAME_PATTERN = re.compile(r"[^/\\\0]{1,200}")
_RESERVED_NAMES = frozenset({".", ".."})


class Guests(Protocol):
    """The recordings that are shown to pages of this server, in addition to its viewer."""

    async def open(self, path: Path, scratch: TemporaryDirectory[str] | None) -> str:
        """Show a recording, and return the key with which pages refer to it.

        `scratch` is a folder that is removed when the recording is no longer shown, or None.

        Raises:
            LinkwrightError: the recording cannot be shown; `scratch` still exists.
        """

    def audience(self, key: str) -> Audience | None:
        """Return the pages that show the recording with a key, or None if there is none."""

    async def close(self) -> None:
        """Stop showing recordings."""


class _File(msgspec.Struct, forbid_unknown_fields=True):
    name: str
    size: int


class _Announcement(msgspec.Struct, forbid_unknown_fields=True):
    """The announcement of an upload: the name of the file or folder, and its files."""

    name: str
    files: list[_File]


@dataclass(slots=True)
class _Upload:
    """An upload in progress, with its temporary folder."""

    announced: _Announcement
    scratch: TemporaryDirectory[str]
    received: set[int] = field(default_factory=set)
    touched: float = field(default_factory=lambda: asyncio.get_running_loop().time())
    busy: bool = False

    @property
    def folder(self) -> Path:
        return Path(self.scratch.name) / self.announced.name

    @property
    def target(self) -> Path:
        """The path of the recording's file or folder, to be opened when the upload is complete."""
        files = self.announced.files
        return self.folder / files[0].name if len(files) == 1 else self.folder


class Uploads:
    """Handles the requests with which pages upload recordings.

    Args:
        guests: shows the recordings.
        min_free_bytes: the number of bytes to leave free on the disk.
    """

    def __init__(self, guests: Guests, min_free_bytes: int = MIN_FREE_BYTES) -> None:
        self._guests = guests
        self._min_free_bytes = min_free_bytes
        self._uploads: dict[str, _Upload] = {}
        self._sweep_timer: asyncio.TimerHandle | None = None

    def close(self) -> None:
        """Cancel all uploads, and remove their files."""
        if self._sweep_timer is not None:
            self._sweep_timer.cancel()
        for upload in self._uploads.values():
            upload.scratch.cleanup()
        self._uploads.clear()

    async def show(self, request: web.Request, path: Path) -> web.Response:
        """Show a recording on this machine, and return the response for the page.

        The file is not removed afterwards.
        """
        try:
            return web.json_response({"recording": await self._guests.open(path, None)})
        except LinkwrightError as error:
            return _refusal(request, join_messages(error.diagnostics))

    # --- requests ----------------------------------------------------------------------------------------------

    async def announce(self, request: web.Request) -> web.Response:
        """Respond to an announcement with a key for the upload, or with the reason for refusing it."""
        try:
            announcement = msgspec.json.decode(await request.read(), type=_Announcement)
        except msgspec.DecodeError as error:
            return web.Response(status=400, text=f"{error}\n")
        names = [file.name for file in announcement.files]
        invalid_name = next((name for name in names if not _FILE_NAME_PATTERN.fullmatch(name)), None)
        if invalid_name is not None:
            return _refusal(
                request,
                phrase("'{name}' is not a recording file: its name must end in .mcap or .db3", name=invalid_name[:100]),
            )
        if not names or len(names) != len(set(names)) or len(names) > _MAX_FILES:
            return _refusal(
                request,
                phrase("the dropped files contain no recording: drop files with names that end in .mcap or .db3"),
            )
        if (
            not _NAME_PATTERN.fullmatch(announcement.name)
            or announcement.name in _RESERVED_NAMES
            or any(file.size < 0 for file in announcement.files)
        ):
            return web.Response(status=400, text="Give a name without slashes, and the sizes.\n")
        if len(self._uploads) >= _MAX_UPLOADS:
            return _refusal(
                request,
                phrase(
                    "{count} other recordings are being uploaded: wait until one of them is complete",
                    count=_MAX_UPLOADS,
                ),
            )
        scratch = create_scratch_folder()
        required_bytes = sum(file.size for file in announcement.files)
        free = shutil.disk_usage(scratch.name).free
        if required_bytes + self._min_free_bytes > free:
            scratch.cleanup()
            return _refusal(request, _no_space_text(required_bytes, free))
        key = secrets.token_urlsafe(16)
        upload = self._uploads[key] = _Upload(announcement, scratch)
        await asyncio.to_thread(upload.folder.mkdir)
        self._schedule_sweep()
        return web.json_response({"key": key})

    async def receive(self, request: web.Request) -> web.Response:
        """Receive one of the announced files."""
        upload = self._uploads.get(request.match_info["key"])
        number = int(request.match_info["number"])
        if upload is None or number >= len(upload.announced.files) or number in upload.received or upload.busy:
            raise web.HTTPNotFound(text="No file with this name is expected.\n")
        file = upload.announced.files[number]
        upload.busy = True
        try:
            received_bytes = await self._write(request, upload, upload.folder / file.name, file.size)
        except OSError as error:
            self._remove(request.match_info["key"])
            if request.transport is None:
                return web.Response(status=400)  # the page was closed
            return _refusal(
                request, phrase("the recording could not be stored: {reason}", reason=foreign(error.strerror or error))
            )
        finally:
            upload.busy = False
        if received_bytes != file.size:
            return web.Response(status=400, text="The file is incomplete.\n")
        upload.received.add(number)
        return web.Response(status=204)

    async def open(self, request: web.Request) -> web.Response:
        """Show an uploaded recording after all files have arrived."""
        upload = self._uploads.get(request.match_info["key"])
        if upload is None or len(upload.received) != len(upload.announced.files):
            raise web.HTTPNotFound(text="There is no upload with this name.\n")
        upload.busy = True
        try:
            recording_key = await self._guests.open(upload.target, upload.scratch)
        except LinkwrightError as error:
            problem_text = localized(join_messages(error.diagnostics), find_requested_language(request))
            self._remove(request.match_info["key"])
            return _problem_response(problem_text)
        self._uploads.pop(request.match_info["key"], None)
        return web.json_response({"recording": recording_key})

    async def cancel_upload(self, request: web.Request) -> web.Response:
        """Cancel an upload, and remove the files that have arrived."""
        self._remove(request.match_info["key"])
        return web.Response(status=204)

    async def _write(self, request: web.Request, upload: _Upload, path: Path, size: int) -> int:
        """Write the body of a request to a file block by block, and return its size in bytes."""
        loop = asyncio.get_running_loop()
        received_bytes = 0
        with await asyncio.to_thread(path.open, "wb") as file:
            while received_bytes <= size:
                try:
                    block = await request.content.readexactly(_BLOCK_SIZE)
                except asyncio.IncompleteReadError as rest:
                    block = rest.partial
                if not block:
                    break
                received_bytes += len(block)
                await asyncio.to_thread(file.write, block)
                upload.touched = loop.time()
        return received_bytes

    def _remove(self, key: str) -> None:
        upload = self._uploads.pop(key, None)
        if upload is not None:
            upload.scratch.cleanup()

    def _schedule_sweep(self) -> None:
        if self._sweep_timer is None:
            self._sweep_timer = asyncio.get_running_loop().call_later(IDLE_TIMEOUT_S / 4, self._cancel_stalled)

    def _cancel_stalled(self) -> None:
        """Cancel the uploads that have not received data for a while."""
        self._sweep_timer = None
        now = asyncio.get_running_loop().time()
        for key, upload in list(self._uploads.items()):
            if not upload.busy and now - upload.touched > IDLE_TIMEOUT_S:
                self._remove(key)
        if self._uploads:
            self._schedule_sweep()


def _refusal(request: web.Request, message: Phrase) -> web.Response:
    return _problem_response(localized(message, find_requested_language(request)))


def _problem_response(text: str) -> web.Response:
    """Return a response with an error for the user.

    The status is 200, because browsers log responses with other codes as errors.
    """
    return web.json_response({"problem": text})


def _no_space_text(required_bytes: int, free: int) -> Phrase:
    return phrase(
        "the machine that runs Linkwright does not have enough space for a recording of "
        "{needed} MB: {free} MB are free",
        needed=required_bytes // 1_000_000,
        free=free // 1_000_000,
    )
