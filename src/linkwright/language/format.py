"""File formats: their functions for completion, hover, definitions, links and symbols."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path

from linkwright.language.completion import Completion
from linkwright.language.hover import Explanation
from linkwright.language.links import FileReference
from linkwright.language.workspace import Workspace
from linkwright.packages import PackageFinder


class NotYetKnownError(Exception):
    """Raised if a function would have to wait for an expansion or a search."""


@dataclass(frozen=True, slots=True)
class Document:
    """A text that an editor shows.

    Attributes:
        workspace: the folders that the editor has opened.
        texts: the texts of all open files.
        file: the file, as `linkwright.language.includes.real_path` returns it.
        text: its text, which may be incomplete.
        waits: whether functions may expand descriptions and search sources. Otherwise they use the results of earlier
            requests, add the updates of outdated results to `refreshes`, and raise `NotYetKnownError` without results.
        refreshes: the functions to call in the check thread after a request, so that the next one has current results.
    """

    workspace: Workspace
    texts: Mapping[Path, str]
    file: Path
    text: str
    waits: bool = True
    refreshes: list[Callable[[], object]] = field(default_factory=list, compare=False)

    @property
    def finder(self) -> PackageFinder:
        """The finder of packages for the file."""
        return self.workspace.finder(self.file)

    def other(self, file: Path) -> str:
        """Return the text of another file, open or not, or empty if it cannot be read."""
        return self.workspace.text(file, self.texts) or ""


@dataclass(frozen=True, slots=True)
class Target:
    """A location that a name refers to.

    Attributes:
        file: the file that contains the location.
        start: the character offset of the location in its text.
        end: the offset after it.
    """

    file: Path
    start: int = 0
    end: int = 0


class SymbolKind(Enum):
    """The kinds of symbols, with their names in the Language Server Protocol."""

    FILE = "File"
    GROUP = "Module"
    PACKAGE = "Package"
    NODE = "Class"
    ARGUMENT = "Variable"
    CONSTANT = "Constant"
    FIELD = "Field"
    KEY = "Key"
    OBJECT = "Object"
    FUNCTION = "Function"


@dataclass(frozen=True, slots=True)
class Symbol:
    """A named part of a text.

    Attributes:
        name: the name, as editors show it.
        kind: its kind.
        start: the character offset of the part.
        end: the offset after it.
        children: its named parts.
        detail: a few words after the name.
    """

    name: str
    kind: SymbolKind
    start: int
    end: int
    children: tuple[Symbol, ...] = ()
    detail: str = ""


def _nothing(*_: object) -> tuple[()]:
    return ()


def _no_explanation(*_: object) -> None:
    return None


@dataclass(frozen=True, slots=True)
class Format:
    """A file format with its language features.

    The functions accept any text and any character offset in it, and raise no exceptions.

    Attributes:
        covers: returns whether a path has the format.
        complete: returns the completions at an offset, the most likely first.
        explain: returns an explanation of the text at an offset, or None.
        define: returns the definitions of the name at an offset.
        links: returns the references to other files.
        symbols: returns the named parts, or is None if the symbols are the elements of an XML text.
        needs_index: whether the functions use the descriptions in the folders of the editor.
        prepare: imports slow dependencies of the functions. It may run in any thread, any number of times.
    """

    covers: Callable[[Path], bool]
    complete: Callable[[Document, int], Iterable[Completion]] = _nothing
    explain: Callable[[Document, int], Explanation | None] = _no_explanation
    define: Callable[[Document, int], Iterable[Target]] = _nothing
    links: Callable[[Document], Iterable[FileReference]] = _nothing
    symbols: Callable[[Document], Iterable[Symbol]] | None = None
    needs_index: bool = False
    prepare: Callable[[], object] = _nothing
