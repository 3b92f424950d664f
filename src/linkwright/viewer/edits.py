"""The edits of a configuration that can be taken back."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Generic, TypeVar

from linkwright.viewer.history import Edit
from linkwright.viewer.protocol import EditName

if TYPE_CHECKING:
    from linkwright.viewer.manager import VisualizationManager
    from linkwright.viewer.yaml_tree import Memory

State = TypeVar("State")


class ValueEdit(Edit):
    """A property was set, and others with it. What counts is what the file said: a key that was not there goes again.

    Args:
        manager: has the property.
        identity: of the property.
        name: of the property.
        before: what the file said.
    """

    def __init__(self, manager: VisualizationManager, identity: str, name: str, before: list[Memory]) -> None:
        super().__init__(EditName("set", name), identity)
        self._manager = manager
        self._owner = identity.partition("/")[0]
        self._other = before

    def undo(self) -> None:
        """Make the file say what it said."""
        now = self._manager.store(self._owner).memories(self._other)
        self._manager.recall(self._owner, self._other)
        self._other = now

    redo = undo


class SwapEdit(Edit, Generic[State]):
    """Something of a display, or of all, is in another state than before.

    Args:
        swap: brings a state about, and returns the one that was there.
        before: the state before.
        name: what was done.
    """

    def __init__(self, swap: Callable[[State], State], before: State, name: EditName) -> None:
        super().__init__(name)
        self._swap = swap
        self._other = before

    def undo(self) -> None:
        """Bring about what was before."""
        self._other = self._swap(self._other)

    def redo(self) -> None:
        """Bring about what was after."""
        self._other = self._swap(self._other)
