"""The recent output of a terminal, from which a page can restore the terminal."""

from __future__ import annotations

import re

LINES = 2000
"""The maximum number of earlier output lines that a page receives."""

_MAX_SIZE = 512 * 1024
"""The number of characters that remain when old output is discarded. Up to twice as many are stored."""

_MODE = re.compile(r"\x1b(?:\[\?([0-9;]+)([hl])|(c))")
"""A change of private modes (DECSET, DECRST), or a full reset (RIS)."""


class TerminalHistory:
    """The last lines of a terminal's output, and the modes that earlier output has set.

    Modes, such as the alternate screen, bracketed paste and mouse reports, are set once, and may be older than the
    stored lines.
    """

    def __init__(self) -> None:
        self._parts: list[str] = []
        self._size = 0
        self._modes: dict[str, str] = {}

    def add(self, text: str) -> None:
        """Add output."""
        self._parts.append(text)
        self._size += len(text)
        if self._size > 2 * _MAX_SIZE:
            self._discard_to(_MAX_SIZE)

    def text(self) -> str:
        """Return the text that brings an empty terminal to the state of the original one."""
        self._discard_to(_MAX_SIZE)
        text = "".join(self._parts)
        start = len(text)
        for _ in range(LINES):
            start = text.rfind("\n", 0, start)
            if start < 0:
                return self._mode_text(self._modes) + text
        modes = dict(self._modes)
        _follow_modes(modes, text[: start + 1])
        return self._mode_text(modes) + text[start + 1 :]

    def _discard_to(self, size: int) -> None:
        """Discard old output up to the end of a line, so that no escape sequence is split."""
        if self._size <= size:
            return
        text = "".join(self._parts)
        start = len(text) - size
        start = text.find("\n", start) + 1 or start
        _follow_modes(self._modes, text[:start])
        self._parts = [text[start:]]
        self._size = len(text) - start

    @staticmethod
    def _mode_text(modes: dict[str, str]) -> str:
        return "".join(f"\x1b[?{mode}{action}" for mode, action in modes.items())


def _follow_modes(modes: dict[str, str], text: str) -> None:
    """Apply the changes of terminal modes in a text to the current modes.

    Each mode is mapped to ``h`` if it is set, and to ``l`` if it is reset.
    """
    for numbers, action, reset in _MODE.findall(text):
        if reset:
            modes.clear()
        for number in filter(None, numbers.split(";")):
            modes.pop(number, None)
            modes[number] = action
