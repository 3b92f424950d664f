"""Which descriptions include a file, found by the names of included files, before anything is expanded."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from linkwright.lint.targets import DESCRIPTIONS, walk, written_includes
from linkwright.loading.deferred import lazy_pattern
from linkwright.packages import enclosing_package

_SHARE = lazy_pattern(r"\$\(find\s+([\w.-]+)\s*\)/")
_COMPUTED = lazy_pattern(r"\$\{[^{}]*\}|\$\([^()]*\)")


class Include(NamedTuple):
    """The path of an included file.

    Attributes:
        written: the path as written.
        path: the path with the default values of arguments.
    """

    written: str
    path: str

    @property
    def name(self) -> str:
        """The name of the file without its folder, which may contain expressions."""
        return Path(self.path).name

    def may_mean(self, file: Path, includer: Path) -> bool:
        """Return whether the path may lead to a file of that name, as far as the folders of the path tell.

        Args:
            file: the file.
            includer: the file that includes it.
        """
        share = _SHARE.match(self.path)
        tail = self.path if share is None else self.path[share.end() :]
        if "$" in tail:
            return True
        if share is not None:
            package = _package_of(file.parent)
            return package in (None, share[1]) and str(file).endswith(f"/{os.path.normpath(tail)}")
        target = real(includer.parent / tail)
        return target == file or not target.is_file()

    @property
    def pattern(self) -> str | None:
        """A pattern of the paths that a computed path may have; None for one that is not computed."""
        share = _SHARE.match(self.written)
        tail = self.written if share is None else self.written[share.end() :]
        if "$" not in tail:
            return None
        literal = _COMPUTED.split(tail)
        return None if len("".join(literal)) < _SHORTEST else "[^/]*".join(map(re.escape, literal))

    def may_compute(self, file: Path) -> bool:
        """Return whether the path, which is computed, may lead to a file."""
        pattern = self.pattern
        return pattern is not None and re.search(f"(?:^|/){pattern}$", str(file)) is not None


_SHORTEST = len("_.xacro")
"""The number of characters that a computed path must have, so that it does not mean all files."""


@lru_cache(maxsize=500)
def _package_of(folder: Path) -> str | None:
    package = enclosing_package(folder)
    return None if package is None else package[0]


class IncludeIndex:
    """The descriptions and packages below some folders, and the names of the files that each description includes.

    A file is read again only when it has changed.

    Args:
        folders: the folders.

    Attributes:
        files: the descriptions, and the files with parts of them.
        packages: the folders of the packages.
    """

    def __init__(self, folders: Iterable[Path]) -> None:
        self._folders = [*folders]
        self._names: dict[Path, tuple[int, frozenset[Include]]] = {}
        self.files: tuple[Path, ...] = ()
        self.packages: tuple[Path, ...] = ()

    def refresh(self) -> None:
        """Search the folders again for descriptions and packages."""
        files: dict[Path, None] = {}
        packages: dict[Path, None] = {}
        for folder in self._folders:
            found, below = walk(folder, DESCRIPTIONS)
            files.update(dict.fromkeys(real(file) for file in found))
            packages.update(dict.fromkeys(below))
        self.files, self.packages = tuple(files), tuple(packages)

    def entries(self, file: Path, texts: Mapping[Path, str], *, computed: bool = False) -> list[Path]:
        """Return the descriptions that include a file, directly or through others; the file itself if none does.

        Args:
            file: the file, as `real` returns it.
            texts: texts that replace those of files.
            computed: whether an include whose path is computed counts for each file that it may mean.
        """
        includers: dict[str, list[tuple[Path, Include]]] = {}
        patterns: list[tuple[Path, Include]] = []
        for other in dict.fromkeys((*self.files, *texts)):
            for include in self._included(other, texts):
                includers.setdefault(include.name, []).append((other, include))
                if computed and include.pattern is not None:
                    patterns.append((other, include))
        found: dict[Path, None] = {}
        seen, pending = {file}, [file]
        while pending:
            current = pending.pop()
            named = [other for other, include in includers.get(current.name, ()) if include.may_mean(current, other)]
            named += [other for other, include in patterns if include.may_compute(current)]
            above = [other for other in dict.fromkeys(named) if other != current]
            if not above:
                found[current] = None
            for other in above:
                if other not in seen:
                    seen.add(other)
                    pending.append(other)
        return list(found) or [file]

    def roots(self, texts: Mapping[Path, str]) -> list[Path]:
        """Return the files that no other file includes, found by their names.

        Args:
            texts: texts that replace those of files.
        """
        files = [*dict.fromkeys((*self.files, *(file for file in texts if file.name.endswith(DESCRIPTIONS))))]
        includes = ((file, include) for file in files for include in self._included(file, texts))
        included = {include.name for file, include in includes if include.name != file.name}
        return [file for file in files if file.name not in included]

    def related(self, file: Path, texts: Mapping[Path, str], *, computed: bool = False) -> list[Path]:
        """Return a file, the descriptions that include it, and all files that these include.

        Args:
            file: the file.
            texts: texts that replace those of files.
            computed: whether an include whose path is computed counts for each file that it may mean.
        """
        by_name: dict[str, list[Path]] = {}
        for other in dict.fromkeys((*self.files, *texts)):
            by_name.setdefault(other.name, []).append(other)
        found: dict[Path, None] = {}
        pending = [file, *self.entries(file, texts, computed=computed)]
        while pending:
            current = pending.pop()
            if current in found:
                continue
            found[current] = None
            for include in self._included(current, texts):
                pending += [other for other in by_name.get(include.name, ()) if include.may_mean(other, current)]
                if computed and include.pattern is not None:
                    pending += [other for other in self.files if include.may_compute(other)]
        return list(found)

    def _included(self, file: Path, texts: Mapping[Path, str]) -> frozenset[Include]:
        text = texts.get(file)
        if text is not None:
            return _includes(text)
        try:
            changed_ns = file.stat().st_mtime_ns
            known = self._names.get(file)
            if known is None or known[0] != changed_ns:
                includes = _includes(file.read_text(encoding="utf-8", errors="replace"))
                known = self._names[file] = (changed_ns, includes)
        except OSError:
            return frozenset()
        return known[1]


def _includes(text: str) -> frozenset[Include]:
    return frozenset(Include(written, path) for written, path in written_includes(text))


def real(path: str | os.PathLike[str]) -> Path:
    """Return the path of a file without links: one name for a file, however it is reached."""
    return Path(os.path.realpath(path))
