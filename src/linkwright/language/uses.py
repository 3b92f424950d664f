"""The uses of a name in file formats with their own language features.

A use is an occurrence of the name with the same definition.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from linkwright.language.format import Document, Format, Target
from linkwright.language.formats import format_of
from linkwright.language.includes import real_path
from linkwright.packages import enclosing_package
from linkwright.packages.launch_files import find_launch_files_below, is_launch_file_name
from linkwright.packages.share_layout import find_source

_MAX_FILES = 200
_MAX_USES = 300
"""The maximum number of occurrences of a name that are checked in a file."""


def find_uses(document: Document, file_format: Format, offset: int, *, in_file: bool = False) -> list[Target]:
    """Return the definition and the uses of the name at an offset, or an empty list.

    The uses of a launch argument are also searched in the launch files of the package that mention its file.

    Args:
        document: the text.
        file_format: the format of the text.
        offset: the character offset.
        in_file: whether only locations in the text are returned.
    """
    targets: dict[Target, None] = {}
    for target in file_format.define(document, offset):
        name = document.other(target.file)[target.start : target.end] if target.end > target.start else ""
        if not name or document.text.find(name, max(0, offset - len(name)), offset + len(name)) < 0:
            continue
        if not in_file or target.file == document.file:
            targets[target] = None
        for other in [document] if in_file else [*_list_documents(document, target.file)]:
            other_format = format_of(other.file)
            if other_format is not None:
                targets.update(dict.fromkeys(_find_uses_of_target(other, other_format, target, name)))
    return list(targets)


def _list_documents(document: Document, file: Path) -> Iterator[Document]:
    """Yield a document and a file. For a launch file, also yield launch files that mention it.

    These are the launch files in the packages of both.
    """
    others: list[Path] = []
    if is_launch_file_name(file.name) or file.name.endswith(".launch"):
        packages = (enclosing_package(path.parent) for path in (document.file, file))
        folders = dict.fromkeys(package[1] for package in packages if package is not None)
        others = [real_path(find_source(str(path))) for folder in folders for path in find_launch_files_below(folder)]
    for index, path in enumerate(dict.fromkeys((document.file, file, *others))):
        if index < _MAX_FILES:
            text = document.text if path == document.file else document.other(path)
            if path in (document.file, file) or file.name in text:
                yield Document(document.workspace, document.texts, path, text)


def _find_uses_of_target(document: Document, file_format: Format, target: Target, name: str) -> Iterator[Target]:
    places = re.finditer(rf"(?<![\w.-]){re.escape(name)}(?![\w.-])", document.text)
    for _, position in zip(range(_MAX_USES), places, strict=False):
        if target in file_format.define(document, position.start()):
            yield Target(document.file, *position.span())
