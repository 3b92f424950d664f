"""The language server: open documents, background checks, and the requests of an editor."""

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
from linkwright.language.includes import real_path
from linkwright.language.values import EvaluatedText, evaluate_file
from linkwright.language.workspace import MAX_CHARACTERS, Workspace
from linkwright.lint.targets import XML_SUFFIXES
from linkwright.lsp.client_features import show_progress
from linkwright.lsp.findings import as_diagnostics
from linkwright.lsp.large_files import check_in_process
from linkwright.lsp.positions import UTF_16, TextPositions
from linkwright.lsp.protocol import LeanProtocol
from linkwright.lsp.robot_views import RobotViews
from linkwright.xacro.cache import BoundedCache
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.reader import read_bytes

T = TypeVar("T")

_log = logging.getLogger(__name__)
_MAX_SAVED_TEXTS = 200
"""The maximum number of saved texts that are stored, for the positions of findings."""
_CACHE_DIVISOR = 8
_CHECKS_PER_COLLECTION = 50
_LARGE_FILE_DELAY_S = 0.3
"""The time without a change of a large file after which a process checks the file."""
_IDLE_S = 1.0
"""The time without a change after which the server collects garbage."""


class FormatContext(NamedTuple):
    """A document whose format has its own language features."""

    format: Format
    document: Document
    positions: TextPositions


