"""The includes between descriptions, found in their texts without expansion."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from linkwright.lint.inclusions import Inclusion, folders_by_package, inclusions_in
from linkwright.lint.targets import DESCRIPTION_SUFFIXES, find_files_and_packages


class IncludeIndex:
    """The descriptions and packages below some folders, and the includes of each description.

    A file is read again only when it has changed.

    Args:
        folders: the folders to search.

    Attributes:
        files: the descriptions, and the files with parts of them.
        packages: the folders of the packages.
    """

    def __init__(self, folders: Iterable[Path]) -> None:
        self._folders = [*folders]
        self._inclusions: dict[Path, tuple[int, tuple[Inclusion, ...]]] = {}
        self._package_folders: dict[str, list[Path]] = {}
        self.files: tuple[Path, ...] = ()
        self.packages: tuple[Path, ...] = ()

    def refresh(self) -> None:
        """Search the folders again for descriptions and packages."""
        files: dict[Path, None] = {}
        packages: dict[Path, None] = {}
        for folder in self._folders:
            descriptions, package_folders = find_files_and_packages(folder, DESCRIPTION_SUFFIXES)
            files.update(dict.fromkeys(real_path(file) for file in descriptions))
            packages.update(dict.fromkeys(package_folders))
        self.files, self.packages = tuple(files), tuple(packages)
        self._package_folders = folders_by_package(map(real_path, packages))

    def entries(self, file: Path, texts: Mapping[Path, str], *, computed: bool = False) -> list[Path]:
        """Return the top-level descriptions that include a file, or the file if none does.

        Args:
            file: the file, as `real_path` returns it.
            texts: texts that replace those of files.
            computed: whether an include with a computed path counts for each file that it can mean.
        """
        includers = self._index_includers(texts)
        entries: dict[Path, None] = {}
        seen_files, pending = {file}, [file]
        while pending:
            current = pending.pop()
            direct_includers = self._find_includers(current, includers, computed=computed)
            if not direct_includers:
                entries[current] = None
            for other in direct_includers:
                if other not in seen_files:
                    seen_files.add(other)
                    pending.append(other)
        return list(entries) or [file]

    def roots(self, texts: Mapping[Path, str]) -> list[Path]:
        """Return the files that no other file includes.

        Args:
            texts: texts that replace those of files.
        """
        files = dict.fromkeys((*self.files, *(file for file in texts if file.name.endswith(DESCRIPTION_SUFFIXES))))
        includers = self._index_includers(texts)
        return [file for file in files if not self._find_includers(file, includers)]

    def related_files(self, file: Path, texts: Mapping[Path, str], *, computed: bool = False) -> list[Path]:
        """Return a file and all files of the descriptions that include it.

        The files that it includes are among them.

        Args:
            file: the file, as `real_path` returns it.
            texts: texts that replace those of files.
            computed: whether an include with a computed path counts for each file that it can mean.
        """
        by_name: dict[str, list[Path]] = {}
        for other in dict.fromkeys((*self.files, *texts)):
            by_name.setdefault(other.name, []).append(other)
        related_files: dict[Path, None] = {}
        pending = [*self.entries(file, texts, computed=computed), file]
        while pending:
            current = pending.pop()
            if current in related_files:
                continue
            related_files[current] = None
            for inclusion in self._inclusions_of(current, texts):
                candidates = by_name.get(inclusion.name, ())
                pending += [other for other in candidates if inclusion.may_lead(current, other, self._package_folders)]
                if computed:
                    pending += filter(inclusion.may_compute, self.files)
        return list(related_files)

    def _index_includers(self, texts: Mapping[Path, str]) -> dict[str, list[tuple[Path, Inclusion]]]:
        """Return the includes of all files, by the names of the included files."""
        includers: dict[str, list[tuple[Path, Inclusion]]] = {}
        for file in dict.fromkeys((*self.files, *texts)):
            for inclusion in self._inclusions_of(file, texts):
                includers.setdefault(inclusion.name, []).append((file, inclusion))
        return includers

    def _find_includers(
        self, file: Path, includers: Mapping[str, list[tuple[Path, Inclusion]]], *, computed: bool = False
    ) -> list[Path]:
        """Return the other files that include a file."""
        including_files = {
            other: None
            for other, inclusion in includers.get(file.name, ())
            if inclusion.may_lead(other, file, self._package_folders)
        }
        if computed:
            every = (pair for pairs in includers.values() for pair in pairs)
            including_files |= {other: None for other, inclusion in every if inclusion.may_compute(file)}
        including_files.pop(file, None)
        return [*including_files]

    def _inclusions_of(self, file: Path, texts: Mapping[Path, str]) -> tuple[Inclusion, ...]:
        text = texts.get(file)
        if text is not None:
            return tuple(dict.fromkeys(inclusions_in(text)))
        try:
            changed_ns = file.stat().st_mtime_ns
            cached = self._inclusions.get(file)
            if cached is None or cached[0] != changed_ns:
                inclusions = tuple(dict.fromkeys(inclusions_in(file.read_text(encoding="utf-8", errors="replace"))))
                cached = self._inclusions[file] = (changed_ns, inclusions)
        except OSError:
            return ()
        return cached[1]


def real_path(path: str | os.PathLike[str]) -> Path:
    """Return the path of a file with all symbolic links resolved."""
    return Path(os.path.realpath(path))
