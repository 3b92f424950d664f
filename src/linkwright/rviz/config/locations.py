"""Recently used configurations, server folders, and recovery files for unsaved edits.

When the program ends, the unsaved edits of each configuration are stored in a recovery file. RViz asks the user before
its window closes, but a program that is stopped with Ctrl-C cannot ask.
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


EXTENSION = ".rviz"

_MAX_RECENT_FILES = 10
_MAX_ENTRIES = 1000


def resolve_configuration_path(text: str, folder: Path) -> Path:
    """Return the path of the configuration file that a page requested.

    Args:
        text: an absolute path, a path from ``~``, or a path relative to the folder.
        folder: the folder of the open file.

    Raises:
        LinkwrightError: RVIZ105, the file's name, or the name of its link target, does not end in ``.rviz``.
    """
    try:
        path = Path(os.path.normpath(folder / Path(text).expanduser()))
        suffixes = (path.suffix, Path(os.path.realpath(path)).suffix)
    except (ValueError, RuntimeError, OSError):
        suffixes, path = ("", ""), Path(text)
    if "\0" in text or any(suffix != EXTENSION for suffix in suffixes):
        hint = phrase("choose a name that ends in '{extension}'", extension=EXTENSION)
        raise LinkwrightError(
            Diagnostic(
                "RVIZ105", phrase("'{text}' is not a valid file name for an RViz configuration", text=text), hint=hint
            )
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
                    elif entry.name.endswith(EXTENSION) and entry.is_file():
                        files.append(entry.name)
    except (OSError, ValueError, RuntimeError) as error:  # RuntimeError: there is no user with the name in `~user`
        reason = getattr(error, "strerror", None) or error
        raise LinkwrightError(
            Diagnostic(
                "RVIZ106", phrase("cannot list the folder '{path}': {reason}", path=path, reason=foreign(reason))
            )
        ) from None
    parent = None if path.parent == path else str(path.parent)
    from linkwright.page.protocol.configuration import Folder  # imported late: page tokens use only the folder

    return Folder(str(path), parent, sorted(folders)[:_MAX_ENTRIES], sorted(files)[:_MAX_ENTRIES])


class RecentFiles:
    """The most recently opened or saved files, stored for the next start of the program.

    Args:
        store: the file for the paths; by default a file in the user's state folder.
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
        """Put a file at the top of the list, and store the list.

        A failure to store the list is ignored.
        """
        name = str(path)
        self._write([name, *(other for other in self._read() if other != name)][:_MAX_RECENT_FILES])

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
                return [path for path in paths if isinstance(path, str)][:_MAX_RECENT_FILES]
        return []


_UNNAMED = "untitled"
_UNSAFE_CHARACTERS = re.compile(r"[^\w. -]+|^\.+")
_MAX_NAME_LENGTH = 56
"""The limit in characters, each of which can need four bytes in the file system."""
_RECOVERY_HINT = phrase("open that file in the page, or with 'rviz2 -d'")


def recovery_folder() -> Path:
    """Return the path of the folder with the recovery files, below the user's state folder."""
    return state_folder() / "unsaved"


def recovery_file(config: RvizConfig) -> Path:
    """Return the path of the recovery file of a configuration.

    The file need not exist. A configuration that was opened from the recovery folder is its own recovery file.
    """
    folder = recovery_folder()
    if config.path is not None:
        path = _resolve_path(config.path)
        return (
            folder / path.name if path.parent == _resolve_path(folder) else folder / _make_recovery_file_name(str(path))
        )
    name = config.document.source.name
    return folder / (
        f"{_UNNAMED}{EXTENSION}" if name.startswith("<") else _make_recovery_file_name(name)
    )  # a name such as "<default>"


