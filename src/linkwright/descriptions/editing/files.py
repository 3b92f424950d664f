"""The files of edited robots: write permission, writing, and undo."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from linkwright.descriptions.editing.errors import EditRefusedError
from linkwright.descriptions.editing.planning import EditPlan
from linkwright.descriptions.editing.refusals import changed_file, forbidden_file
from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.xmltree.decoding import decoded
from linkwright.xmltree.reader import read_bytes

_OURS = Path(__file__).resolve().parents[2]
"""The files in this folder are part of the program, and edits must not write them."""
_MOST_STEPS = 200
"""Of undo."""


class Workspace:
    """The files that edits may write: files of the workspace that are not installed.

    The workspace is the largest of three folders that contain the main file: the folder of its package, the folder of
    its git repository, and the folder whose ``src`` contains the file.

    Args:
        main: the file that was opened.
    """

    def __init__(self, main: Path) -> None:
        real = Path(os.path.realpath(main))
        self.folder = _workspace_of(real)

    def refusal(self, path: str) -> Diagnostic | None:
        """Return the reason why a file must not be written (EDIT106), or None if it may be written.

        Args:
            path: the real path of the file.
        """
        file = Path(path)
        if file.is_relative_to(_OURS):
            return forbidden_file(path, phrase("it is part of this program"))
        if any((parent / "share" / "ament_index").is_dir() for parent in file.parents):
            return forbidden_file(path, phrase("it is installed, and the next build would undo the change"))
        if not file.is_relative_to(self.folder):
            why = phrase("it is outside the workspace '{folder}'", folder=str(self.folder))
            return forbidden_file(path, why)
        if not os.access(path, os.W_OK):
            return forbidden_file(path, phrase("it is read-only"))
        return None


@dataclass(frozen=True, slots=True)
class Step:
    """An applied edit: the bytes of each file before and after, by real path."""

    files: Mapping[str, tuple[bytes, bytes]]


class EditHistory:
    """The history of written edits, with undo and redo."""

    def __init__(self) -> None:
        self._done: list[Step] = []
        self._undone: list[Step] = []

    @property
    def can_undo(self) -> bool:
        """Whether there is an edit to undo."""
        return bool(self._done)

    @property
    def can_redo(self) -> bool:
        """Whether there is an edit to redo."""
        return bool(self._undone)

    def apply(self, plan: EditPlan) -> list[str]:
        """Write the files of an edit, either all of them or none.

        Returns:
            The paths of the written files.

        Raises:
            EditRefusedError: EDIT107 if a file has changed since the edit was planned, or EDIT108 if a file cannot be
                written.
        """
        files: dict[str, tuple[bytes, bytes]] = {}
        for path, text in plan.texts.items():
            before = _bytes_of(path)
            known = decoded(before, path)
            if known.text != plan.before[path]:
                raise EditRefusedError(changed_file(path))
            mark = before[: len(before) - len(known.text.encode(known.encoding))]
            files[path] = before, mark + text.encode(known.encoding, "xmlcharrefreplace")
        _write({path: after for path, (_, after) in files.items()}, {path: old for path, (old, _) in files.items()})
        if files:
            self._done = [*self._done[1 - _MOST_STEPS :], Step(files)]
            self._undone.clear()
        return list(files)

    def undo(self) -> list[str]:
        """Undo the last edit, if there is one.

        Returns:
            The paths of the written files; empty if there is no edit to undo.

        Raises:
            EditRefusedError: see `apply`.
        """
        if not self._done:
            return []
        step = self._done[-1]
        _write(
            {path: old for path, (old, _) in step.files.items()}, {path: new for path, (_, new) in step.files.items()}
        )
        self._undone.append(self._done.pop())
        return list(step.files)

    def redo(self) -> list[str]:
        """Redo the last undone edit, and return the paths of the written files."""
        if not self._undone:
            return []
        step = self._undone[-1]
        _write(
            {path: new for path, (_, new) in step.files.items()}, {path: old for path, (old, _) in step.files.items()}
        )
        self._done.append(self._undone.pop())
        return list(step.files)


def _workspace_of(file: Path) -> Path:
    found = file.parent
    for folder in file.parents:
        if (folder / "package.xml").is_file() or (folder / ".git").exists():
            found = folder
        if folder.name == "src" and folder.parent != folder.parent.parent:
            found = folder.parent
    return found


def _write(new: Mapping[str, bytes], known: Mapping[str, bytes]) -> None:
    """Write files if their content is still as expected.

    If a file cannot be written, the files written before it are restored.
    """
    for path, content in known.items():
        if _bytes_of(path) != content:
            raise EditRefusedError(changed_file(path))
    written: list[str] = []
    for path, content in new.items():
        try:
            write_whole_file(path, content)
        except OSError as error:
            for path in written:
                write_whole_file(path, known[path])
            message = phrase(
                "cannot write '{path}': {reason}", path=display_path(path), reason=foreign(error.strerror or error)
            )
            raise EditRefusedError(Diagnostic("EDIT108", message, hint=phrase("make the file writable"))) from None
        written.append(path)


def _bytes_of(path: str) -> bytes:
    try:
        return read_bytes(path)
    except LinkwrightError as error:
        raise EditRefusedError(error.diagnostics[0]) from None
