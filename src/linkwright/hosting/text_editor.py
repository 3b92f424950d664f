"""The connection of a view with a text editor, over standard input and output.

Each line of input is a JSON object with one of these members: ``texts``, the unsaved texts by absolute path, which
replace the earlier ones, and ``cursor``, an object with ``file`` and ``line`` (from 1). Each selection of an element in
a page is a line of output: ``{"open": {"file": ..., "line": ..., "column": ...}}``. The view ends with its input.
"""

from __future__ import annotations

import asyncio
import json
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.page.protocol.description import SourceRange
from linkwright.panels.text_editor import TextEditorFeature

if TYPE_CHECKING:
    from linkwright.hosting.reload import LiveReload
    from linkwright.viewer import Viewer


class TextEditorConnection:
    """Reads the messages of an editor in a thread, and handles them on the event loop.

    Args:
        viewer: the viewer whose pages are connected.
        reload: reads descriptions again whose texts change.
        ended: called when the editor has closed the input.
    """

    def __init__(self, viewer: Viewer, reload: LiveReload, ended: Callable[[], object]) -> None:
        self._reload = reload
        self._ended = ended
        self._loop = asyncio.get_running_loop()
        self._feature = viewer.add_feature(TextEditorFeature)
        self._feature.selected = self._open
        threading.Thread(target=self._read, name="linkwright-text-editor", daemon=True).start()

    def _read(self) -> None:
        with suppress(RuntimeError, ValueError):  # the event loop is closed, or the input is
            for line in sys.stdin:
                self._loop.call_soon_threadsafe(self._receive, line)
            self._loop.call_soon_threadsafe(self._ended)

    def _receive(self, line: str) -> None:
        try:
            message = json.loads(line)
        except ValueError:
            return
        if not isinstance(message, dict):
            return
        texts, cursor = message.get("texts"), message.get("cursor")
        if isinstance(texts, dict):
            self._reload.set_texts({str(path): str(text) for path, text in texts.items()})
        if isinstance(cursor, dict) and isinstance(cursor.get("line"), int):
            self._feature.show(Path(str(cursor.get("file"))), cursor["line"])

    def _open(self, place: SourceRange) -> None:
        message = {"open": {"file": place.file, "line": place.line, "column": place.column}}
        sys.stdout.write(json.dumps(message) + "\n")
        sys.stdout.flush()
