"""Watching files for changes."""

from __future__ import annotations

import asyncio
import stat
import threading
from collections.abc import Callable, Iterable
from pathlib import Path

_STEP_MS = 20
"""How often the watcher looks whether the system's notifications have settled: the latency is once
this."""
_DEBOUNCE_MS = 100


class FileWatch:
    """Calls back on the event loop when files of some folders change.

    Folders are watched rather than files, because editors save by writing a new file and renaming it. Files
    behind links (``colcon build --symlink-install``) are watched where they really are too. For a folder that is not
    there, such as one that a build is about to make anew, the nearest one above it is watched.

    Args:
        on_change: called with the paths that changed.
        on_failure: called with the reason when watching fails.
    """

    def __init__(self, on_change: Callable[[set[Path]], None], on_failure: Callable[[str], None]) -> None:
        self._on_change = on_change
        self._on_failure = on_failure
        self._loop = asyncio.get_running_loop()
        self._folders: frozenset[tuple[str, int]] = frozenset()
        self._stop: threading.Event | None = None

    def watch(self, files: Iterable[Path]) -> bool:
        """Watch the folders of these files, and of those only, from now on.

        Returns:
            Whether that is a new watch, which takes a moment to begin.
        """
        folders = frozenset(
            (str(folder), number)
            for file in files
            for folder, number in {_nearest_folder(file), _nearest_folder(real(file))}
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

    def _run(self, folders: list[str], stop: threading.Event) -> None:
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


def _nearest_folder(file: Path) -> tuple[Path, int]:
    """The folder of a file, or the nearest above it that is there, and a number that one made anew does not have."""
    for folder in file.absolute().parents:
        try:
            facts = folder.stat()
        except OSError:
            continue
        if stat.S_ISDIR(facts.st_mode):
            return folder, facts.st_ino
    return file.absolute().parents[-1], 0


def real(path: Path) -> Path:
    """The path with links followed; the path itself where that goes in circles."""
    try:
        return path.resolve()
    except OSError:
        return path
