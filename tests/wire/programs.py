"""Runs a program of this folder in a process of its own and talks with it: a line of JSON a question, one an answer."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from queue import Empty, Queue
from typing import Any

from tests.waiting import SECONDS

FOLDER = Path(__file__).parent


class Program:
    """A process that answers, of this interpreter or another.

    Args:
        name: the program.
        words: its arguments.
        python: the interpreter.
        within: what goes before the command, for one that runs elsewhere.
        folder: where it runs; the repository when left out.
        environment: what it has beside this process's.
    """

    def __init__(
        self,
        name: str,
        *words: str,
        python: str = sys.executable,
        within: Sequence[str] = (),
        folder: Path | None = None,
        **environment: str,
    ) -> None:
        repository = FOLDER.parents[1]
        variables = {} if folder is None else {"PYTHONPATH": str(repository)}
        self.process = subprocess.Popen(
            [*within, python, "-m", f"tests.wire.{name}", *words],
            cwd=folder or repository,
            env={**os.environ, **variables, **environment},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self._answers: Queue[str] = Queue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        assert self.answer() == "ready"

    def ask(self, question: str, *arguments: Any) -> Any:
        """The answer to a question."""
        return self._ask(SECONDS, question, arguments)

    def ask_slowly(self, question: str, *arguments: Any) -> Any:
        """The answer to a question that stands for much work."""
        return self._ask(5 * SECONDS, question, arguments)

    def ask_until(
        self, condition: Callable[[Any], object], question: str, *arguments: Any, seconds: float = SECONDS
    ) -> Any:
        """The first answer for which something holds."""
        until = time.monotonic() + seconds
        while True:
            answer = self.ask(question, *arguments)
            if condition(answer):
                return answer
            assert time.monotonic() < until, f"still {answer!r} after {SECONDS} s"
            time.sleep(0.05)

    def answer(self, seconds: float = SECONDS) -> Any:
        """What it says next; at once an error when it has ended."""
        try:
            result = self._answers.get(timeout=seconds)
        except Empty:
            result = ""
        if not result:
            self.process.kill()
            self._reader.join()
            raise AssertionError(f"silence; its errors: {self.process.communicate()[1]}")
        return json.loads(result)

    def kill(self) -> None:
        """End it as ``kill -9`` does."""
        self.process.kill()
        self.process.wait()

    def end(self) -> int:
        """End it by closing its standard input; its exit status."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        assert self.process.stderr is not None
        try:
            self.process.stdin.close()
            self.process.wait(timeout=60)
        except (OSError, subprocess.TimeoutExpired):
            self.process.kill()
            self.process.wait()
        self._reader.join(60)
        self.process.stdout.close()
        self.process.stderr.close()
        return self.process.returncode

    def _ask(self, seconds: float, question: str, arguments: Sequence[Any]) -> Any:
        assert self.process.stdin is not None
        print(json.dumps([question, *arguments]), file=self.process.stdin, flush=True)
        return self.answer(seconds)

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._answers.put(line)
        self._answers.put("")


def serve(answers: dict[str, Callable[..., Any]]) -> None:
    """In the program: answer questions until standard input is closed."""
    print(json.dumps("ready"), flush=True)
    for line in sys.stdin:
        question, *arguments = json.loads(line)
        print(json.dumps(answers[question](*arguments)), flush=True)


def linkwright(*words: str) -> tuple[str, str, int]:
    """What a command prints, its errors and its exit status."""
    result = subprocess.run(
        [sys.executable, "-m", "linkwright", *words], capture_output=True, text=True, timeout=60, check=False
    )
    return result.stdout, result.stderr, result.returncode
