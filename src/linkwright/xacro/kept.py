"""What was worked out once and is kept, up to a bound."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.lean_typing import Generic, TypeVar

_Key = TypeVar("_Key")
_Value = TypeVar("_Value")

_STRIDE = 16


class Kept(Generic[_Key, _Value]):
    """Values that are kept as long as they are not too large together.

    When they are, every sixteenth is forgotten, each time beginning at another one. So whoever goes round through more
    than there is room for, as through a collection of robots, finds most of it again. If the oldest went first, nothing
    would be found.

    Args:
        most: how large they may be together.
        size_of: the size of one.

    Attributes:
        values: a plain dict, for it is looked into for each text of a description.
    """

    def __init__(self, most: int, size_of: Callable[[_Key, _Value], int]) -> None:
        self.values: dict[_Key, _Value] = {}
        self._most = most
        self._size_of = size_of
        self._size = 0
        self._start = 0

    def keep(self, key: _Key, value: _Value) -> None:
        """Keep one more, or one instead of another."""
        values, size_of = self.values, self._size_of
        values.pop(key, None)
        own = size_of(key, value)
        self._size += own  # too much where another value had this key, which counting anew puts right
        while self._size > self._most and values:
            self._size = own + sum(size_of(*item) for item in list(values.items()))
            if self._size > self._most:
                self._start = (self._start + 1) % _STRIDE
                for each in list(values)[self._start :: _STRIDE]:
                    values.pop(each, None)
        values[key] = value
