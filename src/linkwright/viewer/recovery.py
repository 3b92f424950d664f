"""What was edited and not saved when the program ended: kept in a file of its own, one for each configuration.

RViz asks before its window is closed. Ctrl-C in a terminal asks nobody.
"""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity
from linkwright.viewer import configuration_file
from linkwright.viewer.configuration_file import FileForm
from linkwright.viewer.configuration_places import ENDING, RecentFiles, state_folder

if TYPE_CHECKING:
    from linkwright.viewer.manager import VisualizationManager
    from linkwright.viewer.rviz_config import RvizConfig

_UNNAMED = "untitled"
_UNFIT = re.compile(r"[^\w. -]+|^\.+")
_LONGEST_NAME = 56
"""Characters, of which a file system may count four bytes each."""
_HOW = "open that file on the page, or with 'rviz2 -d'"


def recovery_folder() -> Path:
    """The folder of these files, below the user's state."""
    return state_folder() / "unsaved"


def recovery_file(config: RvizConfig) -> Path:
    """Where the edits of a configuration are kept; one that was recovered, and has no other file yet, is that file."""
    folder = recovery_folder()
    if config.path is not None:
        path = _whole(config.path)
        return folder / path.name if path.parent == _whole(folder) else folder / _name_for(str(path))
    name = config.document.source.name
    return folder / (f"{_UNNAMED}{ENDING}" if name.startswith("<") else _name_for(name))  # "<default>" and the like


def keep_unsaved(managers: Iterable[VisualizationManager]) -> list[Diagnostic]:
    """Write what is unsaved into the recovery files, and say where it is (RVIZ301), or that it is lost (RVIZ104)."""
    said: list[Diagnostic] = []
    taken: set[Path] = set()
    for manager in managers:
        config = manager.config
        text = config.text() if manager.history.unsaved else None
        if text is None or _is_saved(config, text):
            continue
        path = _free(recovery_file(config), taken)
        taken.add(path)
        with suppress(OSError):  # writing says what is wrong
            path.parent.mkdir(parents=True, exist_ok=True)
        try:
            configuration_file.write(path, text, FileForm())
        except LinkwrightError as error:
            said += error.diagnostics
        else:
            RecentFiles().add(path)
            said.append(_kept(config, path))
    return said


def find_unsaved(config: RvizConfig) -> list[Diagnostic]:
    """Tell of edits of a file that an earlier run of the program kept (RVIZ302)."""
    path = recovery_file(config)
    if config.path is None or _whole(config.path) == _whole(path) or not path.is_file():
        return []
    message = f"changes of '{config.path}' that were not saved at an earlier time are in '{path}': {_HOW}"
    return [Diagnostic("RVIZ302", message, severity=Severity.INFO)]


def forget_unsaved(former: Path | None, config: RvizConfig, recent: RecentFiles) -> None:
    """Remove what was kept of a configuration that was saved a moment ago.

    Args:
        former: the file that it had before: a recovery file that now is saved elsewhere has done its work.
        config: has the file that it was saved to.
        recent: where the files are listed that were removed.
    """
    done = {recovery_file(config)}
    if former is not None and _whole(former).parent == _whole(recovery_folder()):
        done.add(_whole(former))
    for path in done:
        if config.path is None or _whole(path) == _whole(config.path):
            continue
        with suppress(OSError):
            path.unlink()
            recent.remove(path)


def _kept(config: RvizConfig, path: Path) -> Diagnostic:
    if config.path is None or _whole(config.path) == _whole(path):
        message = f"displays that were not saved are kept in '{path}': {_HOW}"
    else:
        message = f"changes of '{config.path}' that were not saved are kept in '{path}': {_HOW}"
    return Diagnostic("RVIZ301", message, severity=Severity.WARNING)


def _is_saved(config: RvizConfig, text: str) -> bool:
    """Whether the file has a text: what was edited was edited back."""
    if config.path is None:
        return False
    try:
        return configuration_file.read(config.path)[0] == text
    except LinkwrightError:
        return False


def _name_for(name: str) -> str:
    """A name in the recovery folder for a configuration that is called like this, which a page may have done."""
    mark = hashlib.sha256(os.fsencode(name)).hexdigest()[:8]  # of two files of one name
    stem = _UNFIT.sub("_", Path(name).stem)[:_LONGEST_NAME]
    return f"{stem or _UNNAMED}-{mark}{ENDING}"


def _free(path: Path, taken: set[Path]) -> Path:
    """The file, or for a page's own displays, which began as a copy of the same configuration, one beside it."""
    number, found = 1, path
    while found in taken:
        number += 1
        found = path.with_name(f"{path.stem}-{number}{ENDING}")
    return found


def _whole(path: Path) -> Path:
    return Path(os.path.realpath(path))
