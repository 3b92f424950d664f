"""The pages that show robots beside the text: a process of ``linkwright view`` for each description."""

from __future__ import annotations

import asyncio
import json
import os
import re
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Protocol

from pygls.workspace import TextDocument

from linkwright.lint.targets import DESCRIPTIONS

_ADDRESS = re.compile(rb"https?://\S+")
_VALUE_FILES = (".yaml", ".yml")
"""Endings of files that descriptions load."""


class TextEditor(Protocol):
    """The editor to which a page reports selected elements and edits."""

    def go_to(self, file: Path, line: int, column: int) -> None:
        """Show an element that the user has selected in a page; the line and the column count from 1."""

    def replace_text(self, file: Path, number: int, text: str) -> None:
        """Replace the text of a file in which the user has edited the robot in a page.

        Args:
            file: the file.
            number: the version of the document that was edited, or 0 if the file was not open.
            text: the new text.
        """


class RobotView:
    """The page of a description, which follows the texts and the cursor of the editor.

    Args:
        editor: the editor.
    """

    def __init__(self, editor: TextEditor) -> None:
        self._editor = editor
        self._process: asyncio.subprocess.Process | None = None
        self._reading: asyncio.Task[None] | None = None
        self._address: asyncio.Future[str | None] = asyncio.get_running_loop().create_future()

    async def start(self, file: Path) -> str | None:
        """Start the process, and return the address of the page; None if the process has ended.

        Raises:
            OSError: the process cannot be started.
        """
        self._process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "linkwright", "view", str(file), "--no-open", "--editor"),
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.DEVNULL,
            env={**os.environ, "PYTHONSAFEPATH": "1"},  # a file queue.py of the workspace is not to be imported
        )
        self._reading = asyncio.get_running_loop().create_task(self._read(self._process))
        return await self.address()

    async def address(self) -> str | None:
        """Return the address of the page, once it is served; None if the process has ended."""
        return await asyncio.shield(self._address)

    @property
    def is_running(self) -> bool:
        """Whether the process runs."""
        return self._process is not None and self._process.returncode is None

    def send(self, message: Mapping[str, Any]) -> None:
        """Send a message, see `linkwright.hosting.text_editor`."""
        if self._process is not None and self._process.stdin is not None and self.is_running:
            with suppress(OSError, RuntimeError):
                self._process.stdin.write(json.dumps(message).encode() + b"\n")

    def close(self) -> None:
        """End the process."""
        if self._process is not None and self.is_running:
            with suppress(ProcessLookupError):
                self._process.terminate()

    async def _read(self, process: asyncio.subprocess.Process) -> None:
        assert process.stdout is not None, "it is a pipe"
        with suppress(ValueError):  # a line that is longer than any of ours
            async for line in process.stdout:
                if line.startswith(b"{"):
                    self._receive(line)
                elif not self._address.done() and (found := _ADDRESS.search(line)):
                    self._address.set_result(found[0].decode())
        if not self._address.done():
            self._address.set_result(None)

    def _receive(self, line: bytes) -> None:
        with suppress(ValueError, KeyError, TypeError):
            message = json.loads(line)
            if (place := message.get("open")) is not None:
                self._editor.go_to(Path(place["file"]), int(place["line"]), int(place["column"]))
            if (edit := message.get("edit")) is not None:
                self._editor.replace_text(Path(edit["file"]), int(edit["number"]), str(edit["text"]))


class RobotViews:
    """The running pages, by description.

    Attributes:
        editor: the editor.
    """

    editor: TextEditor

    def __init__(self) -> None:
        self._views: dict[Path, RobotView] = {}

    async def address(self, file: Path, documents: Mapping[Path, TextDocument]) -> str | None:
        """Return the address of the page of a description; None if the page cannot be shown.

        Args:
            file: the description. Its page is started unless it runs.
            documents: the open documents.

        Raises:
            OSError: the process cannot be started.
        """
        known = self._views.get(file)
        if known is not None and known.is_running:
            return await known.address()
        view = self._views[file] = RobotView(self.editor)
        address = await view.start(file)
        view.send(_texts(documents))
        return address

    def text_changed(self, file: Path, document: TextDocument | None) -> None:
        """Show the text of a file, or the file on the disk if it is not open."""
        message = _texts({file: document})
        for view in self._views.values() if message["texts"] else ():
            view.send(message)

    def cursor_moved(self, file: Path, line: int) -> None:
        """Select the element at a line, from 1."""
        for view in self._views.values():
            view.send({"cursor": {"file": str(file), "line": line}})

    def close(self) -> None:
        """End all pages."""
        for view in self._views.values():
            view.close()


def _texts(documents: Mapping[Path, TextDocument | None]) -> dict[str, Any]:
    return {
        "texts": {
            str(file): None if document is None else {"number": document.version or 0, "text": document.source}
            for file, document in documents.items()
            if file.name.endswith((*DESCRIPTIONS, *_VALUE_FILES))
        }
    }
