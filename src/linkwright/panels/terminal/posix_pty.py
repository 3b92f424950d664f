"""A program in a pseudoterminal of POSIX, as the leader of a new session."""

from __future__ import annotations

import asyncio
import os
import struct
import subprocess
import sys
import threading
from contextlib import suppress
from pathlib import Path

from linkwright.panels.terminal.process_session import end_session
from linkwright.panels.terminal.pty import ExitCallback, OutputCallback, TerminalProgram, TerminalSize

if sys.platform != "win32":
    import fcntl
    import termios

_STARTER = Path(__file__).with_name("take_terminal.py")

_BLOCK_SIZE = 64 * 1024
"""The largest size of a block of output in bytes."""

_GRACE_S = 0.5
"""The seconds for which the children of a shell may continue after the shell has ended."""

_UTF8_INPUT = 0x4000
"""The terminal flag with which Backspace erases one UTF-8 character, not one byte. This is IUTF8 on Linux and macOS."""


class PosixPty:
    """A program in a pseudoterminal; see `linkwright.panels.terminal.pty.Pty`.

    A thread waits for the end of the program. When the program has ended, its remaining child processes are also ended.

    Raises:
        OSError: the program cannot be started.
    """

    def __init__(
        self, program: TerminalProgram, size: TerminalSize, receive: OutputCallback, ended: ExitCallback
    ) -> None:
        self._receive = receive
        self._ended = ended
        self._loop = asyncio.get_running_loop()
        self._unwritten = bytearray()
        self._is_open = True
        self._is_requested = False
        self._status: int | None = None
        self._terminal, program_side = os.openpty()
        try:
            os.set_blocking(self._terminal, False)
            _prepare(program_side)
            self.resize(size)
            self._process = subprocess.Popen(  # noqa: S603 - the user's shell
                [sys.executable, "-I", "-S", str(_STARTER), *program.command],
                stdin=program_side,
                stdout=program_side,
                stderr=program_side,
                cwd=program.folder,
                env=dict(program.environment),
                start_new_session=True,
            )
        except BaseException:
            os.close(self._terminal)
            raise
        finally:
            os.close(program_side)
        self._waiter = threading.Thread(target=self._wait, name="linkwright-terminal", daemon=True)
        self._waiter.start()

    @property
    def unwritten_size(self) -> int:
        """The size in bytes of the input that the program has not read yet."""
        return len(self._unwritten)

    def request_output(self) -> None:
        """Request the next block of output."""
        if not self._is_open or self._is_requested:
            return
        self._is_requested = True
        self._loop.add_reader(self._terminal, self._read)
        if self._status is not None:
            self._loop.call_soon(self._read)

    def write(self, data: bytes) -> None:
        """Write input for the program, which may read the input later."""
        if self._is_open:
            self._unwritten += data
            self._write_unwritten()

    def resize(self, size: TerminalSize) -> None:
        """Set the size of the terminal; the foreground programs receive SIGWINCH."""
        if self._is_open:
            fcntl.ioctl(self._terminal, termios.TIOCSWINSZ, struct.pack("HHHH", size.rows, size.columns, 0, 0))

    def hang_up(self) -> None:
        """Close the terminal; the system sends SIGHUP to the program."""
        if self._is_open:
            self._is_open = False
            self._loop.remove_reader(self._terminal)
            self._loop.remove_writer(self._terminal)
            os.close(self._terminal)

    def wait_until_ended(self, grace: float) -> None:
        """Wait until all processes of the session have ended; kill them after `grace` seconds."""
        if self._waiter.is_alive():
            end_session(self._process.pid, grace)
            self._waiter.join(grace)

    def _read(self) -> None:
        if not self._is_open or not self._is_requested:
            return
        block = bytearray()
        is_over = False
        try:
            while len(block) < _BLOCK_SIZE:
                part = os.read(self._terminal, _BLOCK_SIZE - len(block))
                block += part
                if not part:
                    is_over = True
                    break
        except BlockingIOError:
            is_over = self._status is not None
        except OSError:  # Linux reports the end of output as EIO.
            is_over = True
        if not block and not is_over:
            return
        self._is_requested = False
        self._loop.remove_reader(self._terminal)
        if block:
            self._receive(bytes(block))  # The next read detects the end of output, if there is one.
        elif self._status is None:
            self._is_requested = True  # `_finish` reports the end.
        else:
            self.hang_up()
            self._ended(self._status)

    def _write_unwritten(self) -> None:
        try:
            del self._unwritten[: os.write(self._terminal, self._unwritten)]
        except BlockingIOError:
            pass
        except OSError:  # The program has ended.
            self._unwritten.clear()
        if self._unwritten:
            self._loop.add_writer(self._terminal, self._write_unwritten)
        else:
            self._loop.remove_writer(self._terminal)

    def _wait(self) -> None:
        """Wait for the program, end the rest of its session, and report the exit status."""
        if hasattr(os, "waitid"):  # The program is not reaped yet, so no other process can get its ID.
            os.waitid(os.P_PID, self._process.pid, os.WEXITED | os.WNOWAIT)
            end_session(self._process.pid, _GRACE_S)
        status = self._process.wait()
        with suppress(RuntimeError):  # The event loop has ended.
            self._loop.call_soon_threadsafe(self._finish, status)

    def _finish(self, status: int) -> None:
        self._status = status
        self._read()


def _prepare(terminal: int) -> None:
    """Set the mode of a new terminal: its input is UTF-8."""
    mode = termios.tcgetattr(terminal)
    mode[0] |= _UTF8_INPUT
    termios.tcsetattr(terminal, termios.TCSANOW, mode)
