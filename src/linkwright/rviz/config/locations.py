"""Recently used configurations, server folders, and recovery files for unsaved edits.

When the program ends, the unsaved edits of each configuration are stored in a recovery file. RViz asks the user before
its window is closed, but Ctrl-C in a terminal cannot ask.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, foreign, phrase
from linkwright.files.user_folders import state_folder
from linkwright.files.whole_files import write_whole_file
from linkwright.rviz.config import file as configuration_file
from linkwright.rviz.config.file import FileForm

if TYPE_CHECKING:
    from linkwright.page.protocol.configuration import Folder
    from linkwright.rviz.config.rviz_config import RvizConfig


ENDING = ".rviz"

_MOST_RECENT = 10
_MOST_ENTRIES = 1000


def configuration_path(text: str, folder: Path) -> Path:
    """Return the path of the configuration file that a page requested.

    Args:
        text: an absolute path, a path from ``~``, or a path relative to the folder.
        folder: the folder of the open file.

    Raises:
        LinkwrightError: RVIZ105, the file's name, or the name of its link target, does not end in ``.rviz``.
    """
    try:
        path = Path(os.path.normpath(folder / Path(text).expanduser()))
        ends = (path.suffix, Path(os.path.realpath(path)).suffix)
    except (ValueError, RuntimeError, OSError):
        ends, path = ("", ""), Path(text)
    if "\0" in text or any(end != ENDING for end in ends):
        hint = phrase("choose a name that ends in '{ending}'", ending=ENDING)
        raise LinkwrightError(
            Diagnostic("RVIZ105", phrase("'{text}' is not the name of an RViz configuration", text=text), hint=hint)
        )
    return path


def list_folder(text: str | None, folder: Path) -> Folder:
    """Return the subfolders and configuration files in a folder, omitting hidden ones.

    Args:
        text: an absolute path, a path from ``~``, or a path relative to `folder`; None for `folder` itself.
        folder: the folder of the open file.

    Raises:
        LinkwrightError: RVIZ106, the folder cannot be read.
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
    except (OSError, ValueError, RuntimeError) as error:  # RuntimeError: `~user` is not a known user
        reason = getattr(error, "strerror", None) or error
        raise LinkwrightError(
            Diagnostic(
                "RVIZ106", phrase("cannot list the folder '{path}': {reason}", path=path, reason=foreign(reason))
            )
        ) from None
    parent = None if path.parent == path else str(path.parent)
    from linkwright.page.protocol.configuration import Folder  # imported late: page tokens use only the folder

    return Folder(str(path), parent, sorted(folders)[:_MOST_ENTRIES], sorted(files)[:_MOST_ENTRIES])


class RecentFiles:
    """The most recently opened or saved files, stored for the next start of the program.

    Args:
        store: the file in which their paths are stored; by default one in the user's state folder.
    """

    def __init__(self, store: Path | None = None) -> None:
        self._store = store or state_folder() / "recent-rviz.json"
        self._paths: list[str] | None = None

    @property
    def paths(self) -> list[str]:
        """The paths of the recent files, newest first."""
        if self._paths is None:
            self._paths = self._read()
        return self._paths

    def add(self, path: Path) -> None:
        """Put a file at the top of the list, and store the list; a failure to store it is ignored."""
        name = str(path)
        self._write([name, *(other for other in self._read() if other != name)][:_MOST_RECENT])

    def remove(self, path: Path) -> None:
        """Remove a file that no longer exists from the list, if the list contains it."""
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


_UNNAMED = "untitled"
_UNFIT = re.compile(r"[^\w. -]+|^\.+")
_LONGEST_NAME = 56
"""Characters, of which a file system may count four bytes each."""
_RECOVERY_HINT = phrase("open that file in the page, or with 'rviz2 -d'")


def recovery_folder() -> Path:
    """Return the path of the folder with the recovery files, below the user's state folder."""
    return state_folder() / "unsaved"


