"""A world that is being edited: its text, its undo history and its file."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterable
from pathlib import Path

from linkwright.descriptions import is_world
from linkwright.diagnostics import Diagnostic, Phrase, Severity, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.packages import PackageFinder
from linkwright.sdf.editing import EditError, WorldText
from linkwright.sdf.resources import ResourceFinder
from linkwright.xmltree.decoding import UTF_8, decode_with_encoding
from linkwright.xmltree.reader import read_bytes

_XACRO_SUFFIX = ".xacro"
_DEFAULT_NAME = "world.sdf"
_MAX_STEM_LENGTH = 56
"""The maximum length of the file name without suffix, in characters.

File systems limit the length in bytes, and a character may occupy four of them.
"""
_MAX_UNDO_STEPS = 200
"""The maximum number of undo steps. Older steps are dropped."""
_PROGRAM_FOLDER = Path(__file__).parents[3]
"""The folder of the program's own files, which users cannot overwrite."""


class EditedWorld:
    """A world that is being edited.

    Args:
        text: the text of the world as SDF.
        path: the file from whose folder relative addresses are resolved; it need not exist.
        packages: the package finder, which also locates models.
        content: the bytes of the file at `path`, if the world is saved there; None for a world without a file.

    Attributes:
        world: the world after the latest edit.
        path: the file from whose folder relative addresses are resolved.

    Raises:
        LinkwrightError: the text is not XML.
        EditError: the text does not contain a world.
    """

    def __init__(self, text: str, path: Path, packages: PackageFinder, content: bytes | None = None) -> None:
        self.path = path
        self.world = WorldText(text, path, ResourceFinder(packages))
        self._undo_texts: list[str] = []
        self._redo_texts: list[str] = []
        self._content = content
        self._saved_text = text
        self._encoding, self._byte_order_mark = UTF_8, b""
        if content is not None:
            self._encoding = decode_with_encoding(content, str(path)).encoding
            self._byte_order_mark = content[: len(content) - len(text.encode(self._encoding))]

    @classmethod
    def from_file(cls, path: Path, packages: PackageFinder) -> EditedWorld:
        """Create an edited world from a file.

        A world that xacro generates, or that is part of Linkwright, gets no file to save to.

        Raises:
            LinkwrightError: the file cannot be read or expanded.
            EditError: the file does not contain a world.
        """
        if path.suffix == _XACRO_SUFFIX:
            from linkwright.xacro import expand
            from linkwright.xmltree import write

            return cls(write(expand(str(path), packages=packages).document), path.with_suffix(""), packages)
        content = read_bytes(path)
        text = decode_with_encoding(content, str(path)).text
        return cls(text, path, packages, None if path.resolve().is_relative_to(_PROGRAM_FOLDER) else content)

    @classmethod
    def from_text(cls, text: str, packages: PackageFinder) -> EditedWorld:
        """Create a world without a file, such as the world of a simulator on another machine.

        Raises:
            LinkwrightError: the text is not XML.
            EditError: the text does not contain a world.
        """
        return cls(text, Path.cwd() / _DEFAULT_NAME, packages)

    @property
    def file(self) -> Path | None:
        """The file to which the world is saved, or None if the user has to name one."""
        return None if self._content is None else self.path

    @property
    def is_unsaved(self) -> bool:
        """Whether the text has changed since it was read or saved."""
        return self.world.text != self._saved_text

    @property
    def can_undo(self) -> bool:
        """Whether there is an edit to undo."""
        return bool(self._undo_texts)

    @property
    def can_redo(self) -> bool:
        """Whether there is an edit to redo."""
        return bool(self._redo_texts)

    @property
    def is_outdated(self) -> bool:
        """Whether another program has changed the file since the file was read or saved.

        False if the world has no file, or if the file cannot be read.
        """
        if self._content is None:
            return False
        try:
            return self.path.read_bytes() != self._content
        except OSError:
            return False  # If the file cannot be read, the text in memory is the only copy.

    def reserve(self, names: Iterable[str]) -> None:
        """Prevent new models and lights from using these names.

        Names that the world already uses are not reserved.
        """
        world = self.world
        self.world = WorldText(world.text, world.path, world.finder, frozenset(names) - world.entities.keys())

    def edit(self, change: Callable[[WorldText], WorldText]) -> None:
        """Apply a change to the world as one undo step.

        Raises:
            EditError: the change is not possible.
        """
        changed_world = change(self.world)
        if changed_world.text != self.world.text:
            self._undo_texts = [*self._undo_texts[1 - _MAX_UNDO_STEPS :], self.world.text]
            self._redo_texts.clear()
            self.world = changed_world

    def undo(self) -> None:
        """Undo the last edit, if there is one."""
        if self._undo_texts:
            self._redo_texts.append(self.world.text)
            self.world = self.world.with_text(self._undo_texts.pop())

    def redo(self) -> None:
        """Repeat the most recently undone edit, if there is one."""
        if self._redo_texts:
            self._undo_texts.append(self.world.text)
            self.world = self.world.with_text(self._redo_texts.pop())

    def save(self, name: str | None) -> None:
        """Save the world to its file, or to a new file.

        Args:
            name: the path of another file: absolute, in ``~``, or relative to the world's folder; None for the file of
                the world.

        Raises:
            EditError: the world was not saved; the message gives the reason.
        """
        target = self.path if name is None else self._parse_name(name)
        if target == self.path and self._content is not None:
            if self.is_outdated:
                raise EditError(
                    phrase("'{path}' was changed by another program: save the world to another file", path=str(target))
                )
        elif name is None:
            raise EditError(phrase("this world has no file yet: enter the name of a file"))
        elif os.path.lexists(target):
            raise EditError(phrase("the file '{path}' already exists: choose another name", path=str(target)))
        content = self._encoded
        try:
            write_whole_file(target, content)
        except OSError as error:
            raise EditError(_write_error(target, error)) from None
        self._content, self._saved_text = content, self.world.text
        if target != self.path:
            self.path = target
            self.world = WorldText(self.world.text, target, self.world.finder, self.world.reserved)

    def store_unsaved(self, folder: Path) -> Diagnostic:
        """Write the unsaved text to a recovery file in a folder.

        The file replaces earlier recovery files of the world.

        Returns:
            The finding RVIZ301, which names the file, or RVIZ104, which reports that the text is lost.
        """
        path_hash = hashlib.sha256(os.fsencode(self.path)).hexdigest()[:8]  # distinguishes files of the same name
        file = folder / f"{self.path.stem[:_MAX_STEM_LENGTH]}-{path_hash}{self.path.suffix}"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            write_whole_file(file, self._encoded)
        except OSError as error:
            return Diagnostic("RVIZ104", _write_error(file, error))
        message = phrase("unsaved changes to the world '{path}' are stored in '{copy}'", path=self.path, copy=file)
        return Diagnostic("RVIZ301", message, severity=Severity.WARNING)

    @property
    def _encoded(self) -> bytes:
        return self._byte_order_mark + self.world.text.encode(self._encoding, "xmlcharrefreplace")

    def _parse_name(self, name: str) -> Path:
        """Return the absolute path of a file name that the user entered.

        Raises:
            EditError: the name is not valid for a world file.
        """
        try:
            path = Path(os.path.normpath(self.path.absolute().parent / Path(name.strip()).expanduser()))
        except (ValueError, RuntimeError):  # RuntimeError: the user after ``~`` does not exist.
            path = Path()
        if "\0" in name or not is_world(path.name) or path.suffix == _XACRO_SUFFIX:
            raise EditError(
                phrase("'{name}' is not the name of a world file: it must end in .world or .sdf", name=name)
            )
        return path


def _write_error(path: Path, error: OSError) -> Phrase:
    return phrase("cannot write '{path}': {reason}", path=str(path), reason=foreign(error.strerror or error))
