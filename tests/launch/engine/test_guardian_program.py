"""The program of the guardian, run in the process of the test."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from linkwright.launch.engine import guardian_program
from tests.waiting import TIMEOUT_S

pytestmark = pytest.mark.skipif(not hasattr(os, "killpg"), reason="this system has no process groups")
GUARDED_VARIABLE = "LINKWRIGHT_GUARDED"
NUMBERS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

Start = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture(autouse=True)
def _signals() -> Iterator[None]:
    before = {number: signal.getsignal(number) for number in NUMBERS}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.fixture
def start() -> Iterator[Start]:
    """Start a program that does not end by itself, in its own process group."""
    processes: list[subprocess.Popen[str]] = []

    def run(*ignored: str, **variables: str) -> subprocess.Popen[str]:
        lines = ["import signal", *(f"signal.signal(signal.{name}, signal.SIG_IGN)" for name in ignored)]
        program = "\n".join([*lines, "print('up', flush=True)", "while True: signal.pause()"])
        process = subprocess.Popen(
            [sys.executable, "-S", "-c", program],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            start_new_session=True,
            env={**os.environ, **variables},
        )
        processes.append(process)
        assert process.stdout is not None
        assert process.stdout.readline() == "up\n"
        return process

    yield run
    for process in processes:
        process.kill()
        process.communicate(timeout=TIMEOUT_S)


def run_guardian(monkeypatch: pytest.MonkeyPatch, text: str, mark: str = "nobody") -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO(text))
    guardian_program.main(f"{GUARDED_VARIABLE}={mark}")


def test_guardian_ends_processes_and_removes_folder(
    start: Start, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    ordinary, stubborn, ended = start(), start("SIGINT", "SIGTERM"), start()
    folder = tmp_path / "files of the launch"
    folder.mkdir()
    run_guardian(monkeypatch, f"+{ordinary.pid}\n+{stubborn.pid}\n+{ended.pid}\n={folder}\n-{ended.pid}\n")
    assert ordinary.wait(TIMEOUT_S) in (1, -signal.SIGINT)
    assert stubborn.wait(TIMEOUT_S) == -signal.SIGKILL
    assert ended.poll() is None
    assert not folder.exists()


def test_guardian_ignores_launch_that_ended_normally(start: Start, monkeypatch: pytest.MonkeyPatch) -> None:
    process = start()
    run_guardian(monkeypatch, f"+{process.pid}\n.\n")
    assert process.poll() is None


@pytest.mark.skipif(
    not Path("/proc/self/environ").exists(), reason="the environments of other processes are not readable"
)
def test_guardian_finds_unreported_processes_by_mark(start: Start, monkeypatch: pytest.MonkeyPatch) -> None:
    marked, other = start(**{GUARDED_VARIABLE: "mine"}), start(**{GUARDED_VARIABLE: "theirs"})
    run_guardian(monkeypatch, "", "mine")
    assert marked.wait(TIMEOUT_S) in (1, -signal.SIGINT)
    assert other.poll() is None
