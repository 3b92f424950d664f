"""A script that makes a pseudoterminal its controlling terminal, and then runs a program.

It is run as ``python -I -S take_terminal.py PROGRAM ARGUMENT...``, as the leader of a new session whose standard input
is the pseudoterminal. The parent cannot do this between fork and exec, because it has threads.

Ignored and blocked signals are reset. A server that a script started with ``&`` ignores SIGINT, and without the reset
Ctrl-C would have no effect in its terminals.
"""

from __future__ import annotations

import os
import signal
import sys

_RESET = ("SIGHUP", "SIGINT", "SIGQUIT", "SIGPIPE", "SIGTERM", "SIGTSTP", "SIGTTIN", "SIGTTOU", "SIGCHLD")


def take_terminal() -> None:
    """Make standard input the controlling terminal of this session, and reset the signals."""
    import fcntl
    import termios

    for name in _RESET:
        signal.signal(getattr(signal, name), signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_SETMASK, ())
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


if __name__ == "__main__":
    take_terminal()
    os.execv(sys.argv[1], sys.argv[1:])  # noqa: S606 - the program of the terminal, without a shell
