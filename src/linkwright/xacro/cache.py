"""Caches with limited size, for computed values and for compiled texts."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.loading.lean_typing import Generic, TypeVar

_Key = TypeVar("_Key")
_Value = TypeVar("_Value")

_STRIDE = 16


class BoundedCache(Generic[_Key, _Value]):
    """A cache of values with a limit on their total size.

    When it is full, it drops every sixteenth value, each time starting at a different position. A user that cycles
    through more values than fit, such as a collection of robots, therefore finds most of them again. If the oldest were
    dropped first, none would be found.

    Args:
        most: the maximum total size.
        size_of: the function that returns the size of a value.

    Attributes:
        values: a plain dict, because it is read for each text of a description.
    """

    def __init__(self, most: int, size_of: Callable[[_Key, _Value], int]) -> None:
        self.values: dict[_Key, _Value] = {}
        self._most = most
        self._size_of = size_of
        self._size = 0
        self._start = 0

    def store(self, key: _Key, value: _Value) -> None:
        """Store a value, replacing an old value with the same key."""
        values, size_of = self.values, self._size_of
        values.pop(key, None)
        own = size_of(key, value)
        self._size += own  # too much if the key existed; the count below corrects it
        while self._size > self._most and values:
            self._size = own + sum(size_of(*item) for item in list(values.items()))
            if self._size > self._most:
                self._start = (self._start + 1) % _STRIDE
                for dropped in list(values)[self._start :: _STRIDE]:
                    values.pop(dropped, None)
        values[key] = value


_Form = TypeVar("_Form")

_MOST_CHARACTERS = 1_000_000
_AROUND = 8
"""How long the texts that are kept may be together, with what each adds; compiled they are a hundred times as large."""


class TextCompiler(Generic[_Form]):
    """A compiler for texts that caches the results.

    Args:
        compile_text: the function that compiles a text.

    Attributes:
        forms: text -> its compiled form.
    """

    def __init__(self, compile_text: Callable[[str], _Form]) -> None:
        self._cache: BoundedCache[str, _Form] = BoundedCache(_MOST_CHARACTERS, lambda text, _: len(text) + _AROUND)
        self.forms = self._cache.values
        self._compile = compile_text

    def make(self, text: str) -> _Form:
        """Compile a text and cache the result.

        Raises:
            Fault: if the text is malformed.
        """
        form = self._compile(text)
        self._cache.store(text, form)
        return form
