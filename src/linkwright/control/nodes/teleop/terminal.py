"""A terminal that reports each key when it is pressed, and is restored afterwards."""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
from collections.abc import Callable
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase

_READ_BYTES = 1024
_POLL_PERIOD_S = 0.02


class KeyTerminal:
    """A terminal in a mode that reports each key immediately.

    Keys are not echoed. Ctrl-C still sends a signal. Keys that would suspend or abort the program (Ctrl-Z and the like)
    are treated as ordinary keys, because a suspended program cannot stop a robot.

    Args:
        descriptor: the terminal's file descriptor.
        on_text: called with the typed text.
        on_end: called once when the terminal closes.

    Raises:
        OSError: the descriptor is not a terminal.
    """

    def __init__(self, descriptor: int, on_text: Callable[[str], None], on_end: Callable[[], None]) -> None:
        if not os.isatty(descriptor):
            raise OSError(f"{descriptor} is not a terminal")
        self._on_text, self._on_end = on_text, on_end
        self._restore = _watch_windows(self._on_data) if sys.platform == "win32" else self._watch(descriptor)

    def close(self) -> None:
        """Restore the terminal.

        Further calls do nothing.
        """
        restore, self._restore = self._restore, lambda: None
        restore()

    def _on_data(self, data: bytes) -> None:
        if data:
            self._on_text(data.decode("utf-8", "replace"))
            return
        self.close()
        self._on_end()

    def _watch(self, descriptor: int) -> Callable[[], None]:
        import termios

        old_settings = termios.tcgetattr(descriptor)
        settings: list[Any] = [*old_settings[:6], list(old_settings[6])]
        settings[3] &= ~(termios.ICANON | termios.ECHO)
        settings[6][termios.VMIN], settings[6][termios.VTIME] = 1, 0
        for key in (termios.VSUSP, termios.VQUIT):
            settings[6][key] = b"\0"
        termios.tcsetattr(descriptor, termios.TCSADRAIN, settings)
        loop = asyncio.get_running_loop()

        def read() -> None:
            try:
                data = os.read(descriptor, _READ_BYTES)
            except BlockingIOError:
                return
            except OSError:  # The other end of the terminal is closed.
                data = b""
            self._on_data(data)

        def undo() -> None:
            loop.remove_reader(descriptor)
            with contextlib.suppress(termios.error):  # The terminal may be closed.
                termios.tcsetattr(descriptor, termios.TCSADRAIN, old_settings)

        loop.add_reader(descriptor, read)
        return undo


def _watch_windows(on_data: Callable[[bytes], None]) -> Callable[[], None]:
    """Poll the Windows console for keys, because the event loop cannot watch it.

    Returns:
        A function that stops polling.
    """
    import msvcrt

    console: Any = msvcrt  # mypy knows its functions only on Windows.
    loop = asyncio.get_running_loop()
    handle: asyncio.TimerHandle | None = None

    def poll() -> None:
        nonlocal handle
        handle = loop.call_later(_POLL_PERIOD_S, poll)
        text = ""
        while console.kbhit():
            text += console.getwch()
        if text:
            on_data(text.encode())

    def undo() -> None:
        if handle is not None:
            handle.cancel()

    poll()
    return undo


def make_terminal_error(package: str, executable: str) -> LinkwrightError:
    """Return the error NODE901 of a program that was started without a terminal."""
    return LinkwrightError(
        Diagnostic(
            "NODE901",
            phrase("{program} needs a terminal, but it was started without one", program=executable),
            hint=phrase(
                "start it in its own terminal, not from a launch file: ros2 run {package} {executable}; over ssh, use "
                "ssh -t",
                package=package,
                executable=executable,
            ),
        )
    )
