"""Find the names that a C++ source passes to functions, macros and classes of the repository."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path

from linkwright.diagnostics import SourceText
from linkwright.review.sources.cpp.helpers import Helper, HelperUse, find_helper_uses, find_helpers
from linkwright.review.sources.cpp.wrappers import find_wrapper_uses, find_wrappers, read_sources_of_headers


class CallerNames:
    """The names that a C++ source passes to helpers, which make topics, services, actions or parameters from them.

    Args:
        source: the source.
        text: its text without comments.
        headers: the texts of the included headers of the repository.
    """

    def __init__(self, source: SourceText, text: str, headers: Sequence[str]) -> None:
        self._source = source
        self._text = text
        self._headers = headers

    def find_uses(self) -> Iterator[HelperUse]:
        """Yield the calls of helpers and the constructions of objects with literal names."""
        yield from find_helper_uses(self._text, self._own_helpers, is_own=True)
        for use in find_helper_uses(self._text, self._header_helpers, is_own=False):
            yield use._replace(call=use.call._replace(start=use.begin))
        yield from find_wrapper_uses(self._text, self._headers, [*self._own_wrappers, *self._other_wrappers])

    @cached_property
    def helper_names(self) -> frozenset[str]:
        """The names of the functions and macros."""
        return frozenset(helper.name for helper in (*self._own_helpers, *self._header_helpers))

    @cached_property
    def inner_calls(self) -> frozenset[int]:
        """The offsets of the calls in helpers of the source whose callers give the names."""
        uses = find_helper_uses(self._text, self._own_helpers, is_own=True)
        used = (item for item in self._own_wrappers if any(find_wrapper_uses(self._text, self._headers, [item])))
        return frozenset([*(use.call.start for use in uses), *(wrapper.call.start for wrapper in used)])

    @cached_property
    def _own_helpers(self) -> list[Helper]:
        return find_helpers(self._text)

    @cached_property
    def _header_helpers(self) -> list[Helper]:
        own = {helper.name for helper in self._own_helpers}
        return [helper for text in self._headers for helper in find_helpers(text) if helper.name not in own]

    @cached_property
    def _own_wrappers(self) -> list[Helper]:
        return find_wrappers(self._text)

    @cached_property
    def _other_wrappers(self) -> list[Helper]:
        """The constructors of included classes that make names which their callers pass."""
        own = {wrapper.name for wrapper in self._own_wrappers}
        texts = [*self._headers, *read_sources_of_headers(Path(self._source.name), self._source.text)]
        return [wrapper for text in texts for wrapper in find_wrappers(text) if wrapper.name not in own]
