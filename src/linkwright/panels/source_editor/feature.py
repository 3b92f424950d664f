"""The editor of source files: sends, writes and watches files, and runs language servers."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from dataclasses import dataclass, field
from importlib.util import find_spec
from itertools import count
from pathlib import Path
from typing import Any

from linkwright.descriptions.editing import EditRefusedError, Workspace
from linkwright.descriptions.editing.refusals import changed_file
from linkwright.descriptions.unsaved import UnsavedText, with_lf_line_ends
from linkwright.diagnostics import Diagnostic, Phrase, phrase
from linkwright.diagnostics.extras import EXTRAS, install_hint
from linkwright.page.audience import Page
from linkwright.page.protocol import source_editor as messages
from linkwright.page.protocol.message import PageMessage
from linkwright.panels.description import DescriptionFeature, make_item
from linkwright.panels.editing.feature import EditingFeature, make_other_machine_finding
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.panels.source_editor.files import FileContent, SourceFiles, with_line_ends
from linkwright.panels.source_editor.language_process import LanguageProcess

_CHECK_PERIOD_S = 0.4
"""Seconds between two checks of the files on the disk."""


@dataclass(slots=True)
class _OpenFile:
    """A file that a page edits: its content on the disk, and its version number for the page."""

    version: int
    content: FileContent
    stamp: tuple[int, ...]


@dataclass(slots=True)
class _Editor:
    """The editor of one page."""

    files: SourceFiles
    process: LanguageProcess
    open_files: dict[str, _OpenFile] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class _PageTexts:
    """The unsaved texts of a page."""

    page: Page

    def edit(self, path: str, revision: int, text: str) -> None:
        self.page.send(messages.UnsavedTextEdited(path, revision, with_lf_line_ends(text)))


class SourceEditorFeature(PageFeature):
    """The feature that provides source editors with a language server and workspace files.

    Requests about files are handled one after the other. Written files are steps of the history of `EditingFeature`, so
    they are undone in the same order as the edits of the robot.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._editors: dict[Page, _Editor] = {}
        self._workspace: Path | None = None
        self._unsaved = viewer.context.library.unsaved
        self._shown: set[asyncio.Task[None]] = set()
        self._waiting: asyncio.Queue[tuple[Page, PageMessage]] = asyncio.Queue()
        self._tasks: list[asyncio.Task[None]] = []

    def edit_workspace(self, folder: Path) -> None:
        """Let pages on this machine edit all files of a workspace, even if no description is shown."""
        self._workspace = folder

    def receive(self, page: Page, message: Any) -> None:
        """Forward a message to the language server, or queue a request for files."""
        if isinstance(message, messages.LanguageServerInput):
            if (editor := self._editors.get(page)) is not None:
                editor.process.send(message.content)
            return
        self._waiting.put_nowait((page, message))
        if not self._tasks:
            loop = asyncio.get_running_loop()
            self._tasks = [loop.create_task(self._work()), loop.create_task(self._watch())]

    def remove_page(self, page: Page) -> None:
        """End the language server of a page."""
        editor = self._editors.pop(page, None)
        if editor is not None:
            editor.process.close()
            self._start(self._unsaved.remove_all(_PageTexts(page)))

    def close(self) -> None:
        """End all language servers, and stop handling requests."""
        for page in list(self._editors):
            self.remove_page(page)
        for task in (*self._tasks, *self._shown):
            task.cancel()

    def _start(self, work: Coroutine[Any, Any, None]) -> None:
        """Run work in a separate task, so that other requests do not wait for an expansion."""
        task = asyncio.get_running_loop().create_task(work)
        self._shown.add(task)
        task.add_done_callback(self._shown.discard)

    async def _work(self) -> None:
        while True:
            page, message = await self._waiting.get()
            if page not in self.context.pages:
                continue
            try:
                await self._handle_request(page, message)
            except Exception as error:  # noqa: BLE001  # editing must continue after an error of this program
                self.context.node.get_logger().error(f"A source file request failed: {type(error).__name__}: {error}")

    async def _handle_request(self, page: Page, message: Any) -> None:
        if isinstance(message, messages.OpenEditor):
            page.send(self._open(page, message.file))
            return
        editor = self._editors.get(page)
        if editor is None:
            return
        if isinstance(message, messages.RequestSourceFile):
            editor.files.known = self._find_description_files(page)
            await self._send_file(page, editor, message.path)
        elif isinstance(message, messages.CloseSourceFile):
            editor.open_files.pop(message.path, None)
        elif isinstance(message, messages.ShowUnsavedText):
            if (open_file := editor.open_files.get(message.path)) is not None:
                self._start(self._show_unsaved(page, message, open_file.content.text or ""))
        elif isinstance(message, messages.RequestSourceFolder):
            folders, files = await asyncio.to_thread(editor.files.list_names, Path(message.path))
            page.send(messages.SourceFolder(message.path, folders, files))
        else:
            refusal: Diagnostic | None = None
            try:
                await self._change(page, editor, message)
            except EditRefusedError as error:
                refusal = error.diagnostic
            open_file = editor.open_files.get(message.path)
            version = 0 if open_file is None else open_file.version
            item = None if refusal is None else make_item(refusal)
            page.send(messages.SourceFileWritten(message.number, message.path, version, item))
            if open_file is not None and _differs(message, open_file, refusal):
                await self._send_file(page, editor, message.path)

    def _open(self, page: Page, file: str) -> messages.EditorOpened:
        """Start a page's language server if necessary, and return the response to the page.

        If no file can be edited, the language server is ended, and the response gives the reason.
        """
        description_files = self._find_description_files(page)
        reason = _find_refusal_reason(page, file, description_files, self._workspace)
        if reason is not None:
            self.remove_page(page)
            return messages.EditorOpened("", "", reason)
        files = SourceFiles(Workspace(Path(file), self._workspace), description_files)
        editor = self._editors.get(page)
        if editor is None:
            self._editors[page] = _Editor(files, self._start_process(page))
        else:
            editor.files = files
        return messages.EditorOpened(str(files.folder), files.folder.as_uri(), "")

    def _find_description_files(self, page: Page) -> frozenset[str]:
        return frozenset(self.viewer.add_feature(DescriptionFeature).files(page))

    def _start_process(self, page: Page) -> LanguageProcess:
        numbers = count(1)

        def on_end() -> None:
            self.remove_page(page)
            page.send(messages.LanguageServerEnded())

        return LanguageProcess(
            page.language, lambda content: page.send(messages.LanguageServerOutput(next(numbers), content)), on_end
        )

    async def _send_file(self, page: Page, editor: _Editor, path: str) -> None:
        """Send a page a file, and store its content."""
        stamp, content = await asyncio.to_thread(_read, editor.files, path)
        open_file = editor.open_files.get(path)
        if open_file is None:
            open_file = editor.open_files[path] = _OpenFile(1, content, stamp)
        open_file.stamp = stamp
        if content != open_file.content:
            open_file.version += 1
            open_file.content = content
        uri = Path(path).as_uri() if Path(path).is_absolute() else ""
        page.send(
            messages.SourceFile(
                path, uri, open_file.version, content.page_text, content.refusal_reason, is_new=content.is_new
            )
        )

    async def _show_unsaved(self, page: Page, message: messages.ShowUnsavedText, on_disk: str) -> None:
        """Show descriptions with an unsaved text, and send the page the outcome."""
        if message.text is None:
            outcome = await self._unsaved.remove(_PageTexts(page), message.path)
        else:
            text = with_line_ends(message.text, on_disk)
            outcome = await self._unsaved.store(UnsavedText(_PageTexts(page), message.path, message.number, text))
        page.send(messages.UnsavedTextShown(message.number, message.path, outcome))

    async def _change(
        self, page: Page, editor: _Editor, message: messages.WriteSourceFile | messages.CreateSourceFile
    ) -> None:
        """Write or create a file.

        Raises:
            EditRefusedError: the file was not written.
        """
        path = Path(message.path)
        if isinstance(message, messages.CreateSourceFile):
            await asyncio.to_thread(editor.files.create, path)
            return
        open_file = editor.open_files.get(message.path)
        if open_file is None or open_file.version != message.version:
            raise EditRefusedError(changed_file(message.path))
        if open_file.content.is_new:
            await asyncio.to_thread(editor.files.create, path, message.text)
        elif open_file.content.text is None:
            raise EditRefusedError(changed_file(message.path))
        else:
            plan = editor.files.plan(path, open_file.content.text, message.text)
            await self.viewer.add_feature(EditingFeature).write(plan)
        open_file.version += 1
        open_file.stamp, open_file.content = await asyncio.to_thread(_read, editor.files, message.path)

    async def _watch(self) -> None:
        """Send pages the files that other programs have changed."""
        while True:
            await asyncio.sleep(_CHECK_PERIOD_S)
            for page, editor in list(self._editors.items()):
                stamps = {path: known.stamp for path, known in editor.open_files.items()}
                changed = await asyncio.to_thread(_find_changed_paths, stamps)
                for path in changed:
                    self._waiting.put_nowait((page, messages.RequestSourceFile(path)))


