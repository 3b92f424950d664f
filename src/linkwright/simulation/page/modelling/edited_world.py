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
from linkwright.xmltree.decoding import UTF_8, decoded
from linkwright.xmltree.reader import read_bytes

_XACRO = ".xacro"
_NAMELESS = "world.sdf"
_LONGEST_STEM = 56
"""Characters, of which a file system may count four bytes each."""
_MOST_UNDO_STEPS = 200
"""The largest number of undo steps."""
_PROGRAM_FOLDER = Path(__file__).parents[3]
"""The folder of the program's own files, which users cannot overwrite."""


class EditedWorld:
    """A world that is being edited.

    Args:
        text: the text of the world.
        path: the file from whose folder relative addresses are resolved; it need not exist.
        packages: the package finder, which also locates models.
        content: the content of `path` if the world is saved there; None for a world without a file.

    Attributes:
        world: the current world.
        path: the file from whose folder relative addresses are resolved.

    Raises:
        LinkwrightError: the text is not XML.
        EditError: the text does not contain a world.
    """

    def __init__(self, text: str, path: Path, packages: PackageFinder, content: bytes | None = None) -> None:
        self.path = path
        self.world = WorldText(text, path, ResourceFinder(packages))
        self._before: list[str] = []
        self._after: list[str] = []
        self._content = content
        self._saved = text
        self._encoding, self._mark = UTF_8, b""
        if content is not None:
            self._encoding = decoded(content, str(path)).encoding
            self._mark = content[: len(content) - len(text.encode(self._encoding))]

    @classmethod
    def of_file(cls, path: Path, packages: PackageFinder) -> EditedWorld:
        """Return the world in a file.

        A world that xacro generates, and a world that is part of the program, have no file to save to.

        Raises:
            LinkwrightError: the file cannot be read or expanded.
            EditError: the file does not contain a world.
        """
        if path.suffix == _XACRO:
            from linkwright.xacro import expand
            from linkwright.xmltree import write

            return cls(write(expand(str(path), packages=packages).document), path.with_suffix(""), packages)
        content = read_bytes(path)
        text = decoded(content, str(path)).text
        return cls(text, path, packages, None if path.resolve().is_relative_to(_PROGRAM_FOLDER) else content)

    @classmethod
    def of_text(cls, text: str, packages: PackageFinder) -> EditedWorld:
        """Return a world without a file, such as the world of a simulator on another machine.

        Raises:
            LinkwrightError: the text is not XML.
            EditError: the text does not contain a world.
        """
        return cls(text, Path.cwd() / _NAMELESS, packages)

    @property
    def file(self) -> Path | None:
        """The file to which the world is saved; None if the user has to name one."""
        return None if self._content is None else self.path

    @property
    def unsaved(self) -> bool:
        """Whether the text differs from the file."""
        return self.world.text != self._saved

    @property
    def can_undo(self) -> bool:
        """Whether there is an edit to undo."""
        return bool(self._before)

    @property
    def can_redo(self) -> bool:
        """Whether there is an edit to redo."""
        return bool(self._after)

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
            return False  # The text here is then the only readable copy.

    def reserve(self, names: Iterable[str]) -> None:
        """Prevent new models and lights from taking these names.

        Names that the world already uses are not reserved.
        """
        world = self.world
        self.world = WorldText(world.text, world.path, world.finder, frozenset(names) - world.entities.keys())

    def edit(self, change: Callable[[WorldText], WorldText]) -> None:
        """Apply a change to the world as one undo step.

        Raises:
            EditError: the change is not possible.
        """
        changed = change(self.world)
        if changed.text != self.world.text:
            self._before = [*self._before[1 - _MOST_UNDO_STEPS :], self.world.text]
            self._after.clear()
            self.world = changed

    def undo(self) -> None:
        """Undo the last edit, if there is one."""
        if self._before:
            self._after.append(self.world.text)
            self.world = self.world.with_text(self._before.pop())

    def redo(self) -> None:
        """Repeat the edit that was undone last, if there is one."""
        if self._after:
            self._before.append(self.world.text)
            self.world = self.world.with_text(self._after.pop())

    def save(self, name: str | None) -> None:
        """Save the world.

        Args:
            name: another file: absolute, relative to ``~``, or relative to the world's folder; None for the world's own
                file.

        Raises:
            EditError: the world was not saved; the message gives the reason.
        """
        target = self.path if name is None else self._named(name)
        if target == self.path and self._content is not None:
            if self.is_outdated:
                raise EditError(
                    phrase("'{path}' was changed by another program: save the world as another file", path=str(target))
                )
        elif name is None:
            raise EditError(phrase("this world has no file yet: name the file to save it to"))
        elif os.path.lexists(target):
            raise EditError(phrase("the file '{path}' already exists", path=str(target)))
        content = self._encoded
        try:
            write_whole_file(target, content)
        except OSError as error:
            raise EditError(_not_written(target, error)) from None
        self._content, self._saved = content, self.world.text
        if target != self.path:
            self.path = target
            self.world = WorldText(self.world.text, target, self.world.finder, self.world.reserved)

    def store_unsaved(self, folder: Path) -> Diagnostic:
        """Write the unsaved text to a recovery file in a folder, replacing earlier texts of the world.

        Returns:
            The finding that names the file (RVIZ301), or that reports the loss of the text (RVIZ104).
        """
        mark = hashlib.sha256(os.fsencode(self.path)).hexdigest()[:8]  # distinguishes files of the same name
        file = folder / f"{self.path.stem[:_LONGEST_STEM]}-{mark}{self.path.suffix}"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            write_whole_file(file, self._encoded)
        except OSError as error:
            return Diagnostic("RVIZ104", _not_written(file, error))
        message = phrase("unsaved changes of the world '{path}' are stored in '{kept}'", path=self.path, kept=file)
        return Diagnostic("RVIZ301", message, severity=Severity.WARNING)

    @property
    def _encoded(self) -> bytes:
        return self._mark + self.world.text.encode(self._encoding, "xmlcharrefreplace")

    def _named(self, name: str) -> Path:
        """Return the absolute path of a file name that the user entered.

        Raises:
            EditError: the name is not a valid name of a world file.
        """
        try:
            path = Path(os.path.normpath(self.path.absolute().parent / Path(name.strip()).expanduser()))
        except (ValueError, RuntimeError):  # RuntimeError: the user after ``~`` does not exist.
            path = Path()
        if "\0" in name or not is_world(path.name) or path.suffix == _XACRO:
            raise EditError(phrase("'{name}' is not a name for a world: it must end in .world or .sdf", name=name))
        return path


def _not_written(path: Path, error: OSError) -> Phrase:
    return phrase("cannot write '{path}': {reason}", path=str(path), reason=foreign(error.strerror or error))
