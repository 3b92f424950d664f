"""Starts programs in pseudoterminals of this system."""

from __future__ import annotations

import sys

from linkwright.panels.terminal.pty import ExitCallback, OutputCallback, Pty, TerminalProgram, TerminalSize


def open_pty(program: TerminalProgram, size: TerminalSize, receive: OutputCallback, ended: ExitCallback) -> Pty:
    """Start a program in a new pseudoterminal.

    Args:
        program: the program.
        size: the initial size.
        receive: called with each requested block of output.
        ended: called once when the program has ended, unless `Pty.hang_up` was called before.

    Raises:
        OSError: the program cannot be started.
        ModuleNotFoundError: on Windows, the extra `learn` is missing.
    """
    if sys.platform == "win32":
        from linkwright.panels.terminal.windows_pty import WindowsPty

        return WindowsPty(program, size, receive, ended)
    from linkwright.panels.terminal.posix_pty import PosixPty

    return PosixPty(program, size, receive, ended)
