"""Recordings that pages upload, whose files arrive in blocks and are stored in a temporary folder.

A page first announces the files, and receives a key if there is enough space. Uploads that are cancelled or stall are
removed. Every page with the token may upload. File names are checked, and none can refer to a file outside the folder.
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

from linkwright.bag.scratch import scratch_folder
from linkwright.diagnostics import LinkwrightError, Phrase, foreign, in_one_line, phrase
from linkwright.diagnostics.translation import localized
from linkwright.page.audience import requested_language
from linkwright.page.http_server import web

if TYPE_CHECKING:
    from linkwright.page.audience import Audience

PATIENCE = 60.0
"""Seconds after which files of an upload that stalls are removed."""

LEFT_FREE = 256_000_000
"""Bytes of the disk to leave free."""

_MOST_AT_ONCE = 4
_MOST_FILES = 1000
_BLOCK = 1 << 20
_FILE = re.compile(r"metadata\.yaml|[^/\\\0]{1,200}\.(?:mcap|db3)(?:\.zstd)?")
_NAME = re.compile(r"[^/\\\0]{1,200}")
_DOTS = frozenset({".", ".."})


class Guests(Protocol):
    """The recordings that are shown to pages of this server, in addition to its viewer."""

    async def open(self, path: Path, scratch: TemporaryDirectory[str] | None) -> str:
        """Show a recording, and return the key by which pages name it.

        `scratch`, if given, is removed when the recording is no longer shown.

        Raises:
            LinkwrightError: the recording cannot be shown; `scratch` still exists.
        """

    def audience(self, key: str) -> Audience | None:
        """Return the pages that show the recording with a key, or None if there is no such recording."""

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
    """The handlers of requests with which pages upload recordings.

    Args:
        guests: shows the recordings.
        left_free: the number of bytes to leave free on the disk.
    """

    def __init__(self, guests: Guests, left_free: int = LEFT_FREE) -> None:
        self._guests = guests
        self._left_free = left_free
        self._uploads: dict[str, _Upload] = {}
        self._sweeping: asyncio.TimerHandle | None = None

    def close(self) -> None:
        """Cancel all uploads, and remove their files."""
        if self._sweeping is not None:
            self._sweeping.cancel()
        for upload in self._uploads.values():
            upload.scratch.cleanup()
        self._uploads.clear()

    async def show(self, request: web.Request, path: Path) -> web.Response:
        """Show a recording that is a file of this machine, and return the response for the page.

        The file is not removed afterwards.
        """
        try:
            return web.json_response({"recording": await self._guests.open(path, None)})
        except LinkwrightError as error:
            return _refused(request, in_one_line(error.diagnostics))

    # --- requests ----------------------------------------------------------------------------------------------

    async def announce(self, request: web.Request) -> web.Response:
        """Respond to an announcement with a key for the upload, or with the reason for refusing it."""
        try:
            announced = msgspec.json.decode(await request.read(), type=_Announcement)
        except msgspec.DecodeError as error:
            return web.Response(status=400, text=f"{error}\n")
        names = [file.name for file in announced.files]
        wrong = next((name for name in names if not _FILE.fullmatch(name)), None)
        if wrong is not None:
            return _refused(
                request,
                phrase("'{name}' is not a recording file: its name must end in .mcap or .db3", name=wrong[:100]),
            )
        if not names or len(names) != len(set(names)) or len(names) > _MOST_FILES:
            return _refused(
                request, phrase("the dropped files contain no recording: drop files that end in .mcap or .db3")
            )
        if (
            not _NAME.fullmatch(announced.name)
            or announced.name in _DOTS
            or any(file.size < 0 for file in announced.files)
        ):
            return web.Response(status=400, text="Give a name without slashes, and the sizes.\n")
        if len(self._uploads) >= _MOST_AT_ONCE:
            return _refused(
                request,
                phrase(
                    "{count} other recordings are being uploaded: wait until one of them is complete",
                    count=_MOST_AT_ONCE,
                ),
            )
        scratch = scratch_folder()
        needed = sum(file.size for file in announced.files)
        free = shutil.disk_usage(scratch.name).free
        if needed + self._left_free > free:
            scratch.cleanup()
            return _refused(request, _no_room(needed, free))
        key = secrets.token_urlsafe(16)
        upload = self._uploads[key] = _Upload(announced, scratch)
        await asyncio.to_thread(upload.folder.mkdir)
        self._sweep_later()
        return web.json_response({"key": key})

    async def take(self, request: web.Request) -> web.Response:
        """Receive one of the announced files."""
        upload = self._uploads.get(request.match_info["key"])
        number = int(request.match_info["number"])
        if upload is None or number >= len(upload.announced.files) or number in upload.received or upload.busy:
            raise web.HTTPNotFound(text="No file with this name is expected.\n")
        file = upload.announced.files[number]
        upload.busy = True
        try:
            come = await self._write(request, upload, upload.folder / file.name, file.size)
        except OSError as error:
            self._remove(request.match_info["key"])
            if request.transport is None:
                return web.Response(status=400)  # the page was closed
            return _refused(
                request, phrase("the recording could not be stored: {reason}", reason=foreign(error.strerror or error))
            )
        finally:
            upload.busy = False
        if come != file.size:
            return web.Response(status=400, text="The file is incomplete.\n")
        upload.received.add(number)
        return web.Response(status=204)

    async def open(self, request: web.Request) -> web.Response:
        """Show a recording whose files have arrived."""
        upload = self._uploads.get(request.match_info["key"])
        if upload is None or len(upload.received) != len(upload.announced.files):
            raise web.HTTPNotFound(text="There is no upload with this name.\n")
        upload.busy = True
        try:
            shown = await self._guests.open(upload.target, upload.scratch)
        except LinkwrightError as error:
            found = localized(in_one_line(error.diagnostics), requested_language(request))
            self._remove(request.match_info["key"])
            return _problem(found)
        self._uploads.pop(request.match_info["key"], None)
        return web.json_response({"recording": shown})

    async def cancel_upload(self, request: web.Request) -> web.Response:
        """Cancel an upload, and remove the files that have arrived."""
        self._remove(request.match_info["key"])
        return web.Response(status=204)

    async def _write(self, request: web.Request, upload: _Upload, path: Path, size: int) -> int:
        """Write the body of a request to a file block by block, and return its size in bytes."""
        loop = asyncio.get_running_loop()
        come = 0
        with await asyncio.to_thread(path.open, "wb") as file:
            while come <= size:
                try:
                    block = await request.content.readexactly(_BLOCK)
                except asyncio.IncompleteReadError as rest:
                    block = rest.partial
                if not block:
                    break
                come += len(block)
                await asyncio.to_thread(file.write, block)
                upload.touched = loop.time()
        return come

    def _remove(self, key: str) -> None:
        upload = self._uploads.pop(key, None)
        if upload is not None:
            upload.scratch.cleanup()

    def _sweep_later(self) -> None:
        if self._sweeping is None:
            self._sweeping = asyncio.get_running_loop().call_later(PATIENCE / 4, self._sweep)

    def _sweep(self) -> None:
        """Cancel the uploads for which no data has arrived for a while."""
        self._sweeping = None
        now = asyncio.get_running_loop().time()
        for key, upload in list(self._uploads.items()):
            if not upload.busy and now - upload.touched > PATIENCE:
                self._remove(key)
        if self._uploads:
            self._sweep_later()


def _refused(request: web.Request, message: Phrase) -> web.Response:
    return _problem(localized(message, requested_language(request)))


def _problem(text: str) -> web.Response:
    """Return a response with an error for the user.

    Its status is 200, because browsers log responses with other codes as errors.
    """
    return web.json_response({"problem": text})


def _no_room(needed: int, free: int) -> Phrase:
    return phrase(
        "there is not enough space for a recording of {needed} MB on the program's machine: {free} MB are free",
        needed=needed // 1_000_000,
        free=free // 1_000_000,
    )
