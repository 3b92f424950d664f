"""The edits that keep references to a file valid when the file is renamed or moved."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from linkwright.diagnostics import LinkwrightError
from linkwright.language.includes import real
from linkwright.language.links import file_references
from linkwright.language.mentions import Mention
from linkwright.language.proof import Edit
from linkwright.language.values import values_in
from linkwright.language.workspace import Workspace
from linkwright.lint.targets import XML_FILES, walk
from linkwright.packages import enclosing_package

_OTHER_FILES = (".py", ".yaml", ".yml", ".rviz", "CMakeLists.txt")
_MAX_TEXT = 1_000_000
"""Characters; longer files are data and not configuration."""


class FileRenaming(NamedTuple):
    """The edits for a renamed file.

    Attributes:
        edits: the edits of references that certainly mean the file.
        unchanged: texts with the name of the file that may mean it; the edits leave them unchanged.
    """

    edits: tuple[Edit, ...]
    unchanged: tuple[Mention, ...]


def rename_file(project: Workspace, texts: Mapping[Path, str], old: Path, new: Path) -> FileRenaming:
    """Return the edits of the descriptions, worlds and launch files in XML that refer to a file.

    Args:
        project: the workspace.
        texts: the texts of the open files.
        old: the present path of the file.
        new: its path after the renaming.
    """
    edits: list[Edit] = []
    unchanged: list[Mention] = []
    package = enclosing_package(old.parent)
    folders = [package[1]] if package is not None else []
    configurations = [real(path) for folder in folders for path in walk(folder, (*XML_FILES, ".xml", *_OTHER_FILES))[0]]
    for file in dict.fromkeys((*project.index.files, *configurations)):
        text = project.text(file, texts)
        if text is None or len(text) > _MAX_TEXT or old.name not in text or not project.contains(file):
            continue
        certain = _references(project, texts, file, text, old, new) if file.name.endswith((*XML_FILES, ".xml")) else []
        edits += certain
        mentions = re.finditer(rf"(?<![\w.-]){re.escape(old.name)}(?![\w-])", text)
        starts = (mention.start() for mention in mentions)
        unchanged += [
            Mention(old.name, file, start)
            for start in starts
            if not any(edit.start <= start < edit.end for edit in certain)
        ]
    return FileRenaming(tuple(sorted(edits)), tuple(unchanged))


def _references(
    project: Workspace, texts: Mapping[Path, str], file: Path, text: str, old: Path, new: Path
) -> list[Edit]:
    """Return the edits of the references in a text that mean the old file."""
    try:
        values = values_in(project, texts, file)
    except LinkwrightError:
        values = []
    edits = []
    for link in file_references(text, file, project.finder(file), values):
        if real(link.file) == old:
            edit = _edit(file, text, link.start, link.end, old, new)
            if edit is not None:
                edits.append(edit)
    return edits


def _edit(file: Path, text: str, start: int, end: int, old: Path, new: Path) -> Edit | None:
    """Return the edit of the part of a reference that the renaming changes; None if it is computed or leads elsewhere.

    The reference and the old path end with the same names. The new path must be below the same folder.
    """
    written = PurePosixPath(text[start:end])
    count = 0
    for name, part in zip(reversed(written.parts), reversed(old.parts), strict=False):
        if name != part:
            break
        count += 1
    folder = Path(*old.parts[: len(old.parts) - count])
    if not count or not new.is_relative_to(folder):
        return None
    tail = "/".join(written.parts[-count:])
    if not text[start:end].endswith(tail):
        return None
    return Edit(file, end - len(tail), end, new.relative_to(folder).as_posix())
