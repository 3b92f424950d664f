"""Find the methods that C++ classes declare or inherit from classes of the repository."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import PurePosixPath

from linkwright.review.sources.names import HEADER_SUFFIXES, NameKind, SourceNames
from linkwright.review.sources.reading import read_source_names
from linkwright.review.versions import TEST_FOLDERS, Version


class ClassMethods:
    """The methods of the C++ classes of a version.

    Args:
        version: the version of the repository.
        sources: the names in its changed sources by path.
    """

    def __init__(self, version: Version, sources: Mapping[str, SourceNames]) -> None:
        self._version = version
        self._sources = sources
        self._unchanged: dict[str, list[SourceNames]] = {}

    def has_function(self, name: str) -> bool:
        """Return whether a class has a method or inherits it from a class of the repository.

        A function outside of classes counts if any changed source declares a function with its name.

        Args:
            name: the name of the function, qualified by its classes.
        """
        *scopes, short = name.split("::")
        if not scopes:
            return any(short == other.rpartition("::")[2] for other in _list_functions(self._sources.values()))
        classes = [scopes[-1]]
        for class_name in classes:
            declaring = [names for names in self._sources.values() if _declares(names, class_name)]
            declaring = declaring or self._find_unchanged(class_name)
            if f"{class_name}::{short}" in {"::".join(other.split("::")[-2:]) for other in _list_functions(declaring)}:
                return True
            bases = (base for names in declaring for base in names.bases.get(class_name, ()))
            classes += [base for base in dict.fromkeys(bases) if base not in classes]
        return False

    def _find_unchanged(self, class_name: str) -> list[SourceNames]:
        """Return the names in the unchanged headers that declare a class."""
        if class_name not in self._unchanged:
            pattern = re.compile(rf"\b(?:class|struct)\b[^;{{}}()]*\b{class_name}\b[^;{{}}()]*\{{")
            paths = (
                path
                for path in self._version.paths(HEADER_SUFFIXES)
                if path not in self._sources and TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts)
            )
            texts = ((path, self._version.text(path)) for path in paths)
            found = [path for path, text in texts if class_name in text and pattern.search(text)]
            names = (read_source_names(self._version.file(path)) for path in found)
            self._unchanged[class_name] = [item for item in names if _declares(item, class_name)]
        return self._unchanged[class_name]


def _declares(names: SourceNames, class_name: str) -> bool:
    return any(item.name == class_name for item in names.of_kind(NameKind.CLASS))


def _list_functions(sources: Iterable[SourceNames]) -> Iterator[str]:
    """Yield the qualified names of the public functions in sources, including overrides."""
    for names in sources:
        overrides: Collection[str] = names.overrides
        yield from overrides
        yield from (item.name for item in names.of_kind(NameKind.FUNCTION))
