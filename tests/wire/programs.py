"""Control of a program of this folder in another process.

Each question and each answer is a line of JSON.
"""

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

from tests.waiting import TIMEOUT_S

FOLDER = Path(__file__).parent


class Program:
    """A process that answers questions, with this interpreter or another.

    Args:
        name: the program.
        arguments: its arguments.
        python: the interpreter.
        within: the words before the command, such as those that run it on another host.
        folder: its working directory; by default the repository.
        environment: variables in addition to those of this process.
    """

    def __init__(
        self,
        name: str,
        *arguments: str,
        python: str = sys.executable,
        prefix_words: Sequence[str] = (),
        folder: Path | None = None,
        **environment: str,
    ) -> None:
        repository = FOLDER.parents[1]
        variables = {} if folder is None else {"PYTHONPATH": str(repository)}
        self.process = subprocess.Popen(
            [*prefix_words, python, "-m", f"tests.wire.{name}", *arguments],
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
        """Ask a question, and return the answer."""
        return self._ask(TIMEOUT_S, question, arguments)

    def ask_slowly(self, question: str, *arguments: Any) -> Any:
        """Ask a question that takes long to answer, and return the answer."""
        return self._ask(5 * TIMEOUT_S, question, arguments)

    def ask_until(
        self, condition: Callable[[Any], object], question: str, *arguments: Any, seconds: float = TIMEOUT_S
    ) -> Any:
        """Repeat a question until the answer meets a condition, and return that answer."""
        deadline = time.monotonic() + seconds
        while True:
            answer = self.ask(question, *arguments)
            if condition(answer):
                return answer
            assert time.monotonic() < deadline, f"still {answer!r} after {TIMEOUT_S} s"
            time.sleep(0.05)

    def answer(self, seconds: float = TIMEOUT_S) -> Any:
        """Return the next answer; fail at once if the process has ended."""
        try:
            result = self._answers.get(timeout=seconds)
        except Empty:
            result = ""
        if not result:
            self.process.kill()
            self._reader.join()
            raise AssertionError(f"no answer; its errors: {self.process.communicate()[1]}")
        return json.loads(result)

    def kill(self) -> None:
        """Kill the process as ``kill -9`` does."""
        self.process.kill()
        self.process.wait()

    def end(self) -> int:
        """End the process by closing its standard input, and return its exit status."""
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
    """Answer questions until standard input is closed; for use in the program."""
    print(json.dumps("ready"), flush=True)
    for line in sys.stdin:
        question, *arguments = json.loads(line)
        print(json.dumps(answers[question](*arguments)), flush=True)


def linkwright(*arguments: str) -> tuple[str, str, int]:
    """Run a command, and return its output, its errors and its exit status."""
    result = subprocess.run(
        [sys.executable, "-m", "linkwright", *arguments], capture_output=True, text=True, timeout=60, check=False
    )
    return result.stdout, result.stderr, result.returncode
