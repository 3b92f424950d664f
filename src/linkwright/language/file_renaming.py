"""The edits that keep references to a file valid when the file is renamed or moved."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from linkwright.diagnostics import LinkwrightError
from linkwright.language.format import Document
from linkwright.language.formats import format_of
from linkwright.language.includes import real_path
from linkwright.language.links import FileReference, file_references
from linkwright.language.mentions import Mention
from linkwright.language.proof import Edit
from linkwright.language.values import evaluate_file
from linkwright.language.workspace import Workspace
from linkwright.lint.targets import XML_SUFFIXES
from linkwright.packages.share_layout import find_source

_OTHER_FILES = (".py", ".yaml", ".yml", ".rviz", "CMakeLists.txt")
_BUILD_FILES = ("CMakeLists.txt", "setup.py")
_SHARE_PATH = re.compile(
    r"(?:package://|model://|\$\((?:find|find-pkg-share)\s+)(?P<package>[\w-]+)(?:\s*\))?/(?P<path>[\w./-]+)"
)
_WORD = re.compile(r"(?<![\w./$-])[\w.-]+(?:/[\w.-]+)*")
_MAX_TEXT_LENGTH = 1_000_000
"""The maximum length in characters. Longer files are data, not configuration."""


class FileRenaming(NamedTuple):
    """The edits for a renamed file.

    Attributes:
        edits: the edits of references that certainly mean the file.
        unchanged: occurrences of the file name that may mean the file, and stay unchanged.
    """

    edits: tuple[Edit, ...]
    unchanged: tuple[Mention, ...]


def rename_file(workspace: Workspace, texts: Mapping[Path, str], old: Path, new: Path) -> FileRenaming:
    """Return the edits of the files that refer to a renamed file.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        old: the present path of the file.
        new: its path after the renaming.
    """
    edits: list[Edit] = []
    unchanged: list[Mention] = []
    for file in dict.fromkeys((*workspace.index.files, *workspace.files((*XML_SUFFIXES, ".xml", *_OTHER_FILES)))):
        text = workspace.text(file, texts)
        if text is None or len(text) > _MAX_TEXT_LENGTH or old.name not in text or not workspace.contains(file):
            continue
        certain = _reference_edits(workspace, texts, file, text, old, new)
        edits += certain
        mentions = re.finditer(rf"(?<![\w.-]){re.escape(old.name)}(?![\w-])", text)
        starts = (mention.start() for mention in mentions)
        unchanged += [
            Mention(old.name, file, start)
            for start in starts
            if not any(edit.start <= start < edit.end for edit in certain)
        ]
    return FileRenaming(tuple(sorted(edits)), tuple(unchanged))


def _reference_edits(
    workspace: Workspace, texts: Mapping[Path, str], file: Path, text: str, old: Path, new: Path
) -> list[Edit]:
    """Return the edits of the references to the old file in a text."""
    edits: dict[int, Edit] = {}
    for link in (*_format_references(workspace, texts, file, text), *_path_references(workspace, file, text)):
        if real_path(link.file) == old:
            edit = _reference_edit(file, text, link.start, link.end, old, new)
            if edit is not None:
                edits[edit.end] = edit
    return [*edits.values()]


def _format_references(
    workspace: Workspace, texts: Mapping[Path, str], file: Path, text: str
) -> Iterator[FileReference]:
    """Yield the references in a file that its format defines."""
    format_ = format_of(file)
    if format_ is not None:
        yield from format_.links(Document(workspace, texts, file, text))
    if file.name.endswith((*XML_SUFFIXES, ".xml")):
        try:
            values = evaluate_file(workspace, texts, file)
        except LinkwrightError:
            values = []
        yield from file_references(text, file, workspace.finder(file), values)


def _path_references(workspace: Workspace, file: Path, text: str) -> Iterator[FileReference]:
    """Yield the references into share folders, and the paths in build files."""
    for match in _SHARE_PATH.finditer(text):
        share = workspace.finder(file).find(match["package"])
        if share is not None:
            yield FileReference(match.start("path"), match.end("path"), Path(find_source(str(share / match["path"]))))
    if file.name in _BUILD_FILES:
        for match in _WORD.finditer(text):
            path = file.parent / match[0]
            if "/" in match[0] or path.is_file():
                yield FileReference(*match.span(), path)


def _reference_edit(file: Path, text: str, start: int, end: int, old: Path, new: Path) -> Edit | None:
    """Return the edit of a reference to a renamed file, or None if it cannot be edited.

    The edit replaces the last components, which the reference shares with the old path. The new path must be below the
    folder that contains them.
    """
    reference = PurePosixPath(text[start:end])
    count = 0
    for name, part in zip(reversed(reference.parts), reversed(old.parts), strict=False):
        if name != part:
            break
        count += 1
    folder = Path(*old.parts[: len(old.parts) - count])
    if not count or not new.is_relative_to(folder):
        return None
    tail = "/".join(reference.parts[-count:])
    if not text[start:end].endswith(tail):
        return None
    return Edit(file, end - len(tail), end, new.relative_to(folder).as_posix())
