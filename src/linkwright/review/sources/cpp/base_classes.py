"""Find the headers and sources of the classes from which the classes of a C++ source derive."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from linkwright.packages import enclosing_package
from linkwright.review.caching import cached_in_review
from linkwright.review.sources.cpp.functions import read_base_names
from linkwright.review.sources.cpp.members import find_included_headers
from linkwright.review.sources.cpp.preprocessor import blank_disabled
from linkwright.review.sources.cpp.text import blank_comments
from linkwright.review.sources.cpp.wrappers import find_sources_of_headers

_CLASS = re.compile(
    r"\b(?:class|struct)\s+(?:[A-Z]\w*_\w+\s+)?(?P<name>\w+)\s*(?:final\s*)?(?::(?!:)(?P<bases>[^;{}()]*))?\{"
)
_MAX_LEVELS = 4
_MAX_FILES = 256
"""The maximum number of sources whose base classes are kept."""


@cached_in_review(maxsize=_MAX_FILES)
def find_base_sources(path: Path) -> Sequence[Path]:
    """Return the headers and sources, in the repository, of the classes from which classes of a source derive.

    Those of the base classes of these are in it, too. A source also has the classes of its own header, which has its
    name.

    Args:
        path: the path of a source or header.
    """
    found: dict[Path, None] = {}
    files = [path, *(file for file in find_included_headers(path) if file.stem == path.stem)]
    for _ in range(_MAX_LEVELS):
        files = [base for file in files for base in _find_bases(file) if base not in found and base != path]
        found.update(dict.fromkeys(files))
    return list(found)


def _find_bases(path: Path) -> Iterator[Path]:
    """Yield the included headers that define a base class of a class in a file, each with its sources."""
    bases = {base for match in _find_classes(path) for base in read_base_names(match["bases"] or "")}
    for header in find_included_headers(path) if bases else ():
        if any(match["name"] in bases for match in _find_classes(header)):
            yield header
            package = enclosing_package(header.parent)
            if package is not None:
                yield from find_sources_of_headers(package[1], header.parent, [header.stem])


def _find_classes(path: Path) -> Iterator[re.Match[str]]:
    return _CLASS.finditer(read_code(path))


@cached_in_review(maxsize=_MAX_FILES)
def read_code(path: Path) -> str:
    """Return the text of a source without comments and disabled code."""
    return blank_comments(blank_disabled(path.read_text("utf-8", errors="replace")))