def recovery_file(config: RvizConfig) -> Path:
    """Return the path of the recovery file of a configuration, whether or not it exists.

    A configuration that was opened from the recovery folder is its own recovery file.
    """
    folder = recovery_folder()
    if config.path is not None:
        path = _absolute(config.path)
        return folder / path.name if path.parent == _absolute(folder) else folder / _recovery_file_name(str(path))
    name = config.document.source.name
    return folder / (
        f"{_UNNAMED}{ENDING}" if name.startswith("<") else _recovery_file_name(name)
    )  # such as "<default>"


def keep_unsaved(configs: Iterable[RvizConfig]) -> list[Diagnostic]:
    """Write the configurations that have unsaved edits to recovery files.

    Returns:
        For each of them, a finding with the location of the file (RVIZ301) or with the reason why it cannot be written
        (RVIZ104).
    """
    diagnostics: list[Diagnostic] = []
    taken: set[Path] = set()
    for config in configs:
        text = config.text()
        if _is_saved(config, text):
            continue
        path = _free(recovery_file(config), taken)
        taken.add(path)
        with suppress(OSError):  # the write below reports the error
            path.parent.mkdir(parents=True, exist_ok=True)
        try:
            configuration_file.write(path, text, FileForm())
        except LinkwrightError as error:
            diagnostics += error.diagnostics
        else:
            RecentFiles().add(path)
            diagnostics.append(_stored_finding(config, path))
    return diagnostics


def find_unsaved(config: RvizConfig) -> list[Diagnostic]:
    """Report a recovery file that an earlier run of the program stored for this file (RVIZ302)."""
    path = recovery_file(config)
    if config.path is None or _absolute(config.path) == _absolute(path) or not path.is_file():
        return []
    message = phrase(
        "earlier unsaved changes of '{path}' are in '{kept}': {how}",
        path=config.path,
        kept=path,
        how=_RECOVERY_HINT,
    )
    return [Diagnostic("RVIZ302", message, severity=Severity.INFO)]


def remove_recovery_files(former: Path | None, config: RvizConfig, recent: RecentFiles) -> None:
    """Remove the recovery files of a configuration that has just been saved.

    Args:
        former: the file that the configuration had before, or None. It is also removed if it is a recovery file,
            because the configuration has been saved elsewhere.
        config: the configuration, whose path is the file that it was saved to.
        recent: the list from which removed files are dropped.
    """
    done = {recovery_file(config)}
    if former is not None and _absolute(former).parent == _absolute(recovery_folder()):
        done.add(_absolute(former))
    for path in done:
        if config.path is None or _absolute(path) == _absolute(config.path):
            continue
        with suppress(OSError):
            path.unlink()
            recent.remove(path)


def _stored_finding(config: RvizConfig, path: Path) -> Diagnostic:
    if config.path is None or _absolute(config.path) == _absolute(path):
        message = phrase("unsaved displays are stored in '{path}': {how}", path=path, how=_RECOVERY_HINT)
    else:
        message = phrase(
            "unsaved changes of '{path}' are stored in '{kept}': {how}",
            path=config.path,
            kept=path,
            how=_RECOVERY_HINT,
        )
    return Diagnostic("RVIZ301", message, severity=Severity.WARNING)


def _is_saved(config: RvizConfig, text: str) -> bool:
    """Return whether the configuration's file already contains this text, so that nothing is unsaved."""
    if config.path is None:
        return False
    try:
        return configuration_file.read(config.path)[0] == text
    except LinkwrightError:
        return False


def _recovery_file_name(name: str) -> str:
    """Return a safe recovery file name for a configuration name, which a page may have chosen."""
    mark = hashlib.sha256(os.fsencode(name)).hexdigest()[:8]  # files of the same name in different folders
    stem = _UNFIT.sub("_", Path(name).stem)[:_LONGEST_NAME]
    return f"{stem or _UNNAMED}-{mark}{ENDING}"


def _free(path: Path, taken: set[Path]) -> Path:
    """Return the path, or a numbered one next to it if another page's copy has already taken it."""
    number, found = 1, path
    while found in taken:
        number += 1
        found = path.with_name(f"{path.stem}-{number}{ENDING}")
    return found


def _absolute(path: Path) -> Path:
    return Path(os.path.realpath(path))
