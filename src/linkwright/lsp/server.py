"""The language server: open texts, checks in the background, and the requests of an editor."""

from __future__ import annotations

import asyncio
import gc
import logging
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache, partial
from pathlib import Path
from typing import NamedTuple, TypeVar
from urllib.parse import unquote, urlsplit
from urllib.request import url2pathname

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer
from pygls.workspace import TextDocument

from linkwright._version import __version__
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.definitions import NameDefinition
from linkwright.language.format import Document, Format
from linkwright.language.formats import format_of
from linkwright.language.includes import real
from linkwright.language.values import ValuedText, values_in
from linkwright.language.workspace import MAX_CHARACTERS, Workspace
from linkwright.lint.targets import XML_FILES
from linkwright.lsp.findings import as_diagnostics
from linkwright.lsp.folders import show_progress
from linkwright.lsp.large_files import findings_apart
from linkwright.lsp.positions import UTF_16, TextPositions
from linkwright.lsp.protocol import LeanProtocol
from linkwright.lsp.robot_views import RobotViews
from linkwright.xacro.cache import BoundedCache
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.reader import read_bytes

T = TypeVar("T")

_log = logging.getLogger(__name__)
_MAX_TEXTS = 200
"""The number of files on the disk whose lines are stored, for the positions of findings."""
_CACHE_DIVISOR = 8
_CHECKS_PER_COLLECTION = 50
_IDLE_SECONDS = 1.0
"""The time without a change after which the server collects garbage."""


class FormattedText(NamedTuple):
    """A text in a format with its own editor functions."""

    format: Format
    document: Document
    positions: TextPositions