class LinkwrightServer(LanguageServer):
    """The language server for one editor.

    Attributes:
        project: the checked folders, or None before the editor has opened its folders.
        robot_views: the pages that show robots.
    """

    def __init__(self) -> None:
        super().__init__("linkwright", __version__, protocol_cls=LeanProtocol)
        self.project: Workspace | None = None
        self._uris: dict[Path, str] = {}
        self._saved_texts: dict[Path, tuple[int, TextPositions]] = {}
        self._values: dict[Path, tuple[dict[Path, str], list[EvaluatedText]]] = {}
        self._changed: dict[Path, None] = {}
        self._has_changes = asyncio.Event()
        self._is_indexed = asyncio.Event()
        self._check_thread = ThreadPoolExecutor(1, thread_name_prefix="check")
        self._preparations: dict[Format, asyncio.Future[object]] = {}
        self._submitted_work: dict[Path, list[Future[object]]] = {}
        self._large_checks: dict[Path, asyncio.Task[None]] = {}
        self._check_loop: asyncio.Task[None] | None = None
        self._progress_task: asyncio.Task[None] | None = None
        self.robot_views = RobotViews()

    # --- files ------------------------------------------------------------------------------------------------

    def open_folders(self, folders: Iterable[Path]) -> None:
        """Open the folders of the editor, and start to check changed files."""
        BoundedCache.divisor = _CACHE_DIVISOR
        self._cancel_checks()
        self._is_indexed.clear()
        self._values.clear()
        previous = self.project
        self.project = Workspace(folders)
        if previous is not None:
            self._publish(previous.cleared_findings(), {})
            for uri in self.workspace.text_documents:
                self.file_changed(uri)
        self._check_loop = asyncio.get_running_loop().create_task(self._check_changes(self.project))

    def stop(self) -> None:
        """Stop the checks, and end the pages of robots."""
        self._cancel_checks()
        self._check_thread.shutdown(wait=False, cancel_futures=True)
        self.robot_views.close()

    def file_opened(self, uri: str) -> None:
        """Store the URI of an opened file, schedule its check, and prepare its format."""
        path = path_from_uri(uri)
        if path is not None:
            self._uris[real_path(path)] = uri
            self.file_changed(uri)
            format_ = format_of(path)
            if format_ is not None:
                self._preparation(format_)
            if len(self.workspace.text_documents[uri].source) > MAX_CHARACTERS:
                notice = phrase(
                    "'{file}' is too large for completions and hovers: only its findings are shown", file=path.name
                )
                self.window_show_message(types.ShowMessageParams(types.MessageType.Info, localized(notice)))

    def file_changed(self, uri: str) -> None:
        """Schedule checks of a file and of the descriptions that include it.

        The robot pages receive the new text.
        """
        path = path_from_uri(uri)
        if path is not None:
            self._changed[real_path(path)] = None
            self._has_changes.set()
            self.robot_views.text_changed(real_path(path), self.workspace.text_documents.get(uri))

    def file_saved(self, uri: str) -> None:
        """Update the workspace after a file on the disk has changed."""
        path = path_from_uri(uri)
        if path is not None and self.project is not None:
            self.project.file_saved(real_path(path))
            self._values.clear()
            self.file_changed(uri)

    def xml_text(self, document: types.TextDocumentIdentifier) -> tuple[Path, TextPositions | None]:
        """Return the path and the text of an XML document, with None if it is large or unreadable.

        For other documents, the path is empty and the text is None.
        """
        path = path_from_uri(document.uri)
        if path is None or not path.name.endswith((*XML_SUFFIXES, ".xml")):
            return Path(), None
        return path, self._positions_unless_large(path)

    def supported_text(self, document: types.TextDocumentIdentifier) -> tuple[Path, TextPositions | None]:
        """Return the path and the text of a document in a supported format.

        The text is None if it is large or unreadable. For other documents, the path is empty and the text is None.
        """
        path = path_from_uri(document.uri)
        if path is None or (format_of(path) is None and not path.name.endswith((*XML_SUFFIXES, ".xml"))):
            return Path(), None
        return path, self._positions_unless_large(path)

    async def when_prepared(self, path: Path) -> None:
        """Wait for the index, and for the imports that the format of a file needs."""
        await self.when_indexed()
        format_ = format_of(path)
        if format_ is not None:
            await self._preparation(format_)

    def _preparation(self, format_: Format) -> asyncio.Future[object]:
        """Return the future of a format's preparation, which is started once in its own thread."""
        preparation = self._preparations.get(format_)
        if preparation is None:
            preparation = self._preparations[format_] = asyncio.ensure_future(asyncio.to_thread(format_.prepare))
        return asyncio.shield(preparation)

    async def indexed_format_context(self, document: types.TextDocumentIdentifier) -> FormatContext | None:
        """Return the result of `format_context`, after indexing if the format needs the index."""
        context = self.format_context(document)
        if context is not None and context.format.needs_index:
            await self.when_indexed()
            context = self.format_context(document)
        return context

    def format_context(self, document: types.TextDocumentIdentifier) -> FormatContext | None:
        """Return a document with its format, or None.

        The result is None if the file has no format of its own, or is too large or unreadable.
        """
        path = path_from_uri(document.uri)
        format_ = None if path is None else format_of(path)
        if path is None or format_ is None or self.project is None:
            return None
        positions = self._positions_unless_large(path)
        if positions is None:
            return None
        return FormatContext(format_, Document(self.project, self.texts(), real_path(path), positions.text), positions)

    async def defined_names(self, path: Path) -> list[NameDefinition]:
        """Wait for the index, and return the names that a file's descriptions define."""
        if self.project is None:
            return []
        await self.when_indexed()
        return self.project.names(real_path(path), self.texts())

    async def expression_values(self, path: Path) -> list[EvaluatedText]:
        """Wait for the index, and return the values of the expressions in a file."""
        workspace, file, texts = self.project, real_path(path), self.texts()
        if workspace is None:
            return []
        await self.when_indexed()
        cached = self._values.get(file)
        if cached is None or cached[0] != texts:
            cached = texts, await self.run_in_check_thread(partial(evaluate_file, workspace, texts, file))
            self._values = {file: cached}
        return cached[1]

    def check_unchanged(self, path: Path, positions: TextPositions) -> None:
        """Check that a text has not changed during a request.

        Raises:
            JsonRpcException: ContentModified, the text has changed, so its offsets are invalid.
        """
        current = self.positions(path)
        if current is None or current.text != positions.text:
            message = localized(phrase("a file has changed in the meantime"))
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
        """Whether the client supports virtual documents (``workspace/textDocumentContent``)."""
        workspace = self.client_capabilities.workspace
        return workspace is not None and workspace.text_document_content is not None

    async def when_indexed(self) -> None:
        """Wait until the folders have been searched for descriptions and packages."""
        await self._is_indexed.wait()

    def positions(self, path: Path) -> TextPositions | None:
        """Return the positions of a file's text, open or saved, or None if it is unreadable."""
        file = real_path(path)
        encoding = self.workspace.position_encoding or UTF_16
        uri = self._uris.get(file)
        if uri is not None and uri in self.workspace.text_documents:
            return TextPositions(self.workspace.text_documents[uri].source, encoding)
        try:
            changed_ns = file.stat().st_mtime_ns
            cached = self._saved_texts.get(file)
            if cached is None or cached[0] != changed_ns:
                cached = changed_ns, TextPositions(decode(read_bytes(file), str(file)), encoding)
                self._saved_texts[file] = cached
                if len(self._saved_texts) > _MAX_SAVED_TEXTS:
                    del self._saved_texts[next(iter(self._saved_texts))]
        except (OSError, LinkwrightError):
            return None
        return cached[1]

    def _positions_unless_large(self, path: Path) -> TextPositions | None:
        """Return the positions of a file's text, or None if it is large or unreadable."""
        positions = self.positions(path)
        return None if positions is None or len(positions.text) > MAX_CHARACTERS else positions

    def uri_of(self, path: Path) -> str:
        """Return the URI of a file, in the editor's spelling if the file is open."""
        file = real_path(path)
        return self._uris.get(file) or file.as_uri()

    def texts(self) -> dict[Path, str]:
        """Return the texts of the open files, by path."""
        return {path: document.source for path, document in self.documents().items()}

    def documents(self) -> dict[Path, TextDocument]:
        """Return the open documents, by path."""
        documents = {path: self.workspace.text_documents.get(uri) for path, uri in self._uris.items()}
        return {path: document for path, document in documents.items() if document is not None}

    # --- checks -----------------------------------------------------------------------------------------------

    async def _check_changes(self, workspace: Workspace) -> None:
        """Search the folders, then check files as they change, the newest first.

        A subject that waits for its check is checked once, however often it changes.
        """
        search = asyncio.ensure_future(self._attempt(workspace.index.refresh, Path()))
        title = phrase("Linkwright: searching the folders for robot descriptions")
        self._progress_task = asyncio.ensure_future(show_progress(self, title, search))
        await search
        self._is_indexed.set()
        pending: dict[Path, set[Path]] = {}
        check_count = 0
        while True:
            # An expansion leaves its garbage in the oldest generation (see `seldom_collected`).
            if check_count >= _CHECKS_PER_COLLECTION or (check_count and not pending and await self._is_idle()):
                await self.run_in_check_thread(gc.collect)
                check_count = 0
            if not pending:
                await self._has_changes.wait()
            self._has_changes.clear()
            changed, self._changed = self._changed, {}
            texts = self.texts()
            for file in changed:
                subjects = await self._attempt(partial(workspace.subjects, file, texts), file) or []
                pending = {subject: pending.get(subject, set()) for subject in (*subjects, *pending)}
                for subject in subjects or [file]:
                    pending.setdefault(subject, set()).add(file)
            if pending:
                subject = next(iter(pending))
                await self._check(workspace, subject, texts, pending.pop(subject))
                check_count += 1

    async def _is_idle(self) -> bool:
        """Return whether no file changes within `_IDLE_S`."""
        try:
            await asyncio.wait_for(self._has_changes.wait(), _IDLE_S)
        except asyncio.TimeoutError:
            return True
        return False

    async def _check(self, workspace: Workspace, subject: Path, texts: dict[Path, str], changed: set[Path]) -> None:
        """Check one subject, and publish its findings.

        A subject with a large file is checked in another process, which does not delay other checks.
        """
        if any(workspace.is_large(file, texts) for file in (subject, *changed)):
            previous = self._large_checks.get(subject)
            if previous is not None:
                previous.cancel()
            check = self._check_in_process(workspace, subject, texts, changed)
            self._large_checks[subject] = asyncio.get_running_loop().create_task(check)
            return
        self._publish(await self._attempt(partial(workspace.check, subject, texts, changed), subject) or {}, texts)

    async def _check_in_process(
        self, workspace: Workspace, subject: Path, texts: dict[Path, str], changed: set[Path]
    ) -> None:
        """Check one subject in a separate process, and publish its findings."""
        await asyncio.sleep(_LARGE_FILE_DELAY_S)
        findings = await check_in_process(workspace.folders, subject, texts)
        if self._large_checks.get(subject) is asyncio.current_task():
            del self._large_checks[subject]
        if findings is None:
            _log.error("The check of '%s' failed", subject)
            return
        findings_by_file = await self._attempt(partial(workspace.record, subject, findings, texts, changed), subject)
        self._publish(findings_by_file or {}, texts)

    def _cancel_checks(self) -> None:
        """Cancel the running and the waiting checks."""
        for check in (*self._large_checks.values(), *((self._check_loop,) if self._check_loop is not None else ())):
            check.cancel()
        self._large_checks.clear()

    def _publish(self, findings_by_file: Mapping[Path, Sequence[Diagnostic]], texts: Mapping[Path, str]) -> None:
        """Publish the findings about files, except open files that have changed since the check."""
        positions = cache(self.positions)
        for file, findings in findings_by_file.items():
            uri = self.uri_of(file)
            document = self.workspace.text_documents.get(uri)
            if document is not None and texts.get(file) != document.source:
                continue  # The text has changed since the check, and is checked again.
            self.text_document_publish_diagnostics(
                types.PublishDiagnosticsParams(
                    uri,
                    as_diagnostics(findings, positions, self.uri_of, links_pages=self.opens_pages),
                    None if document is None else document.version,
                )
            )

    async def _attempt(self, work: Callable[[], T], path: Path) -> T | None:
        """Return the result of work in the check thread, or log an error and return None."""
        try:
            return await self.run_in_check_thread(work)
        except Exception:  # noqa: BLE001 - the editor continues to work, and the log has the reason
            _log.exception("The check of '%s' failed", path)
            return None

    def submit_to_check_thread(self, work: Iterable[Callable[[], object]], path: Path) -> None:
        """Submit work to the check thread, and replace waiting work about the same file."""
        for future in self._submitted_work.pop(path, ()):
            future.cancel()
        self._submitted_work[path] = [self._check_thread.submit(task) for task in work]

    async def run_in_check_thread(self, work: Callable[[], T]) -> T:
        """Return the result of work in the check thread, which does one task after the other."""
        return await asyncio.get_running_loop().run_in_executor(self._check_thread, work)


def path_from_uri(uri: str) -> Path | None:
    """Return the path of a file's URI, or None for other URIs."""
    parts = urlsplit(uri)
    return Path(url2pathname(unquote(parts.path))) if parts.scheme == "file" else None