def _differs(message: PageMessage, open_file: _OpenFile, refusal: Diagnostic | None) -> bool:
    """Return whether a file differs from the text of a page after a request.

    The request may have been refused, or the encoding of the file may lack some characters.
    """
    is_written = isinstance(message, messages.WriteSourceFile) and open_file.content.page_text == message.text
    return refusal is not None or not is_written


def _read(files: SourceFiles, path: str) -> tuple[tuple[int, ...], FileContent]:
    """Return a stamp of a file, computed before its content is read, and the content."""
    return _compute_stamp(path), files.read(Path(path))


def _compute_stamp(path: str) -> tuple[int, ...]:
    """Return numbers that change with the content of a file.

    The tuple is empty if there is no file.
    """
    try:
        status = Path(path).stat()
    except (OSError, ValueError):
        return ()
    return status.st_ino, status.st_size, status.st_mtime_ns, status.st_mode


def _find_changed_paths(stamps: dict[str, tuple[int, ...]]) -> list[str]:
    """Return the paths of the files whose stamps have changed."""
    return [path for path, stamp in stamps.items() if _compute_stamp(path) != stamp]


def _find_refusal_reason(
    page: Page, file: str, description_files: frozenset[str], workspace: Path | None
) -> Phrase | None:
    """Return the reason why a page may not edit the workspace of a file, or None."""
    if not page.is_local:
        return make_other_machine_finding().message
    if find_spec(EXTRAS["lsp"]) is None:
        return phrase("the editor needs the language server: {hint}", hint=install_hint("lsp"))
    if workspace is None and (file not in description_files or file.startswith("<")):
        return phrase(
            "this description was received as text, so its file is unknown: open it with `linkwright view FILE`"
        )
    return None
