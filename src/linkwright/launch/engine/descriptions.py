"""Robot descriptions that come from xacro: which text was expanded from which file, with which arguments."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.workspace import PackageFinder

if TYPE_CHECKING:
    from linkwright.urdf import DescriptionLibrary
    from linkwright.xacro import Expansion

_OPTIONS_WITHOUT_EFFECT = frozenset({"--inorder", "-i", "-q"})
_OPTIONS_WITH_A_VALUE = frozenset({"-v", "--verbosity"})


@dataclass(frozen=True)
class XacroCall:
    """One use of xacro.

    Attributes:
        path: the model file, absolute.
        arguments: name and value of the arguments given.
    """

    path: Path
    arguments: tuple[tuple[str, str], ...] = ()


class DescriptionError(LinkwrightError):
    """A model file that cannot be expanded.

    Attributes:
        call: what was to be expanded.
    """

    def __init__(self, call: XacroCall, diagnostics: Iterable[Diagnostic]) -> None:
        super().__init__(*diagnostics)
        self.call = call

    @property
    def missing(self) -> bool:
        """Whether the model file itself cannot be read, so that nobody is about to repair it by an edit."""
        return not self.call.path.is_file() or not os.access(self.call.path, os.R_OK)


class Descriptions:
    """Expands model files and remembers what came out, with the positions that messages and the viewer need.

    Args:
        finder: where packages are.
    """

    def __init__(self, finder: PackageFinder) -> None:
        self.finder = finder
        self._warnings: dict[XacroCall, tuple[Diagnostic, ...]] = {}
        self._read_ns: dict[XacroCall, int] = {}
        self._calls: dict[str, XacroCall] = {}
        self._files: dict[XacroCall, tuple[Path, ...]] = {}
        self._library: DescriptionLibrary | None = None

    @property
    def library(self) -> DescriptionLibrary:
        """The descriptions that the nodes and the viewer read from."""
        if self._library is None:
            from linkwright.urdf import DescriptionLibrary

            self._library = DescriptionLibrary()
        return self._library

    def expand(self, call: XacroCall) -> str:
        """The text of a description, remembered in the library.

        Raises:
            DescriptionError: what the file, or one it includes, does wrong.
        """
        return self.remember(call, self.expansion(call))

    def expansion(self, call: XacroCall) -> Expansion:
        """Expand and nothing else; may run in another thread.

        Raises:
            DescriptionError: what the file, or one it includes, does wrong.
        """
        from linkwright.xacro import expand

        self.begin(call)
        try:
            return expand(call.path, dict(call.arguments), packages=self.finder)
        except LinkwrightError as error:
            raise DescriptionError(call, error.diagnostics) from error

    def begin(self, call: XacroCall) -> None:
        """Say that the files of a model are about to be read."""
        self._read_ns[call] = time.time_ns()

    def remember(self, call: XacroCall, expansion: Expansion, text: str | None = None) -> str:
        """Keep an expansion; returns its text, which is `text` if that is what stands for it elsewhere."""
        text = str(expansion) if text is None else text
        self._files[call] = expansion.dependencies
        self.library.remember(text, expansion.document, expansion.story, self._files[call])
        self._calls[text] = call
        self._warnings[call] = expansion.diagnostics
        return text

    def call_of(self, text: str) -> XacroCall | None:
        """The use of xacro that gave a text, or None for a text from elsewhere."""
        return self._calls.get(text)

    def warnings_of(self, call: XacroCall) -> tuple[Diagnostic, ...]:
        """What the last good expansion had to remark."""
        return self._warnings.get(call, ())

    def read_ns(self, call: XacroCall) -> int:
        """When the files were last read, nanoseconds since the epoch; 0 for never."""
        return self._read_ns.get(call, 0)

    def files_of(self, call: XacroCall) -> tuple[Path, ...]:
        """The files that the last good expansion read; the model file alone while there was none."""
        return self._files.get(call, (call.path,))


_current: ContextVar[Descriptions | None] = ContextVar("linkwright_descriptions", default=None)


def current_descriptions() -> Descriptions | None:
    """The descriptions of the launch that is being loaded or run, for those who cannot be handed them."""
    return _current.get()


@contextmanager
def use_descriptions(descriptions: Descriptions) -> Iterator[None]:
    """Make `current_descriptions` return them inside a ``with`` block."""
    token = _current.set(descriptions)
    try:
        yield
    finally:
        _current.reset(token)


def parse_xacro_words(words: Sequence[str], text: str, folder: Path) -> tuple[XacroCall, str | None]:
    """What ``xacro`` is asked for by the words of a command.

    Args:
        words: what follows ``xacro``.
        text: the same as written, before it was split into words.
        folder: what relative paths start from.

    Returns:
        The use of xacro, and a remark for the user or None.

    Raises:
        LinkwrightError: LAUNCH128, if the words are no use of xacro that gives a text.
    """
    files: list[str] = []
    arguments: dict[str, str] = {}
    waiting = iter(words)
    for word in waiting:
        name, separator, value = word.partition(":=")
        if separator:
            if value and not name.startswith("_"):
                arguments[name] = value
        elif word in _OPTIONS_WITH_A_VALUE:
            next(waiting, None)
        elif word.startswith("-") and len(word) > 1:
            if word not in _OPTIONS_WITHOUT_EFFECT and not word.startswith(("-v", "--verbosity=")):
                raise _misuse(f"option '{word}' of xacro has no place in a launch file", "leave it out")
        else:
            files.append(word)
    remark = None
    if len(files) > 1:
        whole = text.split(":=", 1)[0].rsplit(None, 1)[0] if ":=" in text else text
        if not (folder / whole.strip()).is_file():
            quoted = ", ".join(f"'{file}'" for file in files)
            raise _misuse(
                f"xacro expects exactly one model file, but was given {len(files)}: {quoted}",
                "put quotes around a path with blanks: Command(['xacro \"', path, '\"'])",
            )
        files = [whole.strip()]
        remark = f"the path '{files[0]}' has blanks and no quotes around it: real xacro would take it for several files"
    if not files:
        raise _misuse("xacro is given no model file", "write Command(['xacro ', path])")
    return XacroCall(folder / files[0], tuple(arguments.items())), remark


def _misuse(message: str, hint: str) -> LinkwrightError:
    return LinkwrightError(Diagnostic("LAUNCH128", message, hint=hint))
