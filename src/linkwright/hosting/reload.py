"""Live reload: when a description file is saved, nodes receive its new text.

The nodes continue to run, so that joint positions and the camera do not change. If a description cannot be read, the
last valid one remains in use, and the errors are shown until the file is fixed.
"""

from __future__ import annotations

import asyncio
import os
import stat
import threading
from collections.abc import Awaitable, Callable, Coroutine, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, display_path, has_errors
from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.xacro_calls import Descriptions, XacroCall

if TYPE_CHECKING:
    from linkwright.descriptions.unsaved import UpdateOutcome
    from linkwright.graph import Node
    from linkwright.nodes.watched_files import ReadWorld

_RETRY_DELAY_S = 0.06
"""The delay before a failure is reported, because an editor may still be writing the file."""
_MISSING_ATTEMPTS = 8
"""The number of attempts to read a missing file, because some editors delete a file before they write it."""
_CATCH_UP_DELAY_S = 0.4
"""The delay after which files are checked once for changes that were made before the watch began."""

_CHECK_INTERVAL_MS = 20
"""The interval, in milliseconds, at which the watcher checks for the end of notifications.

The interval is also the latency.
"""
_DEBOUNCE_MS = 100

Apply = Callable[[str], None]
"""A function that receives the new text of a description."""


