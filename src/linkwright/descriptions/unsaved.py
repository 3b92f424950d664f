"""The unsaved texts of editors, with which descriptions are read before they are saved."""

from __future__ import annotations

import os
from collections.abc import Awaitable, Callable, Iterable, Mapping

from linkwright.loading.lean_dataclasses import NamedTuple, dataclass
from linkwright.loading.lean_typing import Literal, Protocol

UpdateOutcome = Literal["shown", "errors", "elsewhere"]
"""Whether descriptions are shown with a new text, are unchanged because of its errors, or do not contain it."""

Listener = Callable[[str], Awaitable[UpdateOutcome]]
"""A function that reads descriptions again after the text of a file, given by its real path, has changed."""


class TextOwner(Protocol):
    """An editor with unsaved texts.

    Editors are hashable.
    """

    def edit(self, path: str, revision: int, text: str) -> None:
        """Replace a text in the editor after the robot was edited in the scene.

        Args:
            path: the editor's path of the file.
            revision: the revision of the text that the edit was made for, or 0 if the editor has no unsaved text of the
                file.
            text: the new text, with the line ends of the file.
        """


@dataclass(frozen=True, slots=True)
class UnsavedText:
    """The unsaved text of a file in an editor.

    Attributes:
        owner: the editor.
        path: the editor's path of the file.
        revision: the number that the editor gave to this text.
        text: the text, with the line ends of the file.
    """

    owner: TextOwner
    path: str
    revision: int
    text: str


class _Key(NamedTuple):
    owner: TextOwner
    real_path: str


def with_lf_line_ends(text: str) -> str:
    """Return a text with the line ends of pages, LF."""
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _make_key(owner: TextOwner, path: str) -> _Key:
    return _Key(owner, os.path.realpath(path))


class UnsavedTexts:
    """The unsaved texts of all editors.

    Of two texts of a file, the newer text is used.

    Args:
        listeners: the functions that are called after each change.
    """

    def __init__(self, listeners: Iterable[Listener]) -> None:
        self._texts: dict[_Key, UnsavedText] = {}
        self._listeners = listeners

    @property
    def texts(self) -> Mapping[str, UnsavedText]:
        """The texts by the real paths of their files."""
        return {key.real_path: unsaved for key, unsaved in self._texts.items()}

    async def store(self, unsaved: UnsavedText) -> UpdateOutcome:
        """Replace the editor's text of a file, and return the effect on the descriptions."""
        key = _make_key(unsaved.owner, unsaved.path)
        self._texts.pop(key, None)  # the newest text is the last one
        self._texts[key] = unsaved
        return await self._notify_listeners(key.real_path)

    async def remove(self, owner: TextOwner, path: str) -> UpdateOutcome:
        """Remove the editor's text of a file, and return the effect on the descriptions.

        If no other editor has a text of the file, the text on the disk is used again.
        """
        key = _make_key(owner, path)
        return "elsewhere" if self._texts.pop(key, None) is None else await self._notify_listeners(key.real_path)

    async def remove_all(self, owner: TextOwner) -> None:
        """Remove all texts of an editor."""
        paths = [key.real_path for key in self._texts if key.owner == owner]
        self._texts = {key: unsaved for key, unsaved in self._texts.items() if key.owner != owner}
        for path in paths:
            await self._notify_listeners(path)

    async def _notify_listeners(self, real_path: str) -> UpdateOutcome:
        import asyncio  # imported here because the import of asyncio is slow

        outcomes = await asyncio.gather(*(listener(real_path) for listener in self._listeners))
        if "errors" in outcomes:
            return "errors"
        return "shown" if "shown" in outcomes else "elsewhere"
