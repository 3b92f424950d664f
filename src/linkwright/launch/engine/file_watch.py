"""Noticing that files were saved."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Iterable
from pathlib import Path

_STEP_MS = 20
"""How often the watcher looks whether the notices of the system have come to rest: the latency is once
this."""
_DEBOUNCE_MS = 100


class FileWatch:
    """Calls back on the event loop when files of some folders change.

    Folders are watched rather than files, because editors save by writing a new file and renaming it. Files
    behind links (``colcon build --symlink-install``) are watched where they really are too.

    Args:
        on_change: called with the paths that changed.
        on_failure: called with the reason when the system lets us watch no more.
    """

    def __init__(self, on_change: Callable[[set[Path]], None], on_failure: Callable[[str], None]) -> None:
        self._on_change = on_change
        self._on_failure = on_failure
        self._loop = asyncio.get_running_loop()
        self._folders: frozenset[str] = frozenset()
        self._stop: threading.Event | None = None

    def watch(self, files: Iterable[Path]) -> bool:
        """Watch the folders of these files, and of those only, from now on.

        Returns:
            Whether that is a new watch, which takes a moment to begin.
        """
        folders = frozenset(
            str(folder) for file in files for folder in {file.parent, real(file).parent} if folder.is_dir()
        )
        if folders == self._folders:
            return False
        self.close()
        self._folders = folders
        if folders:
            self._stop = threading.Event()
            threading.Thread(
                target=self._run, args=(folders, self._stop), name="linkwright-file-watch", daemon=True
            ).start()
        return True

    def close(self) -> None:
        """Watch nothing any more."""
        if self._stop is not None:
            self._stop.set()
        self._stop = None
        self._folders = frozenset()

    def _run(self, folders: frozenset[str], stop: threading.Event) -> None:
        import watchfiles

        try:
            for changes in watchfiles.watch(
                *folders,
                watch_filter=None,
                debounce=_DEBOUNCE_MS,
                step=_STEP_MS,
                stop_event=stop,
                rust_timeout=1000,
                raise_interrupt=False,
                recursive=False,
            ):
                if not stop.is_set():
                    self._call(self._on_change, {Path(path) for _, path in changes})
        except (OSError, RuntimeError) as error:
            if not stop.is_set():
                self._call(self._on_failure, str(error))

    def _call(self, function: Callable[..., None], argument: object) -> None:
        try:
            self._loop.call_soon_threadsafe(function, argument)
        except RuntimeError:  # the loop is closed: the launch is over
            return


def real(path: Path) -> Path:
    """The path with links followed; the path itself where that goes in circles."""
    try:
        return path.resolve()
    except OSError:
        return path
