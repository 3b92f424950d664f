"""Pages ask for the robot as a file, and fetch it once."""

from __future__ import annotations

import asyncio
import re
import secrets
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, ClassVar
from urllib.parse import quote

from linkwright.diagnostics import LinkwrightError
from linkwright.diagnostics.translation import translated
from linkwright.viewer.audience import Page
from linkwright.viewer.export.formats import FORMATS, export_snapshot
from linkwright.viewer.features import PageFeature
from linkwright.viewer.protocol import AskExport, ExportFailed, ExportReady, View

if TYPE_CHECKING:
    from linkwright.graph import Logger
    from linkwright.viewer.export.snapshot import Snapshot

_KEPT_SECONDS = 60.0
_MOST_KEPT = 4


@dataclass(frozen=True, slots=True)
class ExportedFile:
    """A file that waits to be fetched."""

    name: str
    content_type: str
    data: bytes
    made: float


class ExportedFiles:
    """Files by a key that only the page knows that asked; each can be fetched once, and soon."""

    def __init__(self) -> None:
        self._files: dict[str, ExportedFile] = {}

    def put(self, file: ExportedFile) -> str:
        """Keep a file; its address."""
        while len(self._files) >= _MOST_KEPT:
            del self._files[next(iter(self._files))]
        key = secrets.token_urlsafe(16)
        self._files[key] = file
        return f"/export/{key}/{quote(file.name)}"

    def take(self, key: str) -> ExportedFile | None:
        """The file with a key, which is forgotten."""
        now = time.monotonic()
        for old in [old for old, file in self._files.items() if now - file.made > _KEPT_SECONDS]:
            del self._files[old]
        return self._files.pop(key, None)


class ExportFeature(PageFeature):
    """Makes files of what a page sees.

    Args:
        snapshot: of what a page sees, through the camera that it says.
        files: where they wait.
        logger: told of faults of ours.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (AskExport,)

    def __init__(self, snapshot: Callable[[Page, View], Snapshot], files: ExportedFiles, logger: Logger) -> None:
        self._snapshot = snapshot
        self._logger = logger
        self._files = files
        self._working: dict[Page, asyncio.Task[None]] = {}

    def receive(self, page: Page, message: AskExport) -> None:
        """Begin to make a file; one at a time for each page."""
        if message.format not in FORMATS or page in self._working:
            return
        task = asyncio.get_running_loop().create_task(self._make(page, message))
        self._working[page] = task
        task.add_done_callback(lambda _: self._working.pop(page, None))

    def close(self) -> None:
        """Make no more."""
        for task in self._working.values():
            task.cancel()

    async def _make(self, page: Page, message: AskExport) -> None:
        try:
            snapshot = self._snapshot(page, message.view)
            data = await asyncio.to_thread(partial(export_snapshot, snapshot, message.format))
        except LinkwrightError as error:
            page.send(ExportFailed("; ".join(each.message for each in translated(error.diagnostics))))
            return
        except Exception as error:  # noqa: BLE001  # a fault of ours must not leave the page waiting
            self._logger.error(f"The export failed:\n{traceback.format_exc()}")  # noqa: TRY400  # no logger of logging
            page.send(ExportFailed(f"{type(error).__name__}: {error}"))
            return
        name = re.sub(r"[^\w.-]+", "_", snapshot.name).strip("._") or "robot"
        file = ExportedFile(f"{name}.{message.format}", FORMATS[message.format].content_type, data, time.monotonic())
        page.send(ExportReady(self._files.put(file), file.name))