class LiveReload:
    """A watch on the files of a launch's descriptions that reloads changed descriptions.

    Args:
        descriptions: the descriptions of the launch.
        show: called with all current findings, for display in the viewer.
        log: the log to which findings are printed.

    Attributes:
        descriptions: expands and stores the descriptions.
    """

    def __init__(self, descriptions: Descriptions, show: Callable[[list[Diagnostic]], None], log: LaunchLog) -> None:
        self.descriptions = descriptions
        self._show = show
        self._log = log
        self._callbacks: dict[XacroCall, list[Apply]] = {}
        self._findings: dict[object, tuple[Diagnostic, ...]] = {}
        self._watch: FileWatch | None = None
        self._running: dict[XacroCall, asyncio.Task[None]] = {}
        self._pending_reloads: set[XacroCall] = set()
        self._saved_calls: set[XacroCall] = set()
        self._failed_calls: set[XacroCall] = set()
        self._is_started = False
        self._is_closed = False

    def bind(self, call: XacroCall, apply: Apply) -> None:
        """Register a function that is called with every new text of a description."""
        self._callbacks.setdefault(call, []).append(apply)
        self._watch_files()

    def unbind(self, call: XacroCall, apply: Apply) -> None:
        """Unregister a function that `bind` registered."""
        self._callbacks[call].remove(apply)

    def forget(self, call: XacroCall) -> None:
        """Stop watching the files of a description, and remove the findings about it."""
        self._callbacks.pop(call, None)
        self._findings.pop(call, None)
        self._show(self.findings())
        self._watch_files()

    def show(self, subject: object, diagnostics: Iterable[Diagnostic]) -> None:
        """Show findings in the viewer without printing them.

        The findings replace the earlier findings about the same object.
        """
        self._findings[subject] = tuple(diagnostics)
        self._show(self.findings())

    def report(self, subject: object, diagnostics: Iterable[Diagnostic]) -> None:
        """Print and show findings, in place of the earlier findings about the same object.

        Errors are printed at each call, but warnings and notes only when they are new.
        """
        findings = tuple(diagnostics)
        known_keys = {_create_finding_key(finding) for finding in self._findings.get(subject, ())}
        self._log.write_diagnostics(
            finding
            for finding in findings
            if finding.severity is Severity.ERROR or _create_finding_key(finding) not in known_keys
        )
        self.show(subject, findings)

    def findings(self) -> list[Diagnostic]:
        """Return all current findings."""
        return [finding for findings in self._findings.values() for finding in findings]

    def start(self) -> None:
        """Start to watch the files.

        An event loop must be running.
        """
        self._is_started = True
        self._watch_files()
        if self.descriptions.reads_unsaved:
            self.descriptions.library.unsaved_listeners.append(self._reload_unsaved)

    def close(self) -> None:
        """Stop watching the files."""
        self._is_closed = True
        if self._watch is not None:
            self._watch.close()
        for task in self._running.values():
            task.cancel()

    # --- watched files --------------------------------------------------------------------------------------

    def _find_watched_files(self, call: XacroCall) -> set[Path]:
        """Return the files of a description, and the files that its findings mention."""
        files = {call.path, *self.descriptions.get_files(call)}
        for finding in self._findings.get(call, ()):
            spans = (finding.span, *(note.span for note in finding.notes))
            files.update(Path(span.file) for span in spans if span and not span.file.startswith("<"))
        return files

    def _watch_files(self) -> None:
        if not self._is_started or self._is_closed or not self._callbacks:
            return
        if self._watch is None:
            self._watch = FileWatch(self._on_change, self._on_watch_failure)
        if self._watch.watch({file for call in self._callbacks for file in self._find_watched_files(call)}):
            asyncio.get_running_loop().call_later(_CATCH_UP_DELAY_S, self._reload_missed)

    def _on_watch_failure(self, reason: str) -> None:
        self._log.write_warning("launch", f"model files are not watched for changes: {reason}")

    def _reload_missed(self) -> None:
        """Reload descriptions whose files changed after they were read, but before the watch began."""
        for call in self._callbacks if not self._is_closed else ():
            read_ns = self.descriptions.read_ns(call)
            modification_times = [_read_modified_ns(path) for path in self._find_watched_files(call)]
            if max(modification_times) > read_ns or (0 in modification_times and not self._is_broken(call)):
                self._start_reload(call)

    # --- a change -------------------------------------------------------------------------------------------

    def _on_change(self, paths: set[Path]) -> None:
        if self._is_closed:
            return
        for call in self._callbacks:
            files = self._find_watched_files(call)
            if not paths.isdisjoint(files | {resolve_path(file) for file in files}):
                self._saved_calls.add(call)
            if self._is_broken(call):
                # The missing file may be in the folder of this file, or in any package.
                self.descriptions.finder.clear_cache()
                self._start_reload(call)
            elif call in self._saved_calls:
                self._start_reload(call)

    async def _reload_unsaved(self, path: str) -> UpdateOutcome:
        """Reload the descriptions that contain a file whose unsaved text has changed."""
        affected_calls = [call for call in self._callbacks if self._uses_file(call, path)]
        for call in affected_calls if not self._is_closed else ():
            self._start_reload(call)
        while tasks := [self._running[call] for call in affected_calls if call in self._running]:
            await asyncio.wait(tasks)
            await asyncio.sleep(0)  # a reload that waited begins now
        if not affected_calls:
            return "elsewhere"
        return "errors" if any(call in self._failed_calls for call in affected_calls) else "shown"

    def _uses_file(self, call: XacroCall, path: str) -> bool:
        return any(os.path.realpath(file) == path for file in self._find_watched_files(call))

    def _is_unsaved(self, call: XacroCall) -> bool:
        """Return whether a description is read with unsaved texts.

        The findings about unsaved texts are shown in pages, but not printed.
        """
        return any(self._uses_file(call, str(path)) for path in self.descriptions.unsaved_texts)

    def _is_broken(self, call: XacroCall) -> bool:
        return has_errors(self._findings.get(call, ()))

    def _start_reload(self, call: XacroCall) -> None:
        if call in self._running:
            self._pending_reloads.add(call)
            return
        task = asyncio.get_running_loop().create_task(self._reload(call))
        self._running[call] = task
        task.add_done_callback(lambda _: self._after_reload(call))

    def _after_reload(self, call: XacroCall) -> None:
        del self._running[call]
        if call in self._pending_reloads and not self._is_closed:
            self._pending_reloads.discard(call)
            self._start_reload(call)

    async def _reload(self, call: XacroCall) -> None:
        for attempt in range(_MISSING_ATTEMPTS):
            text, findings = await self._read(call)
            if text is not None:
                self._failed_calls.discard(call)
                self._apply(call, text, findings)
                return
            if self._is_unsaved(call):
                self._failed_calls.add(call)
                self.show(call, findings)
                self._watch_files()
                return
            all_exist = all(path.is_file() for path in self._find_watched_files(call))
            if attempt > 0 and all_exist:
                break
            await asyncio.sleep(_RETRY_DELAY_S)
            if call in self._pending_reloads:
                return  # A newer change has already started another reload.
        if call not in self._callbacks:
            return
        self._failed_calls.add(call)
        known_keys = [_create_finding_key(finding) for finding in self._findings.get(call, ())]
        if call in self._saved_calls or known_keys != [_create_finding_key(finding) for finding in findings]:
            self.report(call, findings)
        self._saved_calls.discard(call)
        self._watch_files()

    async def _read(self, call: XacroCall) -> tuple[str | None, tuple[Diagnostic, ...]]:
        """Return the text of a description or None, and the findings about it."""
        loop = asyncio.get_running_loop()
        try:
            description = await loop.run_in_executor(None, self.descriptions.read, call)
        except LinkwrightError as error:
            return None, error.diagnostics
        return self.descriptions.store_result(call, description)

    def _apply(self, call: XacroCall, text: str, findings: tuple[Diagnostic, ...]) -> None:
        was_broken = self._is_broken(call)
        self._saved_calls.discard(call)
        if call not in self._callbacks:
            return
        try:
            for apply in tuple(self._callbacks[call]):
                apply(text)
        except LinkwrightError as error:
            findings = (*findings, *error.diagnostics)
        if self._is_unsaved(call):
            self.show(call, findings)
            self._watch_files()
            return
        verb = "repaired" if was_broken and not has_errors(findings) else "reloaded"
        self._log.write_info("launch", f"{verb} {display_path(call.path)}")
        self.report(call, findings)
        self._watch_files()


def _create_finding_key(finding: Diagnostic) -> tuple[object, ...]:
    return finding.code, finding.message, finding.span


def _read_modified_ns(path: Path) -> int:
    """Return a file's modification time in ns since the epoch, or 0 if it does not exist."""
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0


