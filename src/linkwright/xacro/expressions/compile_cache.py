"""Texts compiled once in a process: templates and expressions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

_Form = TypeVar("_Form")

_KEPT = 20_000
_KEPT_CHARACTERS = 300_000
"""How many texts are kept, and how long they may be together; compiled they are a hundred times as large."""


class TextCompiler(Generic[_Form]):
    """Compiles texts and keeps what comes out; when there is too much of it, all is forgotten.

    Args:
        compile_text: compiles a text.

    Attributes:
        forms: text -> what it was compiled to; a plain dict, for it is looked into for each text of a description.
    """

    def __init__(self, compile_text: Callable[[str], _Form]) -> None:
        self.forms: dict[str, _Form] = {}
        self._compile = compile_text
        self._characters = 0

    def make(self, text: str) -> _Form:
        """Compile a text and keep what comes out.

        Raises:
            Fault: what the compiler says of a malformed text.
        """
        if not self.forms:
            self._characters = 0
        self._characters += len(text)
        if len(self.forms) >= _KEPT or self._characters > _KEPT_CHARACTERS:
            self.forms.clear()
            self._characters = len(text)
        form = self.forms[text] = self._compile(text)
        return form
