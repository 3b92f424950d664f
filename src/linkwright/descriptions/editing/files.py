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
from linkwright.xmltree.decoding import decode_with_encoding
from linkwright.xmltree.reader import read_bytes

_PROGRAM_FOLDER = Path(__file__).resolve().parents[2]
"""The folder of the program, in which edits must not write files."""
_MAX_UNDO_STEPS = 200
"""The maximum number of edits that can be undone."""


class Workspace:
    """The files that edits may write: files of the workspace that are not installed.

    The workspace is the largest of three folders that contain the main file: the folder of its package, the folder of
    its git repository, and the folder whose ``src`` contains the file.

    Args:
        main: the file that was opened.
        folder: the folder of the workspace; None to find it from the file.
    """

    def __init__(self, main: Path, folder: Path | None = None) -> None:
        self.folder = _find_workspace(Path(os.path.realpath(main))) if folder is None else folder.resolve()

    def refusal(self, path: str) -> Diagnostic | None:
        """Return the reason why a file must not be written (EDIT106), or None if it may be written.

        Args:
            path: the real path of the file.
        """
        file = Path(path)
        if file.is_relative_to(_PROGRAM_FOLDER):
            return forbidden_file(path, phrase("it is part of this program"))
        if any((parent / "share" / "ament_index").is_dir() for parent in file.parents):
            return forbidden_file(path, phrase("it is installed, and the next build would undo the change"))
        if not file.is_relative_to(self.folder):
            reason = phrase("it is outside the workspace '{folder}'", folder=str(self.folder))
            return forbidden_file(path, reason)
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
        self._undo_steps: list[Step] = []
        self._redo_steps: list[Step] = []

    @property
    def can_undo(self) -> bool:
        """Whether there is an edit to undo."""
        return bool(self._undo_steps)

    @property
    def can_redo(self) -> bool:
        """Whether there is an edit to redo."""
        return bool(self._redo_steps)

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
            old_bytes = _read_file(path)
            current = decode_with_encoding(old_bytes, path)
            if current.text != plan.old_texts[path]:
                raise EditRefusedError(changed_file(path))
            byte_order_mark = old_bytes[: len(old_bytes) - len(current.text.encode(current.encoding))]
            files[path] = old_bytes, byte_order_mark + text.encode(current.encoding, "xmlcharrefreplace")
        _write({path: after for path, (_, after) in files.items()}, {path: old for path, (old, _) in files.items()})
        if files:
            self._undo_steps = [*self._undo_steps[1 - _MAX_UNDO_STEPS :], Step(files)]
            self._redo_steps.clear()
        return list(files)

    def undo(self) -> list[str]:
        """Undo the last edit, if there is one.

        Returns:
            The paths of the written files; empty if there is no edit to undo.

        Raises:
            EditRefusedError: see `apply`.
        """
        if not self._undo_steps:
            return []
        step = self._undo_steps[-1]
        _write(
            {path: old for path, (old, _) in step.files.items()}, {path: new for path, (_, new) in step.files.items()}
        )
        self._redo_steps.append(self._undo_steps.pop())
        return list(step.files)

    def redo(self) -> list[str]:
        """Redo the last undone edit, and return the paths of the written files."""
        if not self._redo_steps:
            return []
        step = self._redo_steps[-1]
        _write(
            {path: new for path, (_, new) in step.files.items()}, {path: old for path, (old, _) in step.files.items()}
        )
        self._undo_steps.append(self._redo_steps.pop())
        return list(step.files)


def _find_workspace(file: Path) -> Path:
    workspace = file.parent
    for folder in file.parents:
        if (folder / "package.xml").is_file() or (folder / ".git").exists():
            workspace = folder
        if folder.name == "src" and folder.parent != folder.parent.parent:
            workspace = folder.parent
    return workspace


def _write(new: Mapping[str, bytes], expected: Mapping[str, bytes]) -> None:
    """Write files if their content is still as expected.

    If a file cannot be written, the files written before it are restored.
    """
    for path, content in expected.items():
        if _read_file(path) != content:
            raise EditRefusedError(changed_file(path))
    written_paths: list[str] = []
    for path, content in new.items():
        try:
            write_whole_file(path, content)
        except OSError as error:
            for path in written_paths:
                write_whole_file(path, expected[path])
            message = phrase(
                "cannot write '{path}': {reason}", path=display_path(path), reason=foreign(error.strerror or error)
            )
            raise EditRefusedError(Diagnostic("EDIT108", message, hint=phrase("make the file writable"))) from None
        written_paths.append(path)


def _read_file(path: str) -> bytes:
    try:
        return read_bytes(path)
    except LinkwrightError as error:
        raise EditRefusedError(error.diagnostics[0]) from None
