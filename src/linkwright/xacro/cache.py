"""Caches with a limited size, for computed values and for compiled texts."""

from __future__ import annotations

import os
from collections.abc import Callable

from linkwright.loading.lean_typing import Generic, TypeVar
from linkwright.xmltree import Document, Overlay, parse_file

_Key = TypeVar("_Key")
_Value = TypeVar("_Value")

_STRIDE = 16


class BoundedCache(Generic[_Key, _Value]):
    """A cache of values with a limit on their total size.

    A full cache drops every sixteenth value, each time starting at a different position. A caller that cycles through
    more values than fit, such as a check of many robots, therefore still finds most of the values. If the oldest
    values were dropped first, the check would find none.

    Args:
        max_size: the maximum total size.
        size_of: the function that returns the size of a value.

    Attributes:
        divisor: the divisor of the maximum sizes of all caches. The limits suit a command that reads a thousand
            robots once. A process that runs for days and expands a text again after each edit needs less, because it
            never reads the earlier versions of the text again.
        values: the cached values, by key. This is a plain dict because it is read for each text of a description.
    """

    divisor = 1

    def __init__(self, max_size: int, size_of: Callable[[_Key, _Value], int]) -> None:
        self.values: dict[_Key, _Value] = {}
        self._max_size = max_size
        self._size_of = size_of
        self._size = 0
        self._start = 0

    def store(self, key: _Key, value: _Value) -> None:
        """Store a value, replacing an old value with the same key."""
        values, size_of, max_size = self.values, self._size_of, self._max_size // self.divisor
        values.pop(key, None)
        value_size = size_of(key, value)
        self._size += value_size  # The size is too large if the key existed. The sum below corrects it.
        while self._size > max_size and values:
            self._size = value_size + sum(size_of(*item) for item in list(values.items()))
            if self._size > max_size:
                self._start = (self._start + 1) % _STRIDE
                for dropped in list(values)[self._start :: _STRIDE]:
                    values.pop(dropped, None)
        values[key] = value


_Form = TypeVar("_Form")

_MAX_CHARACTERS = 1_000_000
_SIZE_PER_TEXT = 8
"""The fixed size that each cached text adds to its length. A compiled text is a hundred times as large."""


class TextCompiler(Generic[_Form]):
    """A compiler for texts that caches the results.

    Args:
        compile_text: the function that compiles a text.

    Attributes:
        forms: the compiled forms, by text.
    """

    def __init__(self, compile_text: Callable[[str], _Form]) -> None:
        self._cache: BoundedCache[str, _Form] = BoundedCache(
            _MAX_CHARACTERS, lambda text, _: len(text) + _SIZE_PER_TEXT
        )
        self.forms = self._cache.values
        self._compile = compile_text

    def make(self, text: str) -> _Form:
        """Compile a text and cache the result.

        Raises:
            Fault: if the text is malformed.
        """
        form = self._compile(text)
        self._cache.store(text, form)
        return form


_SHARE_LINKS = f"{os.sep}shares{os.sep}"
_MAX_BYTES = 24_000_000
"""The maximum total size of the files whose documents are cached. A thousand robots have this size. A document takes
fifteen times as much memory as its file."""
documents: BoundedCache[tuple[str, str], tuple[int, int, Document]] = BoundedCache(_MAX_BYTES, lambda _, file: file[1])
"""Path and current folder -> modification time, size and document."""


def read_document(path: str, overlay: Overlay | None = None) -> Document:
    """Return the parsed document of a file.

    A file is parsed again only if it has changed. The document is shared, so callers must not change it.

    Args:
        path: the file.
        overlay: the texts that replace the contents of files.

    Raises:
        LinkwrightError: see `linkwright.xmltree.parse_file`.
    """
    if _SHARE_LINKS in path:  # a folder with links to the files of an unbuilt package
        from linkwright.packages.share_layout import find_source  # imported here because few robots need it

        path = find_source(path)
    unsaved = None if overlay is None else overlay.document(path)
    if unsaved is not None:
        return unsaved
    key = (path, "" if os.path.isabs(path) else os.getcwd())  # noqa: PTH109, PTH117 - strings are faster and shown
    try:
        status = os.stat(path)  # noqa: PTH116
    except (OSError, ValueError):
        return parse_file(path)  # raises the error with its reason
    cached = documents.values.get(key)
    if cached is not None and cached[:2] == (status.st_mtime_ns, status.st_size):
        return cached[2]
    document = parse_file(path)
    documents.store(key, (status.st_mtime_ns, status.st_size, document))
    return document
