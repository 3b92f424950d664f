"""The errors of looking for a package."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, did_you_mean, is_misspelt, nearest, phrase

_SHARED = re.compile(
    r"(?<![^_])(my|ros2?|robots?|description|bringup|gazebo|gz|control|moveit|config|msgs|driver)(?![^_])"
)
"""Words that say what kind of package it is."""
_SLIP = 0.9
"""So like are two names of which one is misspelt."""


class PackageNotFoundError(LinkwrightError, KeyError):
    """No package of that name anywhere (PKG101).

    It is a KeyError too, as ``ament_index_python``'s exception of the same name is, so that launch files
    which catch that one go on working.

    Attributes:
        name: the package that was looked for.
        is_slip: whether it is the misspelt name of a package that there is.
    """

    def __init__(self, name: str, searched: Sequence[str], known: Iterable[str]) -> None:
        notes = tuple(Note(phrase("searched {place}", place=place)) for place in searched)
        meant = did_you_mean(name, _like(name, known))
        hint = meant or (phrase("go to the workspace that holds it, or source its install/setup.bash"))
        super().__init__(Diagnostic("PKG101", phrase("package '{name}' not found", name=name), notes=notes, hint=hint))
        self.name = name
        self.is_slip = is_misspelt(name, known)


def _like(name: str, known: Iterable[str]) -> list[str]:
    """The packages that may be meant: a slip of the pen away, or alike without the words that many packages share."""
    from difflib import SequenceMatcher  # here, because most runs of a command end without a hint

    own = _telling(name)
    return [
        other
        for other in known
        if SequenceMatcher(None, name, other).ratio() >= _SLIP or (own and nearest(own, [_telling(other)], 1))
    ]


def _telling(name: str) -> str:
    return _SHARED.sub("", name).strip("_")


def bad_uri(problem: Phrase, hint: Phrase | None = None) -> LinkwrightError:
    """The error for a resource address that cannot be understood (PKG102)."""
    return LinkwrightError(Diagnostic("PKG102", problem, hint=hint))