class FileWatch:
    """A watch that calls a function on the event loop when files in certain folders change.

    Folders are watched instead of files, because editors save a file by writing a new file and renaming it. Files
    behind links (``colcon build --symlink-install``) are also watched at their real location. If a folder does not
    exist, for example because a build is about to create it again, its nearest existing parent is watched.

    Args:
        on_change: called with the paths of the changed files.
        on_failure: called with the reason if the folders cannot be watched.
    """

    def __init__(self, on_change: Callable[[set[Path]], None], on_failure: Callable[[str], None]) -> None:
        self._on_change = on_change
        self._on_failure = on_failure
        self._loop = asyncio.get_running_loop()
        self._folders: frozenset[tuple[str, int]] = frozenset()
        self._stop: threading.Event | None = None

    def watch(self, files: Iterable[Path]) -> bool:
        """Watch the folders of the given files, and no other folders.

        Returns:
            Whether a new watch begins. Such a watch does not detect changes immediately.
        """
        folders = frozenset(
            (str(folder), inode)
            for file in files
            for folder, inode in {_find_nearest_folder(file), _find_nearest_folder(resolve_path(file))}
        )
        if folders == self._folders:
            return False
        self.close()
        self._folders = folders
        if folders:
            self._stop = threading.Event()
            threading.Thread(
                target=self._run,
                args=([name for name, _ in folders], self._stop),
                name="linkwright-file-watch",
                daemon=True,
            ).start()
        return True

    def close(self) -> None:
        """Stop watching."""
        if self._stop is not None:
            self._stop.set()
        self._stop = None
        self._folders = frozenset()

    def _run(self, folders: list[str], stop_event: threading.Event) -> None:
        import watchfiles

        try:
            for changes in watchfiles.watch(
                *folders,
                watch_filter=None,
                debounce=_DEBOUNCE_MS,
                step=_CHECK_INTERVAL_MS,
                stop_event=stop_event,
                rust_timeout=1000,
                raise_interrupt=False,
                recursive=False,
            ):
                if not stop_event.is_set():
                    self._call_on_loop(self._on_files_changed, {Path(path) for _, path in changes})
        except (OSError, RuntimeError) as error:
            if not stop_event.is_set():
                self._call_on_loop(self._on_failure, str(error))

    def _on_files_changed(self, paths: set[Path]) -> None:
        if not paths.isdisjoint(Path(name) for name, _ in self._folders):
            self._folders = frozenset()  # A folder was deleted, and a new one may have the same number.
        self._on_change(paths)

    def _call_on_loop(self, function: Callable[..., None], argument: object) -> None:
        try:
            self._loop.call_soon_threadsafe(function, argument)
        except RuntimeError:  # The loop was closed, because the launch has ended.
            return


def _find_nearest_folder(file: Path) -> tuple[Path, int]:
    """Return the nearest existing folder above a file, with its inode number.

    The number changes when the folder is replaced.
    """
    for folder in file.absolute().parents:
        try:
            status = folder.stat()
        except OSError:
            continue
        if stat.S_ISDIR(status.st_mode):
            return folder, status.st_ino
    return file.absolute().parents[-1], 0


def resolve_path(path: Path) -> Path:
    """Return a path with its links resolved, or unchanged if the links form a cycle."""
    try:
        return path.resolve()
    except OSError:
        return path


class WatchedFiles:
    """A `FileWatcher` that watches the files of a node through the live reload of its run.

    Args:
        reload: the live reload of the run to which the node belongs.
        spawn: runs a coroutine in the background of the run.
        launcher: returns the launcher's own node.
    """

    def __init__(
        self, reload: LiveReload, spawn: Callable[[Coroutine[Any, Any, None]], None], launcher: Callable[[], Node]
    ) -> None:
        self._reload = reload
        self._spawn = spawn
        self._launcher = launcher
        self._watched: set[tuple[XacroCall, str]] = set()

    @property
    def launcher_node(self) -> Node:
        """The launcher's own node, which calls services."""
        return self._launcher()

    def show(self, subject: str, findings: Iterable[Diagnostic]) -> None:
        """Show the current findings about a subject in the viewers."""
        self._reload.show(subject, findings)

    def watch_world(
        self,
        world: ReadWorld,
        read: Callable[[str], ReadWorld],
        load: Callable[[str], Awaitable[Sequence[Diagnostic]]],
    ) -> None:
        """Read the file of a world again when it is saved.

        The world is loaded unless it has new errors.

        Args:
            world: the world that was read first.
            read: reads the file of a world.
            load: loads a world, and returns findings about it.
        """
        call = self._reload.descriptions.register_world(world, read)

        async def load_saved(path: str) -> None:
            findings = await load(path)
            if findings:
                self._reload.report(call, findings)

        self._reload.bind(call, lambda path: self._spawn(load_saved(path)))

    def watch_text(self, text: str, name: str, on_text: Callable[[str], None]) -> None:
        """Register a function for each new text of a description.

        This has no effect unless this process expanded the text from a file.
        """
        call = self._reload.descriptions.find_call(text)
        if call is not None and (call, name) not in self._watched:
            self._watched.add((call, name))
            self._reload.bind(call, on_text)
