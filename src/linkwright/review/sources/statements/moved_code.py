"""Find the code outside of functions that moves into a function, such as that of a script into ``main``."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.sources.statements.code import Code, Part

_INDENT = re.compile(r"[\d ]*")
"""The marks of the blocks before a statement."""
_MIN_STATEMENTS = 4
_MIN_SHARE = 0.6
"""The minimum share of the removed statements that are in the function, and of its statements that were removed."""


class MovedCode(NamedTuple):
    """The function into which code outside of functions moves.

    Attributes:
        path: the path of its source.
        function: its qualified name.
        is_equal: whether all statements are equal.
    """

    path: str
    function: str
    is_equal: bool

    def format(self, source: str) -> Phrase:
        """Return the change of the source from which the code moves."""
        if self.path == source and self.is_equal:
            return phrase("code outside of functions moved to '{function}()'", function=self.function)
        if self.path == source:
            return phrase("code outside of functions moved to '{function}()', with changes", function=self.function)
        if self.is_equal:
            return phrase(
                "code outside of functions moved to '{function}()' in '{path}'", function=self.function, path=self.path
            )
        return phrase(
            "code outside of functions moved to '{function}()' in '{path}', with changes",
            function=self.function,
            path=self.path,
        )


def find_moved_code(old: Code, new: Code, added: Mapping[str, Code]) -> MovedCode | None:
    """Return the added function that has most of the code which a source loses outside of functions, or None.

    Args:
        old: the code of the old source.
        new: the code of the new source.
        added: the code of the sources to search, by path, with only the functions that the old version lacks.
    """
    before, after = (Counter(_read(code.outside.get("", ()))) for code in (old, new))
    removed = before - after
    if removed.total() < _MIN_STATEMENTS:
        return None
    found = {
        (path, name): Counter(_read(parts[1:]))
        for path, code in added.items()
        for name, parts in code.functions.items()
    }
    shares = {key: (removed & body).total() for key, body in found.items()}
    best = max(shares, key=lambda key: shares[key], default=None)
    if best is None or shares[best] < _MIN_SHARE * max(removed.total(), found[best].total()):
        return None
    return MovedCode(*best, is_equal=removed == found[best])


def without_functions(code: Code, names: Collection[str]) -> Code:
    """Return the code of a source without some functions."""
    return replace(code, functions={name: parts for name, parts in code.functions.items() if name not in names})


def without_statements(code: Code) -> Code:
    """Return the code of a source without the statements outside of functions and classes."""
    return replace(code, outside={**code.outside, "": []})


def _read(parts: Sequence[Part]) -> list[str]:
    """Return statements without the marks of their blocks, and without a test whether the source is run."""
    texts = (_INDENT.sub("", part.text, count=1) for part in parts)
    return [text for text in texts if "__name__" not in text]
