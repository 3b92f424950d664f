"""Where configuration files are on the server, and which were opened or saved before."""

from __future__ import annotations

import json
import os
from contextlib import suppress
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.viewer.protocol.configuration import Folder
from linkwright.whole_files import write_whole_file

ENDING = ".rviz"

_MOST_RECENT = 10
_MOST_ENTRIES = 1000


def state_folder() -> Path:
    """``XDG_STATE_HOME/linkwright`` or ``~/.local/state/linkwright``."""
    base = os.environ.get("XDG_STATE_HOME")
    return (Path(base) if base else Path.home() / ".local" / "state") / "linkwright"


def configuration_path(text: str, folder: Path) -> Path:
    """The file that a page names.

    Args:
        text: absolute, from ``~``, or from the folder.
        folder: of the open file.

    Raises:
        LinkwrightError: RVIZ105, its name, or that of the file it is a link to, does not end in ``.rviz``.
    """
    try:
        path = Path(os.path.normpath(folder / Path(text).expanduser()))
        ends = (path.suffix, Path(os.path.realpath(path)).suffix)
    except (ValueError, RuntimeError, OSError):
        ends, path = ("", ""), Path(text)
    if "\0" in text or any(end != ENDING for end in ends):
        hint = phrase("give it a name that ends in '{ending}'", ending=ENDING)
        raise LinkwrightError(
            Diagnostic("RVIZ105", phrase("'{text}' is not the name of an RViz configuration", text=text), hint=hint)
        )
    return path


def list_folder(text: str | None, folder: Path) -> Folder:
    """What is in a folder, hidden things aside.

    Args:
        text: absolute, from ``~``, or from the folder of the open file; None for that one.
        folder: of the open file.

    Raises:
        LinkwrightError: RVIZ106, it cannot be read.
    """
    folders, files = [], []
    path = folder / (text or "")
    try:
        path = Path(os.path.normpath(folder / Path(text or "").expanduser()))
        with os.scandir(path) as entries:
            for entry in entries:
                if entry.name.startswith("."):
                    continue
                with suppress(OSError):
                    if entry.is_dir():
                        folders.append(entry.name)
                    elif entry.name.endswith(ENDING) and entry.is_file():
                        files.append(entry.name)
    except (OSError, ValueError, RuntimeError) as error:  # the last when there is no such user
        reason = getattr(error, "strerror", None) or error
        raise LinkwrightError(
            Diagnostic(
                "RVIZ106", phrase("cannot list the folder '{path}': {reason}", path=path, reason=foreign(reason))
            )
        ) from None
    parent = None if path.parent == path else str(path.parent)
    return Folder(str(path), parent, sorted(folders)[:_MOST_ENTRIES], sorted(files)[:_MOST_ENTRIES])


class RecentFiles:
    """The files opened or saved last, kept for the next time.

    Args:
        store: the file that they are kept in; by default one of the user's state.
    """

    def __init__(self, store: Path | None = None) -> None:
        self._store = store or state_folder() / "recent-rviz.json"
        self._paths: list[str] | None = None

    @property
    def paths(self) -> list[str]:
        """Newest first."""
        if self._paths is None:
            self._paths = self._read()
        return self._paths

    def add(self, path: Path) -> None:
        """Remember a file as the newest; a list that cannot be saved is no error."""
        name = str(path)
        self._write([name, *(other for other in self._read() if other != name)][:_MOST_RECENT])

    def remove(self, path: Path) -> None:
        """Drop a file that is gone."""
        paths = self._read()
        if str(path) in paths:
            self._write([other for other in paths if other != str(path)])

    def _write(self, paths: list[str]) -> None:
        self._paths = paths
        with suppress(OSError):
            self._store.parent.mkdir(parents=True, exist_ok=True)
            write_whole_file(self._store, json.dumps(self._paths))

    def _read(self) -> list[str]:
        with suppress(OSError, ValueError, RecursionError):
            paths = json.loads(self._store.read_text(encoding="utf-8"))
            if isinstance(paths, list):
                return [path for path in paths if isinstance(path, str)][:_MOST_RECENT]
        return []
