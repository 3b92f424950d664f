"""Texts compiled once in a process: templates and expressions."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.loading.lean_typing import Generic, TypeVar
from linkwright.xacro.cache import BoundedCache

_Form = TypeVar("_Form")

_MOST_CHARACTERS = 1_000_000
_AROUND = 8
"""How long the texts that are kept may be together, with what each adds; compiled they are a hundred times as large."""


class TextCompiler(Generic[_Form]):
    """Compiles texts and caches the results.

    Args:
        compile_text: compiles a text.

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
            Fault: the text is malformed.
        """
        form = self._compile(text)
        self._cache.store(text, form)
        return form
