"""Which descriptions include a file, found by the names of included files, before anything is expanded."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from linkwright.lint.targets import DESCRIPTIONS, included_names, walk


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
        self._names: dict[Path, tuple[int, frozenset[str]]] = {}
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

    def entries(self, file: Path, texts: Mapping[Path, str]) -> list[Path]:
        """Return the descriptions that include a file, directly or through others; the file itself if none does.

        Args:
            file: the file, as `real` returns it.
            texts: texts that replace those of files.
        """
        includers: dict[str, list[Path]] = {}
        for other in dict.fromkeys((*self.files, *texts)):
            for name in self._included(other, texts):
                includers.setdefault(name, []).append(other)
        found: dict[Path, None] = {}
        seen, pending = {file}, [file]
        while pending:
            current = pending.pop()
            above = [other for other in includers.get(current.name, ()) if other != current]
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
        included = {name for file in files for name in self._included(file, texts) if name != file.name}
        return [file for file in files if file.name not in included]

    def related(self, file: Path, texts: Mapping[Path, str]) -> list[Path]:
        """Return a file, the descriptions that include it, and all files that these include, found by their names."""
        by_name: dict[str, list[Path]] = {}
        for other in dict.fromkeys((*self.files, *texts)):
            by_name.setdefault(other.name, []).append(other)
        found: dict[Path, None] = {}
        pending = [file, *self.entries(file, texts)]
        while pending:
            current = pending.pop()
            if current not in found:
                found[current] = None
                pending += [other for name in self._included(current, texts) for other in by_name.get(name, ())]
        return list(found)

    def _included(self, file: Path, texts: Mapping[Path, str]) -> frozenset[str]:
        text = texts.get(file)
        if text is not None:
            return frozenset(included_names(text))
        try:
            changed_ns = file.stat().st_mtime_ns
            known = self._names.get(file)
            if known is None or known[0] != changed_ns:
                names = frozenset(included_names(file.read_text(encoding="utf-8", errors="replace")))
                known = self._names[file] = (changed_ns, names)
        except OSError:
            return frozenset()
        return known[1]


def real(path: str | os.PathLike[str]) -> Path:
    """Return the path of a file without links: one name for a file, however it is reached."""
    return Path(os.path.realpath(path))
