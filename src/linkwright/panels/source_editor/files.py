"""The source files that a page edits: access, and texts with the line end LF."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path

from linkwright.descriptions.editing import EditPlan, EditRefusedError, Workspace
from linkwright.descriptions.unsaved import with_lf_line_ends
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.reader import read_bytes

MAX_BYTES = 400_000
"""The maximum size of an edited file in bytes, because pages send a text as one message."""

_MAX_NAMES = 2000
"""The maximum number of names that are listed for a folder."""

_GENERATED = frozenset({"build", "install", "log", "node_modules", "__pycache__"})
"""Names of folders whose files are generated."""

_BINARY = re.compile(
    r"7z|bag|bin|blend|bmp|bz2|db3|dll|exe|gif|glb|gz|jpe?g|mcap|mp4|np[yz]|o|onnx|pcd|pdf|png|ply|pt|py[cd]|so|"
    r"stl|tar|tga|tiff?|ttf|wav|webp|whl|woff2?|xz|zip",
    re.IGNORECASE,
)
"""The suffixes of files that are not text."""
_LINE_END = re.compile(r"\r\n?|\n")


@dataclass(frozen=True, slots=True)
class FileContent:
    """The content of a file on the disk.

    Attributes:
        text: the text with the file's line ends; None if the file cannot be read.
        refusal_reason: the reason why the file cannot be read or must not be written; empty if it may be edited.
        is_new: whether the file does not exist and can be created.
    """

    text: str | None
    refusal_reason: str = ""
    is_new: bool = False

    @property
    def page_text(self) -> str | None:
        """The text with the line end LF, or None if the file cannot be read."""
        return None if self.text is None else with_lf_line_ends(self.text)


class SourceFiles:
    """The files of a workspace, for an editor.

    The editor may read the files of the workspace, of any package and of the shown descriptions, except hidden files.
    It may write the files that edits of the robot may write.

    Args:
        workspace: the workspace.
        description_files: the files of the shown descriptions.

    Attributes:
        known: the files of the shown descriptions.
    """

    def __init__(self, workspace: Workspace, description_files: frozenset[str] = frozenset()) -> None:
        self.known = description_files
        self._workspace = workspace

    @property
    def folder(self) -> Path:
        """The folder of the workspace."""
        return self._workspace.folder

    def read(self, path: Path) -> FileContent:
        """Return the content of a file."""
        reason = self._find_reading_refusal(path)
        if reason is not None:
            return FileContent(None, reason)
        try:
            data = read_bytes(path)
            text = decode(data, str(path))
        except LinkwrightError as error:
            is_new = not os.path.lexists(path) and self._find_creating_refusal(Path(os.path.realpath(path))) is None
            return FileContent(None, error.diagnostics[0].message, is_new)
        if len(data) > MAX_BYTES:
            return FileContent(text, _make_too_long_error(path))
        refusal = self._workspace.refusal(os.path.realpath(path))
        return FileContent(text, "" if refusal is None else refusal.message)

    def plan(self, path: Path, previous_text: str, text: str) -> EditPlan:
        """Return the edit that writes a new text to a file.

        Args:
            path: the file.
            previous_text: the text of the file, with its line ends.
            text: the new text, with the line end LF.

        Raises:
            EditRefusedError: the file must not be written.
        """
        real_path = os.path.realpath(path)
        reason = self._find_reading_refusal(path)
        refusal = Diagnostic("EDIT106", reason) if reason is not None else self._workspace.refusal(real_path)
        if refusal is not None:
            raise EditRefusedError(refusal)
        return EditPlan({real_path: with_line_ends(text, previous_text)}, {real_path: previous_text})

    def create(self, path: Path, text: str = "") -> None:
        """Create a file in the workspace, with the folders above it.

        Raises:
            EditRefusedError: the file exists or is outside the workspace, or it cannot be created.
        """
        real_path = Path(os.path.realpath(path))
        refusal = self._find_creating_refusal(real_path)
        if refusal is not None:
            raise EditRefusedError(refusal)
        try:
            real_path.parent.mkdir(parents=True, exist_ok=True)
            real_path.open("x").close()
            if text:
                write_whole_file(real_path, text)
        except FileExistsError:
            message = phrase("'{path}' already exists", path=display_path(real_path))
            raise EditRefusedError(Diagnostic("EDIT108", message)) from None
        except OSError as error:
            reason = foreign(error.strerror or error)
            message = phrase("cannot write '{path}': {reason}", path=display_path(real_path), reason=reason)
            raise EditRefusedError(Diagnostic("EDIT108", message)) from None

    def list_names(self, folder: Path) -> tuple[list[str], list[str]]:
        """Return the sorted names of the subfolders and text files in a folder of the workspace.

        Hidden and generated folders are omitted, and so are files with the suffix of a binary format.
        """
        real_path = Path(os.path.realpath(folder))
        if not real_path.is_relative_to(self.folder) or _is_hidden(real_path, self.folder):
            return [], []
        try:
            entries = [entry for entry in os.scandir(real_path) if not entry.name.startswith(".")]
        except OSError:
            return [], []
        folders = [entry.name for entry in entries if entry.is_dir() and entry.name not in _GENERATED]
        files = [
            entry.name for entry in entries if entry.is_file() and not _BINARY.fullmatch(entry.name.rpartition(".")[2])
        ]
        return sorted(folders, key=str.lower)[:_MAX_NAMES], sorted(files, key=str.lower)[:_MAX_NAMES]

    def _find_creating_refusal(self, real_path: Path) -> Diagnostic | None:
        """Return the reason why a file must not be created, or None."""
        if not real_path.is_relative_to(self.folder) or _is_hidden(real_path, self.folder):
            reason = phrase("new files can only be created in '{folder}'", folder=str(self.folder))
            return Diagnostic("EDIT106", reason)
        existing = next(folder for folder in real_path.parents if folder.is_dir())
        return self._workspace.refusal(str(existing))

    def _find_reading_refusal(self, path: Path) -> Phrase | None:
        """Return the reason why a file must not be read, or None."""
        real_path = Path(os.path.realpath(path))
        if str(path) in self.known:
            return None
        packages = (folder for folder in real_path.parents if (folder / "package.xml").is_file())
        if any(
            real_path.is_relative_to(folder) and not _is_hidden(real_path, folder)
            for folder in (self.folder, *packages)
        ):
            return None
        name, folder = display_path(path), str(self.folder)
        return phrase("'{path}' is outside the workspace '{folder}'", path=name, folder=folder)


def _make_too_long_error(path: Path) -> Phrase:
    return phrase(
        "'{path}' is longer than {count} bytes, so it is not edited", path=display_path(path), count=MAX_BYTES
    )


def _is_hidden(path: Path, folder: Path) -> bool:
    """Return whether a path has a hidden name below a folder that contains it."""
    return any(part.startswith(".") for part in path.relative_to(folder).parts)


def with_line_ends(text: str, previous_text: str) -> str:
    """Return a text with the line ends of the file's previous text.

    Lines before and after the changed lines keep their line ends. The changed lines get the most frequent line end.

    Args:
        text: the new text, with the line end LF.
        previous_text: the previous text, with the file's line ends.
    """
    ends = _LINE_END.findall(previous_text)
    if not any(end != "\n" for end in ends):
        return text
    common_end = max(set(ends), key=ends.count)
    old, new = _LINE_END.split(previous_text), text.split("\n")
    first = len(list(takewhile(lambda pair: pair[0] == pair[1], zip(old, new, strict=False))))
    same_end = zip(reversed(old[first:]), reversed(new[first:]), strict=False)
    last = len(list(takewhile(lambda pair: pair[0] == pair[1], same_end)))
    count = len(new) - 1
    kept_after = max(0, last - 1)
    kept_before = min(first, len(ends) - kept_after, count - kept_after)
    new_ends = ends[:kept_before] + [common_end] * (count - kept_before - kept_after) + ends[len(ends) - kept_after :]
    return "".join(line + end for line, end in zip(new, [*new_ends, ""], strict=True))
