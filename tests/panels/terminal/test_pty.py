"""A program in a pseudoterminal.

The tests cover output, input, size, and the end of the program and its children.
"""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from linkwright.panels.terminal.opening import open_pty
from linkwright.panels.terminal.process_session import find_session_processes
from linkwright.panels.terminal.pty import Pty, TerminalProgram, TerminalSize
from tests.waiting import TIMEOUT_S, wait_until

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudoterminals")


def real_path(path: Path) -> str:
    """Return the path that `pwd -P` prints."""
    return os.path.realpath(path)


class RunningProgram:
    """A program in a terminal with which a test communicates."""

    def __init__(self, script: str, folder: Path, *, reads: bool = True) -> None:
        self.output = b""
        self.status: int | None = None
        self._reads = reads
        self._changed = asyncio.Event()
        program = TerminalProgram(("/bin/sh", "-c", script), folder, {**os.environ, "TERM": "dumb"})
        self.pty: Pty = open_pty(program, TerminalSize(80, 24), self._receive, self._ended)
        if reads:
            self.pty.request_output()

    @property
    def leader(self) -> int:
        return self.pty._process.pid  # type: ignore[attr-defined,no-any-return]  # the shell of the test

    def _receive(self, block: bytes) -> None:
        self.output += block
        self._changed.set()
        if self._reads:
            self.pty.request_output()

    def _ended(self, status: int) -> None:
        self.status = status
        self._changed.set()

    async def until(self, holds: Callable[[], object]) -> None:
        async with asyncio.timeout(TIMEOUT_S) if sys.version_info >= (3, 11) else _no_limit():
            while not holds():
                self._changed.clear()
                await self._changed.wait()

    async def prints(self, part: str) -> None:
        await self.until(lambda: part.encode() in self.output)

    async def end(self) -> int:
        await self.until(lambda: self.status is not None)
        assert self.status is not None
        return self.status


@asynccontextmanager
async def _no_limit() -> AsyncIterator[None]:
    yield


@asynccontextmanager
async def run_program(script: str, folder: Path, **options: bool) -> AsyncIterator[RunningProgram]:
    program = RunningProgram(script, folder, **options)
    try:
        yield program
    finally:
        program.pty.hang_up()
        await asyncio.to_thread(program.pty.wait_until_ended, 0.1)


async def test_program_runs_in_folder_with_own_terminal(tmp_path: Path) -> None:
    async with run_program("pwd -P; test -t 0 && tty </dev/tty; stty size; exit 3", tmp_path) as program:
        assert await program.end() == 3
        folder, tty, size = program.output.decode().split("\r\n")[:3]
        assert folder == real_path(tmp_path)
        assert tty.startswith("/dev/")
        assert size == "24 80"


async def test_all_output_arrives_before_end(tmp_path: Path) -> None:
    async with run_program("seq 100000; exit 7", tmp_path) as program:
        assert await program.end() == 7
        assert program.output == b"".join(b"%d\r\n" % number for number in range(1, 100001))


async def test_binary_data_passes_in_both_directions(tmp_path: Path) -> None:
    async with run_program("stty raw -echo; echo ready; head -c 256 | od -An -v -tu1", tmp_path) as program:
        await program.prints("ready")
        program.pty.write(bytes(range(256)))
        await program.end()
        numbers = program.output.decode().split()
        assert numbers[1:] == [str(number) for number in range(256)]


async def test_backspace_erases_chinese_character(tmp_path: Path) -> None:
    async with run_program("echo ready; cat", tmp_path) as program:
        await program.prints("ready")
        program.pty.write("机器人\x7f车\r".encode())
        await program.prints("\r\n机器车\r\n")


async def test_program_receives_new_size(tmp_path: Path) -> None:
    async with run_program(
        "trap 'stty size; exit' WINCH; echo ready; while :; do sleep 0.05; done", tmp_path
    ) as program:
        await program.prints("ready")
        program.pty.resize(TerminalSize(132, 43))
        await program.prints("43 132")


@pytest.mark.parametrize(("key", "number"), [(b"\x03", signal.SIGINT), (b"\x1c", signal.SIGQUIT)])
async def test_control_keys_send_signals_ignored_by_server(tmp_path: Path, key: bytes, number: int) -> None:
    previous = signal.signal(number, signal.SIG_IGN)
    try:
        async with run_program("ulimit -c 0; echo ready; exec sleep 100", tmp_path) as program:
            await program.prints("ready")
            program.pty.write(key)
            assert await program.end() == -number
    finally:
        signal.signal(number, previous)


async def test_output_is_read_only_on_request(tmp_path: Path) -> None:
    async with run_program("yes; echo never", tmp_path, reads=False) as program:
        for count in range(1, 4):
            before = len(program.output)
            program.pty.request_output()
            await program.until(lambda before=before: len(program.output) > before)  # type: ignore[misc]
            assert len(program.output) <= count * 64 * 1024
        size = len(program.output)
        await asyncio.sleep(0)
        assert len(program.output) == size


async def test_input_is_buffered_until_program_reads(tmp_path: Path) -> None:
    async with run_program(
        "stty raw -echo; echo ready; read -r go </dev/null; kill -STOP $$; wc -c", tmp_path
    ) as program:
        await program.prints("ready")
        program.pty.write(b"x" * 500_000)
        assert program.pty.unwritten_size > 0
        os.kill(program.leader, signal.SIGCONT)


async def test_background_processes_end_with_shell(tmp_path: Path) -> None:
    script = "(trap '' HUP; sleep 1000) & sleep 1000 & echo ready; exit 5"
    async with run_program(script, tmp_path) as program:
        assert await program.end() == 5
        assert list(find_session_processes(program.leader)) == []


async def test_hang_up_ends_processes_that_ignore_sighup(tmp_path: Path) -> None:
    script = "trap '' HUP TERM INT; (trap '' HUP; sleep 1000) & sleep 1000 & echo ready; while :; do sleep 1; done"
    async with run_program(script, tmp_path) as program:
        await program.prints("ready")
        leader = program.leader
        wait_until(lambda: len(list(find_session_processes(leader))) >= 3, TIMEOUT_S)
        program.pty.hang_up()
        await asyncio.to_thread(program.pty.wait_until_ended, 0.1)
        assert list(find_session_processes(leader)) == []
        assert program.status is None


async def test_hang_up_ends_stopped_program(tmp_path: Path) -> None:
    async with run_program("echo ready; kill -STOP $$", tmp_path) as program:
        await program.prints("ready")
        leader = program.leader
        program.pty.hang_up()
        await asyncio.to_thread(program.pty.wait_until_ended, TIMEOUT_S)
        assert list(find_session_processes(leader)) == []


async def test_missing_program_is_an_error(tmp_path: Path) -> None:
    program = TerminalProgram(("/bin/sh",), tmp_path / "none", os.environ)
    with pytest.raises(FileNotFoundError):
        open_pty(program, TerminalSize(80, 24), lambda _: None, lambda _: None)
