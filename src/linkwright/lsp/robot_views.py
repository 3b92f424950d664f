"""The pages that show robots beside the text.

There is a process of ``linkwright view`` for each description.
"""

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

from linkwright.lint.targets import DESCRIPTION_SUFFIXES

_ADDRESS = re.compile(rb"https?://\S+")
_LOADED_FILE_SUFFIXES = (".yaml", ".yml")
"""The suffixes of files that descriptions load."""


class TextEditor(Protocol):
    """The editor that receives selected elements and edits from a page."""

    def show_location(self, file: Path, line: int, column: int) -> None:
        """Show the source of the element that the user has selected in a page.

        Args:
            file: the file that contains the element.
            line: the line, from 1.
            column: the column, from 1.
        """

    def replace_text(self, file: Path, version: int, text: str) -> None:
        """Replace the text of a file after the user has edited the robot in a page.

        Args:
            file: the file to change.
            version: the version of the document that was edited, or 0 if the file was not open.
            text: the new text.
        """


class RobotView:
    """The page of a description, which follows the texts and the cursor of the editor.

    Args:
        editor: the editor that receives the reports of the page.
    """

    def __init__(self, editor: TextEditor) -> None:
        self._editor = editor
        self._process: asyncio.subprocess.Process | None = None
        self._reader_task: asyncio.Task[None] | None = None
        self._address: asyncio.Future[str | None] = asyncio.get_running_loop().create_future()

    async def start(self, file: Path) -> str | None:
        """Start the process, and return the address of its page, or None if the process ends first.

        Raises:
            OSError: the process cannot be started.
        """
        self._process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "linkwright", "view", str(file), "--no-open", "--editor"),
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.DEVNULL,
            env={**os.environ, "PYTHONSAFEPATH": "1"},  # A file queue.py in the workspace must not be imported.
        )
        self._reader_task = asyncio.get_running_loop().create_task(self._read(self._process))
        return await self.address()

    async def address(self) -> str | None:
        """Wait until the page is served, and return its address, or None if the process ends first."""
        return await asyncio.shield(self._address)

    @property
    def is_running(self) -> bool:
        """Whether the process runs."""
        return self._process is not None and self._process.returncode is None

    def send(self, message: Mapping[str, Any]) -> None:
        """Send a message to the process, in the format of `linkwright.hosting.text_editor`."""
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
        with suppress(ValueError):  # The line is longer than any valid message.
            async for line in process.stdout:
                if line.startswith(b"{"):
                    self._receive(line)
                elif not self._address.done() and (address := _ADDRESS.search(line)):
                    self._address.set_result(address[0].decode())
        if not self._address.done():
            self._address.set_result(None)

    def _receive(self, line: bytes) -> None:
        with suppress(ValueError, KeyError, TypeError):
            message = json.loads(line)
            if (location := message.get("open")) is not None:
                self._editor.show_location(Path(location["file"]), int(location["line"]), int(location["column"]))
            if (edit := message.get("edit")) is not None:
                self._editor.replace_text(Path(edit["file"]), int(edit["number"]), str(edit["text"]))


class RobotViews:
    """The pages of an editor, one for each description.

    Attributes:
        editor: the editor to which the pages report.
    """

    editor: TextEditor

    def __init__(self) -> None:
        self._views: dict[Path, RobotView] = {}

    async def address(self, file: Path, documents: Mapping[Path, TextDocument]) -> str | None:
        """Start the page of a description unless it runs, and return its address.

        Returns None if the process of the page has ended.

        Args:
            file: the description.
            documents: the open documents.

        Raises:
            OSError: the process cannot be started.
        """
        view_of_file = self._views.get(file)
        if view_of_file is not None and view_of_file.is_running:
            return await view_of_file.address()
        view = self._views[file] = RobotView(self.editor)
        address = await view.start(file)
        view.send(_texts(documents))
        return address

    def text_changed(self, file: Path, document: TextDocument | None) -> None:
        """Send the new text of a file to all pages. They read a closed file from the disk."""
        message = _texts({file: document})
        for view in self._views.values() if message["texts"] else ():
            view.send(message)

    def cursor_moved(self, file: Path, line: int) -> None:
        """Select the element at a line of a file in all pages. Lines count from 1."""
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
            if file.name.endswith((*DESCRIPTION_SUFFIXES, *_LOADED_FILE_SUFFIXES))
        }
    }
