"""The requests of an editor about a file of any format, and the functions of a format that answer them."""

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
    """Raised where a function would have to expand descriptions or to search sources, and may not wait for it."""


@dataclass(frozen=True, slots=True)
class Document:
    """A text that an editor shows.

    Attributes:
        project: the files of the editor.
        texts: the texts of all open files.
        file: the file, as `linkwright.language.includes.real` returns it.
        text: its text, in any state.
        waits: whether functions may expand descriptions and search sources. Otherwise they use what an earlier request
            has found, add what brings it up to date to `refreshes`, and raise `NotYetKnownError` if nothing is known.
        refreshes: what to do after a request, in the thread of the checks, so that the next one has current facts.
    """

    project: Workspace
    texts: Mapping[Path, str]
    file: Path
    text: str
    waits: bool = True
    refreshes: list[Callable[[], object]] = field(default_factory=list, compare=False)

    @property
    def finder(self) -> PackageFinder:
        """The finder of packages for the file."""
        return self.project.finder(self.file)

    def other(self, file: Path) -> str:
        """Return the text of another file, which may be open; empty if it cannot be read."""
        return self.project.text(file, self.texts) or ""


@dataclass(frozen=True, slots=True)
class Target:
    """A place that a name leads to.

    Attributes:
        file: the file.
        start: the character offset of the place in its text.
        end: the offset behind it.
    """

    file: Path
    start: int = 0
    end: int = 0


class SymbolKind(Enum):
    """The kinds of symbols; the values are the names of the Language Server Protocol."""

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
    """A part of a text with a name.

    Attributes:
        name: the name.
        kind: its kind.
        start: the character offset of the part.
        end: the offset behind it.
        children: the parts in it.
        detail: a few words behind the name.
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
    """A format of files: its functions take any text, and any character offset in it, and raise nothing.

    Attributes:
        covers: returns whether a file has the format, by its path alone.
        complete: returns the completions at an offset, the most likely first.
        explain: explains what is at an offset; None if there is nothing to say.
        define: returns the places where the name at an offset is defined.
        links: returns the references to other files.
        symbols: returns the parts with names; None for the elements of an XML text.
        needs_index: whether the functions use the descriptions in the folders of the editor.
        prepare: imports what the functions need and that takes long; it may run in any thread, any number of times.
    """

    covers: Callable[[Path], bool]
    complete: Callable[[Document, int], Iterable[Completion]] = _nothing
    explain: Callable[[Document, int], Explanation | None] = _no_explanation
    define: Callable[[Document, int], Iterable[Target]] = _nothing
    links: Callable[[Document], Iterable[FileReference]] = _nothing
    symbols: Callable[[Document], Iterable[Symbol]] | None = None
    needs_index: bool = False
    prepare: Callable[[], object] = _nothing
