"""The search for files that changed files can affect, by the names of files in texts.

A description can include a file under a name that only its expansion knows. Therefore, the search looks for the names
of files in the texts of a version, without expanding anything, and follows a name with a computed part to all files
that fit the rest. It may find files that the change does not affect; comparing these finds no difference.
"""

from __future__ import annotations

import os
import re
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator
from functools import cached_property
from pathlib import Path

from linkwright.packages.manifest import SKIPPED_FOLDERS

_TEXT_SUFFIXES = (
    ".xacro", ".urdf", ".sdf", ".world", ".srdf", ".xml", ".launch", ".py", ".yaml", ".yml", ".config", ".json",
    ".toml", ".dae", ".obj", ".mtl", ".gltf", ".inc", ".macro", ".gazebo", ".trans", ".rviz",
)  # fmt: skip
"""The ends of the names of files that can name other files."""
_MAX_TEXT_BYTES = 1 << 20
"""Larger files are meshes or data, which name few files near their beginning."""
_EXPRESSION = re.compile(r"\$\{[^{}]*\}|\$\([^()]*\)|%[sd]|\{[\w.\[\]'\"]*\}")
_NAME = re.compile(r"[\w.+*-]*\.(?:[A-Za-z]\w*)|model://([\w.+-]+)")
_MIN_FIXED_CHARACTERS = 3
"""The number of fixed characters besides the suffix that a computed name must have to be followed."""


class TextFiles:
    """The files of a version that can name other files.

    Args:
        root: the folder with the files of the version.
    """

    def __init__(self, root: Path) -> None:
        self._root = root

    def affected(self, changed: Iterable[str], candidates: Collection[str]) -> set[str]:
        """Return the candidates that changed files can affect, with the candidates that changed themselves.

        Args:
            changed: the paths of changed files, also of removed ones, relative to the root.
            candidates: paths relative to the root.
        """
        pending = list(changed)
        found = set(pending)
        while pending:
            path = pending.pop()
            for other in self._naming(path):
                if other not in found:
                    found.add(other)
                    pending.append(other)
        return found & set(candidates)

    def _naming(self, path: str) -> Iterator[str]:
        """Yield the files whose texts can name a file."""
        name = Path(path).name
        yield from self._files_by_name.get(name, ())
        if name in ("model.config", "model.sdf"):
            yield from self._files_by_name.get(Path(path).parent.name, ())
        for pattern, files in self._files_by_pattern:
            if pattern.fullmatch(name):
                yield from files

    @cached_property
    def _names(self) -> tuple[dict[str, list[str]], dict[str, list[str]]]:
        """The files that contain a name, and the files that contain a pattern of names, by name and by pattern."""
        by_name: dict[str, list[str]] = defaultdict(list)
        by_pattern: dict[str, list[str]] = defaultdict(list)
        for path, text in self._texts():
            for name in set(_file_names(text)):
                (by_pattern if "*" in name else by_name)[name].append(path)
        return by_name, by_pattern

    @property
    def _files_by_name(self) -> dict[str, list[str]]:
        return self._names[0]

    @cached_property
    def _files_by_pattern(self) -> list[tuple[re.Pattern[str], list[str]]]:
        return [
            (re.compile(".*".join(map(re.escape, pattern.split("*")))), files)
            for pattern, files in self._names[1].items()
        ]

    def _texts(self) -> Iterator[tuple[str, str]]:
        """Yield the path and the text of each file."""
        for folder, folders, names in os.walk(self._root):
            folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in SKIPPED_FOLDERS)
            for name in sorted(names):
                file = Path(folder, name)
                if name.endswith(_TEXT_SUFFIXES) and file.is_file() and not file.is_symlink():
                    with file.open("rb") as stream:
                        text = stream.read(_MAX_TEXT_BYTES).decode("utf-8", errors="replace")
                    yield file.relative_to(self._root).as_posix(), text


def _file_names(text: str) -> Iterator[str]:
    """Yield the names of files in a text, with ``*`` for each computed part, and the names of models of SDF."""
    for match in _NAME.finditer(_EXPRESSION.sub("*", text)):
        if match[1]:
            yield match[1]
            continue
        name = match[0]
        fixed = name.rpartition(".")[0].replace("*", "")
        if "*" not in name or len(fixed) >= _MIN_FIXED_CHARACTERS:
            yield name
        else:
            yield f"*.{name.rpartition('.')[2].replace('*', '')}"
