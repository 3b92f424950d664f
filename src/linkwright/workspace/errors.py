"""What can go wrong when a package is looked for."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, did_you_mean


class PackageNotFoundError(LinkwrightError, KeyError):
    """No package of that name anywhere (PKG101).

    It is a KeyError too, as ``ament_index_python``'s exception of the same name is, so that launch files
    which catch that one go on working.

    Attributes:
        name: the package that was looked for.
    """

    def __init__(self, name: str, searched: Sequence[str], known: Iterable[str]) -> None:
        notes = tuple(Note(f"searched {place}") for place in searched)
        hint = did_you_mean(name, known) or ("go to the workspace that holds it, or source its install/setup.bash")
        super().__init__(Diagnostic("PKG101", f"package '{name}' not found", notes=notes, hint=hint))
        self.name = name


def bad_uri(uri: str, problem: str, hint: str | None = None) -> LinkwrightError:
    """The error for a resource address that cannot be understood (PKG102)."""
    return LinkwrightError(Diagnostic("PKG102", f"'{uri}' {problem}", hint=hint))