def store_unsaved(configs: Iterable[RvizConfig]) -> list[Diagnostic]:
    """Write the configurations that have unsaved edits to recovery files.

    Returns:
        For each of these configurations, a finding with the path of its recovery file (RVIZ301), or with the reason
        why the file cannot be written (RVIZ104).
    """
    diagnostics: list[Diagnostic] = []
    used_paths: set[Path] = set()
    for config in configs:
        text = config.text()
        if _is_saved(config, text):
            continue
        path = _find_unused_path(recovery_file(config), used_paths)
        used_paths.add(path)
        with suppress(OSError):  # the write below reports the error
            path.parent.mkdir(parents=True, exist_ok=True)
        try:
            configuration_file.write(path, text, FileForm())
        except LinkwrightError as error:
            diagnostics += error.diagnostics
        else:
            RecentFiles().add(path)
            diagnostics.append(_make_stored_finding(config, path))
    return diagnostics


def find_unsaved(config: RvizConfig) -> list[Diagnostic]:
    """Return the finding (RVIZ302) about a recovery file of an earlier run, if there is one."""
    path = recovery_file(config)
    if config.path is None or _resolve_path(config.path) == _resolve_path(path) or not path.is_file():
        return []
    message = phrase(
        "earlier unsaved changes to '{path}' are stored in '{recovery_file}': {hint}",
        path=config.path,
        recovery_file=path,
        hint=_RECOVERY_HINT,
    )
    return [Diagnostic("RVIZ302", message, severity=Severity.INFO)]


def remove_recovery_files(previous_path: Path | None, config: RvizConfig, recent: RecentFiles) -> None:
    """Remove the recovery files of a configuration that has just been saved.

    Args:
        previous_path: the previous file of the configuration, or None. It is also removed if it is a recovery file,
            because the configuration has been saved elsewhere.
        config: the configuration, whose path is the file that it was saved to.
        recent: the list from which removed files are dropped.
    """
    recovery_files = {recovery_file(config)}
    if previous_path is not None and _resolve_path(previous_path).parent == _resolve_path(recovery_folder()):
        recovery_files.add(_resolve_path(previous_path))
    for path in recovery_files:
        if config.path is None or _resolve_path(path) == _resolve_path(config.path):
            continue
        with suppress(OSError):
            path.unlink()
            recent.remove(path)


def _make_stored_finding(config: RvizConfig, path: Path) -> Diagnostic:
    if config.path is None or _resolve_path(config.path) == _resolve_path(path):
        message = phrase("unsaved displays are stored in '{path}': {hint}", path=path, hint=_RECOVERY_HINT)
    else:
        message = phrase(
            "unsaved changes to '{path}' are stored in '{recovery_file}': {hint}",
            path=config.path,
            recovery_file=path,
            hint=_RECOVERY_HINT,
        )
    return Diagnostic("RVIZ301", message, severity=Severity.WARNING)


def _is_saved(config: RvizConfig, text: str) -> bool:
    """Return whether the file of the configuration already contains this text."""
    if config.path is None:
        return False
    try:
        return configuration_file.read(config.path)[0] == text
    except LinkwrightError:
        return False


def _make_recovery_file_name(name: str) -> str:
    """Return the name of the recovery file for a configuration.

    Characters that are not safe in a file name are replaced, because the configuration's name may come from a page.
    """
    digest = hashlib.sha256(os.fsencode(name)).hexdigest()[:8]  # distinguishes files with equal names
    stem = _UNSAFE_CHARACTERS.sub("_", Path(name).stem)[:_MAX_NAME_LENGTH]
    return f"{stem or _UNNAMED}-{digest}{EXTENSION}"


def _find_unused_path(path: Path, used_paths: set[Path]) -> Path:
    """Return the path, or a numbered path next to it if another page's copy already uses it."""
    number, candidate = 1, path
    while candidate in used_paths:
        number += 1
        candidate = path.with_name(f"{path.stem}-{number}{EXTENSION}")
    return candidate


def _resolve_path(path: Path) -> Path:
    return Path(os.path.realpath(path))
