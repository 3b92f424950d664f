"""Functions that an interpreted ``setup.py`` may call to construct paths or list files.

These functions do not open files, do not access anything outside the package, and do not return large results.
"""

from __future__ import annotations

import os
import posixpath
import re
from collections.abc import Callable, Iterable, Iterator
from fnmatch import fnmatchcase
from glob import glob
from itertools import chain
from pathlib import Path, PurePosixPath

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import Any

_MAX_ITEMS = 20_000
_MAX_TEXT_LENGTH = 4096
_WIDE_FORMAT = lazy_pattern(r"\d{3}|\*")

METHODS_BY_TYPE: dict[type, frozenset[str]] = {
    kind: frozenset(names.split())
    for kind, names in {
        str: "startswith endswith replace split rsplit strip lstrip rstrip join lower upper removeprefix removesuffix "
        "partition rpartition splitlines find rfind count index isdigit title",
        list: "append extend insert remove pop sort copy index reverse clear count",
        dict: "items keys values get update setdefault pop copy",
        set: "add update discard union",
        tuple: "index count",
        PurePosixPath: "joinpath relative_to with_suffix with_name as_posix match is_absolute",
    }.items()
}
"""The methods of values that may be called."""

PATH_ATTRIBUTES = frozenset(("name", "stem", "suffix", "suffixes", "parent", "parents", "parts"))
"""The attributes of paths that may be read."""


class NotKnownError(Exception):
    """Raised when the value of an expression is not known."""


def check_size(value: Any) -> Any:
    """Check the size of a value, and return the value.

    Raises:
        NotKnownError: the value is too large.
    """
    if isinstance(value, str) and len(value) > _MAX_TEXT_LENGTH:
        raise NotKnownError
    if isinstance(value, (list, tuple, dict, set)) and len(value) > _MAX_ITEMS:
        raise NotKnownError
    return value


def compute_weight(value: Any, limit: int) -> int:
    """Return the size of a value up to a limit.

    The size includes nested items and, in part, the lengths of texts. A list that contains the same list twice, on many
    levels, is small in memory but takes very long to print or compare.
    """
    count, pending = 0, [value]
    while pending and count <= limit:
        item = pending.pop()
        count += 1
        if isinstance(item, str):
            count += len(item) // 64
        elif isinstance(item, dict):
            count += len(item)
            pending += item.values()
        elif isinstance(item, (list, tuple, set, frozenset)):
            pending += item
    return min(count, limit)


def format_template(template: str, *arguments: Any, **keyword_arguments: Any) -> str:
    """Return ``template.format(...)``.

    Raises:
        NotKnownError: the template may pad texts to a large width, or accesses attributes.
    """
    if _WIDE_FORMAT.search(template) or "." in "".join(re.findall(r"\{[^}]*\}", template)):
        raise NotKnownError
    return template.format(*arguments, **keyword_arguments)


def percent_format(template: str, arguments: Any) -> str:
    """Return ``template % arguments``.

    Raises:
        NotKnownError: the template may pad texts to a large width.
    """
    if _WIDE_FORMAT.search(template):
        raise NotKnownError
    return str(template % arguments)


class PackageLibrary:
    """The functions of ``os``, ``glob`` and ``pathlib``, limited to the folder of a package.

    Args:
        folder: the folder of the package, which is also the working directory.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = Path(os.path.abspath(folder))  # noqa: PTH100 - do not resolve links
        path_functions: dict[str, Callable[..., Any]] = {
            **{
                name: getattr(posixpath, name)
                for name in ("join", "dirname", "basename", "split", "splitext", "normpath")
            },
            **dict.fromkeys(("abspath", "realpath"), self._absolute),
            "relpath": lambda path, start=".": posixpath.relpath(self._absolute(path), self._absolute(start)),
            "isfile": lambda path: self._check_path(path).is_file(),
            "isdir": lambda path: self._check_path(path).is_dir(),
            "exists": lambda path: self._check_path(path).exists(),
        }
        self.functions: dict[str, Callable[..., Any]] = {
            **{f"os.path.{name}": function for name, function in path_functions.items()},
            "os.walk": self._walk,
            "os.listdir": lambda path=".": sorted(entry.name for entry in self._list_folder(path)),
            "os.getcwd": self._folder.as_posix,
            "os.fspath": str,
            "glob.glob": self._glob,
            "glob.iglob": self._glob,
            "fnmatch.fnmatch": lambda name, pattern: fnmatchcase(str(name), str(pattern)),
            "itertools.chain": lambda *parts: list(chain(*parts)),
            "itertools.chain.from_iterable": lambda parts: list(chain.from_iterable(parts)),
            **dict.fromkeys(("pathlib.Path", "pathlib.PurePath"), PurePosixPath),
        }
        self.path_methods: dict[str, Callable[..., Any]] = {
            "is_file": path_functions["isfile"],
            "is_dir": path_functions["isdir"],
            "exists": path_functions["exists"],
            "iterdir": lambda path: sorted(path / entry.name for entry in self._list_folder(path)),
            "glob": self._path_glob,
            "rglob": lambda path, pattern: self._path_glob(path, f"**/{pattern}"),
            **dict.fromkeys(("resolve", "absolute"), lambda path: PurePosixPath(self._absolute(path))),
        }

    def relative(self, path: Any) -> str:
        """Return the path of a file in the package, relative to the package's folder, with slashes.

        Raises:
            NotKnownError: the path is outside the package.
        """
        return self._check_path(path).relative_to(self._folder).as_posix()

    def _absolute(self, path: Any) -> str:
        return posixpath.normpath(posixpath.join(self._folder.as_posix(), str(path)))

    def _check_path(self, path: Any) -> Path:
        if not isinstance(path, (str, PurePosixPath)):
            raise NotKnownError
        absolute_path = Path(self._absolute(path))
        if not absolute_path.is_relative_to(self._folder):
            raise NotKnownError
        return absolute_path

    def _list_folder(self, path: Any) -> Iterable[Path]:
        return check_size(list(self._check_path(path).iterdir()))  # type: ignore[no-any-return]  # what it is given

    def _walk(self, top: Any) -> Iterator[tuple[str, list[str], list[str]]]:
        count = 0
        for root, folders, files in os.walk(self._check_path(top)):
            count += 1 + len(files)
            if count > _MAX_ITEMS:
                raise NotKnownError
            folders.sort()
            relative_root = Path(root).relative_to(self._check_path(top)).as_posix()
            yield str(top) if relative_root == "." else posixpath.join(str(top), relative_root), folders, sorted(files)

    def _glob(self, pattern: Any, recursive: bool = False, **unsupported: Any) -> list[str]:
        text = str(pattern)
        fixed_prefix = re.split(r"[*?\[]", text, maxsplit=1)[0]
        self._check_path(fixed_prefix)
        if unsupported or ".." in text.split("/"):
            raise NotKnownError
        names = glob(text, root_dir=self._folder, recursive=bool(recursive))  # noqa: PTH207 - as in setup.py
        return sorted(check_size([name.replace("\\", "/") for name in names]))

    def _path_glob(self, path: PurePosixPath, pattern: str) -> list[PurePosixPath]:
        if ".." in pattern.split("/") or pattern.startswith("/"):
            raise NotKnownError
        top = self._check_path(path)
        return check_size(sorted(path / entry.relative_to(top).as_posix() for entry in top.glob(pattern)))  # type: ignore[no-any-return]  # what it is given