class LinkwrightServer(LanguageServer):
    """The language server for one editor.

    Attributes:
        project: the workspace, or None before the editor has opened its folders.
        robot_views: the pages that show robots.
    """

    def __init__(self) -> None:
        super().__init__("linkwright", __version__, protocol_cls=LeanProtocol)
        self.project: Workspace | None = None
        self._uris: dict[Path, str] = {}
        self._files: dict[Path, tuple[int, TextPositions]] = {}
        self._values: dict[Path, tuple[dict[Path, str], list[ValuedText]]] = {}
        self._changed: dict[Path, None] = {}
        self._has_changes = asyncio.Event()
        self._is_indexed = asyncio.Event()
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="check")
        self._preparing: dict[Format, asyncio.Future[object]] = {}
        self._background: dict[Path, list[Future[object]]] = {}
        self._large: dict[Path, asyncio.Task[None]] = {}
        self._work: asyncio.Task[None] | None = None
        self._progress: asyncio.Task[None] | None = None
        self.robot_views = RobotViews()

    # --- files ------------------------------------------------------------------------------------------------

    def begin(self, folders: Iterable[Path]) -> None:
        """Open the folders of the editor, and start to check changed files."""
        BoundedCache.divisor = _CACHE_DIVISOR
        self._cancel_checks()
        self._is_indexed.clear()
        self._values.clear()
        previous = self.project
        self.project = Workspace(folders)
        if previous is not None:
            self._publish(previous.without_findings(), {})
            for uri in self.workspace.text_documents:
                self.file_changed(uri)
        self._work = asyncio.get_running_loop().create_task(self._check_changes(self.project))

    def end(self) -> None:
        """Stop checking."""
        self._cancel_checks()
        self._thread.shutdown(wait=False, cancel_futures=True)
        self.robot_views.close()

    def file_opened(self, uri: str) -> None:
        """Store the editor's URI of a file, and schedule a check of the file."""
        path = path_of(uri)
        if path is not None:
            self._uris[real(path)] = uri
            self.file_changed(uri)
            known = format_of(path)
            if known is not None:
                self._prepared(known)
            if len(self.workspace.text_documents[uri].source) > MAX_CHARACTERS:
                notice = phrase(
                    "'{file}' is too large for completions and hovers: only its findings are shown", file=path.name
                )
                self.window_show_message(types.ShowMessageParams(types.MessageType.Info, localized(notice)))

    def file_changed(self, uri: str) -> None:
        """Schedule a check of a file and of the descriptions that include it."""
        path = path_of(uri)
        if path is not None:
            self._changed[real(path)] = None
            self._has_changes.set()
            self.robot_views.text_changed(real(path), self.workspace.text_documents.get(uri))

    def file_saved(self, uri: str) -> None:
        """Update the workspace after a file on the disk has changed."""
        path = path_of(uri)
        if path is not None and self.project is not None:
            self.project.file_saved(real(path))
            self._values.clear()
            self.file_changed(uri)

    def text(self, document: types.TextDocumentIdentifier) -> tuple[Path, TextPositions | None]:
        """Return the path and the text of a document, with None unless it is readable XML of usual size."""
        path = path_of(document.uri)
        if path is None or not path.name.endswith((*XML_FILES, ".xml")):
            return Path(), None
        return path, self._usual_positions(path)

    def readable(self, document: types.TextDocumentIdentifier) -> tuple[Path, TextPositions | None]:
        """Return the path and the text of a document, with None if it is large or its format is not supported."""
        path = path_of(document.uri)
        if path is None or (format_of(path) is None and not path.name.endswith((*XML_FILES, ".xml"))):
            return Path(), None
        return path, self._usual_positions(path)

    async def when_prepared(self, path: Path) -> None:
        """Wait for the index, and for the imports that the format of a file needs."""
        await self.when_indexed()
        known = format_of(path)
        if known is not None:
            await self._prepared(known)

    def _prepared(self, known: Format) -> asyncio.Future[object]:
        """Return a future of the preparation of a format, which runs once in its own thread."""
        work = self._preparing.get(known)
        if work is None:
            work = self._preparing[known] = asyncio.ensure_future(asyncio.to_thread(known.prepare))
        return asyncio.shield(work)

    async def formatted(self, document: types.TextDocumentIdentifier) -> FormattedText | None:
        """Return a document like `document`, but wait for the index if its format needs it."""
        found = self.document(document)
        if found is not None and found.format.needs_index:
            await self.when_indexed()
            found = self.document(document)
        return found

    def document(self, document: types.TextDocumentIdentifier) -> FormattedText | None:
        """Return a document with its format, or None if it has no format, or is large or unreadable."""
        path = path_of(document.uri)
        format_ = None if path is None else format_of(path)
        if path is None or format_ is None or self.project is None:
            return None
        positions = self._usual_positions(path)
        if positions is None:
            return None
        return FormattedText(format_, Document(self.project, self.texts(), real(path), positions.text), positions)

    async def names(self, path: Path) -> list[NameDefinition]:
        """Wait for the index, and return the names that a file's descriptions define."""
        if self.project is None:
            return []
        await self.when_indexed()
        return self.project.names(real(path), self.texts())

    async def values(self, path: Path) -> list[ValuedText]:
        """Wait for the index, and return the values of the expressions in a file."""
        project, file, texts = self.project, real(path), self.texts()
        if project is None:
            return []
        await self.when_indexed()
        known = self._values.get(file)
        if known is None or known[0] != texts:
            known = texts, await self.in_thread(partial(values_in, project, texts, file))
            self._values = {file: known}
        return known[1]

    def check_unchanged(self, path: Path, positions: TextPositions) -> None:
        """Check that a text has not changed during a request.

        Raises:
            JsonRpcException: ContentModified, the text has changed, so its offsets are invalid.
        """
        current = self.positions(path)
        if current is None or current.text != positions.text:
            message = localized(phrase("a text has changed meanwhile"))
            raise JsonRpcException(message, code=int(types.LSPErrorCodes.ContentModified))

    @property
    def client_commands(self) -> frozenset[str]:
        """The client's commands for code lenses, from its capability ``experimental.commands``."""
        experimental = self.client_capabilities.experimental
        commands = experimental.get("commands") if isinstance(experimental, dict) else None
        return frozenset(map(str, commands)) if isinstance(commands, list) else frozenset()

    @property
    def opens_pages(self) -> bool:
        """Whether the client can open the page of a finding's code as a virtual document."""
        document = self.client_capabilities.text_document
        published = None if document is None else document.publish_diagnostics
        return self.opens_virtual_documents and published is not None and bool(published.code_description_support)

    @property
    def opens_virtual_documents(self) -> bool:
        """Whether the client requests the content of virtual documents, and shows no empty file."""
        workspace = self.client_capabilities.workspace
        return workspace is not None and workspace.text_document_content is not None

    async def when_indexed(self) -> None:
        """Wait until the folders have been searched."""
        await self._is_indexed.wait()

    def positions(self, path: Path) -> TextPositions | None:
        """Return the positions of a file's text, open or saved, or None if it is unreadable."""
        file = real(path)
        encoding = self.workspace.position_encoding or UTF_16
        uri = self._uris.get(file)
        if uri is not None and uri in self.workspace.text_documents:
            return TextPositions(self.workspace.text_documents[uri].source, encoding)
        try:
            changed_ns = file.stat().st_mtime_ns
            known = self._files.get(file)
            if known is None or known[0] != changed_ns:
                known = changed_ns, TextPositions(decode(read_bytes(file), str(file)), encoding)
                self._files[file] = known
                if len(self._files) > _MAX_TEXTS:
                    del self._files[next(iter(self._files))]
        except (OSError, LinkwrightError):
            return None
        return known[1]

    def _usual_positions(self, path: Path) -> TextPositions | None:
        """Return the positions of a file's text, or None if it is large or unreadable."""
        positions = self.positions(path)
        return None if positions is None or len(positions.text) > MAX_CHARACTERS else positions

    def uri_of(self, path: Path) -> str:
        """Return the URI of a file, in the editor's spelling if the file is open."""
        file = real(path)
        return self._uris.get(file) or file.as_uri()

    def texts(self) -> dict[Path, str]:
        """Return the texts of the open files."""
        return {path: document.source for path, document in self.documents().items()}

    def documents(self) -> dict[Path, TextDocument]:
        """Return the open documents."""
        found = {path: self.workspace.text_documents.get(uri) for path, uri in self._uris.items()}
        return {path: document for path, document in found.items() if document is not None}

    # --- checks -----------------------------------------------------------------------------------------------

    async def _check_changes(self, project: Workspace) -> None:
        """Check files as they change, the newest first, and each waiting subject once."""
        search = asyncio.ensure_future(self._attempt(project.index.refresh, Path()))
        title = phrase("Linkwright: searching the folders for robot descriptions")
        self._progress = asyncio.ensure_future(show_progress(self, title, search))
        await search
        self._is_indexed.set()
        pending: dict[Path, set[Path]] = {}
        check_count = 0
        while True:
            # An expansion leaves its garbage in the oldest generation (see `seldom_collected`).
            if check_count >= _CHECKS_PER_COLLECTION or (check_count and not pending and await self._is_idle()):
                await self.in_thread(gc.collect)
                check_count = 0
            if not pending:
                await self._has_changes.wait()
            self._has_changes.clear()
            changed, self._changed = self._changed, {}
            texts = self.texts()
            for file in changed:
                subjects = await self._attempt(partial(project.subjects, file, texts), file) or []
                pending = {subject: pending.get(subject, set()) for subject in (*subjects, *pending)}
                for subject in subjects or [file]:
                    pending.setdefault(subject, set()).add(file)
            if pending:
                subject = next(iter(pending))
                await self._check(project, subject, texts, pending.pop(subject))
                check_count += 1

    async def _is_idle(self) -> bool:
        """Wait for a change, and return whether none has come for some time."""
        try:
            await asyncio.wait_for(self._has_changes.wait(), _IDLE_SECONDS)
        except asyncio.TimeoutError:
            return True
        return False

    async def _check(self, project: Workspace, subject: Path, texts: dict[Path, str], changed: set[Path]) -> None:
        """Check one subject, and publish its findings; those of large files when another process has found them."""
        if any(project.is_large(file, texts) for file in (subject, *changed)):
            previous = self._large.get(subject)
            if previous is not None:
                previous.cancel()
            check = self._check_apart(project, subject, texts, changed)
            self._large[subject] = asyncio.get_running_loop().create_task(check)
            return
        self._publish(await self._attempt(partial(project.check, subject, texts, changed), subject) or {}, texts)

    async def _check_apart(self, project: Workspace, subject: Path, texts: dict[Path, str], changed: set[Path]) -> None:
        """Check one subject in a process of its own, and publish its findings."""
        findings = await findings_apart(project.folders, subject, texts)
        if self._large.get(subject) is asyncio.current_task():
            del self._large[subject]
        if findings is None:
            _log.error("The check of '%s' failed", subject)
            return
        found = await self._attempt(partial(project.record, subject, findings, texts, changed), subject)
        self._publish(found or {}, texts)

    def _cancel_checks(self) -> None:
        """Cancel the checks that run and those that wait."""
        for check in (*self._large.values(), *((self._work,) if self._work is not None else ())):
            check.cancel()
        self._large.clear()

    def _publish(self, found: Mapping[Path, Sequence[Diagnostic]], texts: Mapping[Path, str]) -> None:
        """Publish the findings about files, except open files that have changed since the check."""
        positions = cache(self.positions)
        for file, findings in found.items():
            uri = self.uri_of(file)
            document = self.workspace.text_documents.get(uri)
            if document is not None and texts.get(file) != document.source:
                continue  # the text has changed since then, and is checked again
            self.text_document_publish_diagnostics(
                types.PublishDiagnosticsParams(
                    uri,
                    as_diagnostics(findings, positions, self.uri_of, links_pages=self.opens_pages),
                    None if document is None else document.version,
                )
            )

    async def _attempt(self, work: Callable[[], T], about: Path) -> T | None:
        """Return the result of work in the thread, or log an unexpected error and return None."""
        try:
            return await self.in_thread(work)
        except Exception:  # noqa: BLE001 - the editor continues to work, and the log has the reason
            _log.exception("The check of '%s' failed", about)
            return None

    def in_background(self, work: Iterable[Callable[[], object]], about: Path) -> None:
        """Submit work to the check thread, and replace waiting work about the same file."""
        for waiting in self._background.pop(about, ()):
            waiting.cancel()
        self._background[about] = [self._thread.submit(each) for each in work]

    async def in_thread(self, work: Callable[[], T]) -> T:
        """Return the result of work in the check thread, the only one that reads the workspace."""
        return await asyncio.get_running_loop().run_in_executor(self._thread, work)


def path_of(uri: str) -> Path | None:
    """Return the path of a file's URI, or None for other URIs."""
    parts = urlsplit(uri)
    return Path(url2pathname(unquote(parts.path))) if parts.scheme == "file" else None
