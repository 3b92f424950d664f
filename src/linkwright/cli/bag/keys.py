"""Single key presses from the terminal while an event loop runs."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

SPACE, UP, DOWN, RIGHT = " ", "\x1b[A", "\x1b[B", "\x1b[C"
"""The sequences that a terminal sends for the keys (ECMA-48)."""


@contextmanager
def reading_keys(actions: Mapping[str, Callable[[], object]]) -> Iterator[bool]:
    """Call a function for each key press while the context is active.

    Args:
        actions: the function to call, by key.

    Yields:
        Whether keys are read. They are read only if standard input is a terminal and this process is in its foreground.
    """
    if not _can_read_keys():
        yield False
        return
    import termios
    import tty

    descriptor = sys.stdin.fileno()
    old_settings = termios.tcgetattr(descriptor)

    def read() -> None:
        text = os.read(descriptor, 64).decode(errors="replace")
        while text:  # keys that are pressed in quick succession arrive in one read
            key = next((action for action in actions if text.startswith(action)), "")
            if key:
                actions[key]()
            text = text[len(key) or 1 :]

    tty.setcbreak(descriptor)
    asyncio.get_running_loop().add_reader(descriptor, read)
    try:
        yield True
    finally:
        asyncio.get_running_loop().remove_reader(descriptor)
        termios.tcsetattr(descriptor, termios.TCSADRAIN, old_settings)


def _can_read_keys() -> bool:
    if sys.platform == "win32" or sys.stdin is None or not sys.stdin.isatty():
        return False
    return os.getpgrp() == os.tcgetpgrp(sys.stdin.fileno())
