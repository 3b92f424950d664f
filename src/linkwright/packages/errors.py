"""The errors of looking for a package."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, phrase


class PackageNotFoundError(LinkwrightError, KeyError):
    """No package of that name is in any place (PKG101).

    It is a KeyError too, like the exception of the same name in ``ament_index_python``, so that launch files
    that catch the latter continue to work.

    Args:
        searched: the places.
        meant: the hint at a package that may be meant.

    Attributes:
        name: the package that was looked for.
        is_slip: whether it is the misspelt name of a package that there is.
    """

    def __init__(self, name: str, searched: Sequence[str], meant: Phrase | None, *, is_slip: bool) -> None:
        notes = tuple(Note(phrase("searched {place}", place=place)) for place in searched)
        hint = meant or phrase("go to the workspace that holds it, or source its install/setup.bash")
        super().__init__(Diagnostic("PKG101", phrase("package '{name}' not found", name=name), notes=notes, hint=hint))
        self.name = name
        self.is_slip = is_slip


def bad_uri(problem: Phrase, hint: Phrase | None = None) -> LinkwrightError:
    """The error for a resource address that cannot be understood (PKG102)."""
    return LinkwrightError(Diagnostic("PKG102", problem, hint=hint))
