"""The connection of a view with a text editor, over standard input and output.

Each line of input is a JSON object with one of these members:

- ``texts``: by absolute path, each text that is new or has changed, as an object with ``text`` and ``number``, or null
  for a file that was closed;
- ``cursor``: an object with ``file`` and ``line`` (from 1).

Each line of output is a JSON object, too:

- ``open``: the ``file``, ``line`` and ``column`` of an element that the user selected in a page;
- ``edit``: the ``file`` and the new ``text`` after the robot was edited in a page, with the ``number`` of the text that
  was edited, or 0 for a file without one.

The view ends with its input.
"""

from __future__ import annotations

import asyncio
import json
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.descriptions.unsaved import UnsavedText, UpdateOutcome
from linkwright.page.protocol.description import SourceRange
from linkwright.panels.text_editor import TextEditorFeature

if TYPE_CHECKING:
    from linkwright.viewer import Viewer


class TextEditorConnection:
    """The connection to a text editor, which owns the editor's unsaved texts.

    It reads the messages of the editor in a thread, and handles them on the event loop.

    Args:
        viewer: the viewer whose pages are connected.
        on_ended: called when the editor has closed the input.
    """

    def __init__(self, viewer: Viewer, on_ended: Callable[[], object]) -> None:
        self._on_ended = on_ended
        self._loop = asyncio.get_running_loop()
        self._unsaved = viewer.context.library.unsaved
        self._tasks: set[asyncio.Task[UpdateOutcome]] = set()
        self._feature = viewer.add_feature(TextEditorFeature)
        self._feature.selected = self._open_in_editor
        threading.Thread(target=self._read, name="linkwright-text-editor", daemon=True).start()

    def edit(self, path: str, number: int, text: str) -> None:
        """Send the editor a text that was edited in a page; see `TextOwner.edit`."""
        _write({"edit": {"file": path, "number": number, "text": text}})

    def _read(self) -> None:
        with suppress(RuntimeError, ValueError):  # the event loop is closed, or the input is
            for line in sys.stdin:
                self._loop.call_soon_threadsafe(self._receive, line)
            self._loop.call_soon_threadsafe(self._on_ended)

    def _receive(self, line: str) -> None:
        try:
            message = json.loads(line)
        except ValueError:
            return
        if not isinstance(message, dict):
            return
        texts, cursor = message.get("texts"), message.get("cursor")
        for path, content in texts.items() if isinstance(texts, dict) else ():
            task = self._loop.create_task(self._set_text(path, content))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)
        if isinstance(cursor, dict) and isinstance(cursor.get("line"), int):
            self._feature.show(Path(str(cursor.get("file"))), cursor["line"])

    async def _set_text(self, path: str, content: object) -> UpdateOutcome:
        if not isinstance(content, dict):
            return await self._unsaved.remove(self, path)
        number, text = content.get("number"), str(content.get("text", ""))
        return await self._unsaved.store(UnsavedText(self, path, number if isinstance(number, int) else 0, text))

    def _open_in_editor(self, source_range: SourceRange) -> None:
        _write({"open": {"file": source_range.file, "line": source_range.line, "column": source_range.column}})


def _write(message: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(message) + "\n")
    sys.stdout.flush()
