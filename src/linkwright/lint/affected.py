"""Find the files that a change can affect, by the file names in their texts.

A description can include a file under a name that only its expansion knows. Therefore, the search looks for the names
of files in the texts of a version, without expanding anything, and follows a name with a computed part to all files
that fit the rest. The result may include files that the change does not affect; a comparison of such files finds no
difference.
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
"""The endings of the files that can name other files."""
_MESH_SUFFIXES = (".dae", ".obj", ".gltf")
_MAX_TEXT_BYTES, _MAX_MESH_BYTES = 1 << 20, 1 << 16
"""The number of bytes that are searched for names. Meshes name their textures near their beginning."""
_COMPUTED_PART = re.compile(r"\$\{[^{}]*\}|\$\([^()]*\)|%[sd]|\{[\w.\[\]'\"]*\}")
_WORD = re.compile(r"model://[\w.+-]+|[\w.+*-]+")
_MODEL_SCHEME = "model://"
_MODEL_CONFIG = "model.config"
"""The file of a model folder that names only files of this folder."""
_MIN_FIXED_CHARACTERS = 3
"""The number of fixed characters besides the suffix that a computed name must have to be followed."""
_BUILD_FILES = frozenset({"package.xml", "CMakeLists.txt", "setup.py", "setup.cfg", "pyproject.toml"})
"""The names of build files, which no description reads."""
_OTHER_SUFFIXES = (".md", ".rst", ".cpp", ".hpp", ".cc", ".h", ".msg", ".srv", ".action", ".repos", ".sh")
"""The endings of other files that no description reads."""


def may_be_read(path: str) -> bool:
    """Return whether a description, or a file that it includes, may read a file."""
    return Path(path).name not in _BUILD_FILES and not path.endswith(_OTHER_SUFFIXES)


class TextFiles:
    """The files of a version that can name other files.

    Args:
        root: the folder with the files of the version.
        other: another version whose names are used for files that did not change; None to read all files.
        changed: the paths of the files that differ between both versions, relative to the roots.
    """

    def __init__(self, root: Path, other: TextFiles | None = None, changed: Collection[str] = ()) -> None:
        self._root = root
        self._other = other
        self._changed = changed

    def affected(self, changed: Iterable[str], candidates: Collection[str]) -> set[str]:
        """Return the candidates that have changed or can be affected by changed files.

        Args:
            changed: the paths of changed and removed files, relative to the root.
            candidates: paths relative to the root.
        """
        pending = list(changed)
        affected = set(pending)
        while pending:
            path = pending.pop()
            for referrer in self._find_referrers(path):
                if referrer not in affected:
                    affected.add(referrer)
                    pending.append(referrer)
        return affected & set(candidates)

    def _find_referrers(self, path: str) -> Iterator[str]:
        """Yield the paths of the files whose texts can name a file."""
        name = Path(path).name
        for file in self._files_by_name.get(name, ()):
            if Path(file).name != _MODEL_CONFIG or Path(file).parent == Path(path).parent:
                yield file
        if name in (_MODEL_CONFIG, "model.sdf"):
            yield from self._files_by_name.get(Path(path).parent.name, ())
        for pattern, files in self._files_by_pattern:
            if pattern.fullmatch(name):
                yield from files

    @cached_property
    def _names(self) -> tuple[dict[str, list[str]], dict[str, list[str]]]:
        """The files that contain each name, and the files that contain each pattern of names."""
        by_name: dict[str, list[str]] = defaultdict(list)
        by_pattern: dict[str, list[str]] = defaultdict(list)
        for path, names in self._names_by_file.items():
            for name in names:
                (by_pattern if "*" in name else by_name)[name].append(path)
        return by_name, by_pattern

    @cached_property
    def _names_by_file(self) -> dict[str, frozenset[str]]:
        """The names and patterns of names in each file, by path."""
        known = {} if self._other is None else self._other._names_by_file
        names: dict[str, frozenset[str]] = {}
        for path, file in self._walk_files():
            is_known = path in known and path not in self._changed
            names[path] = known[path] if is_known else frozenset(_find_file_names(_read_beginning(file)))
        return names

    @property
    def _files_by_name(self) -> dict[str, list[str]]:
        return self._names[0]

    @cached_property
    def _files_by_pattern(self) -> list[tuple[re.Pattern[str], list[str]]]:
        return [
            (re.compile(".*".join(map(re.escape, pattern.split("*")))), files)
            for pattern, files in self._names[1].items()
        ]

    def _walk_files(self) -> Iterator[tuple[str, Path]]:
        """Yield the relative and the absolute path of each file."""
        for folder, folders, names in os.walk(self._root):
            folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in SKIPPED_FOLDERS)
            for name in sorted(names):
                file = Path(folder, name)
                if name.endswith(_TEXT_SUFFIXES) and file.is_file() and not file.is_symlink():
                    yield file.relative_to(self._root).as_posix(), file


def _read_beginning(file: Path) -> str:
    """Return the beginning of a file."""
    with file.open("rb") as stream:
        size = _MAX_MESH_BYTES if file.name.endswith(_MESH_SUFFIXES) else _MAX_TEXT_BYTES
        return stream.read(size).decode("utf-8", errors="replace")


def _find_file_names(text: str) -> Iterator[str]:
    """Yield the file names and the SDF model names in a text.

    Each computed part is replaced by ``*``.
    """
    for word in set(_WORD.findall(_COMPUTED_PART.sub("*", text))):
        if word.startswith(_MODEL_SCHEME):
            yield word.removeprefix(_MODEL_SCHEME)
            continue
        stem, _, suffix = word.rpartition(".")
        if not suffix[:1].isalpha():
            continue
        is_fixed = "*" not in word or len(stem.replace("*", "")) >= _MIN_FIXED_CHARACTERS
        yield word if is_fixed else f"*.{suffix.replace('*', '')}"
