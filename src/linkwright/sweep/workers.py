"""Runs a scenario in processes on this machine."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection, wait
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.sweep.plan import Run
from linkwright.sweep.running import Outcome, prepare, run_once
from linkwright.sweep.scenario import described

MOST_ATTEMPTS = 2
"""Attempts for a run whose process dies."""

_PATIENCE = 10.0
"""Seconds that a process may take to end before it is killed."""

Report = Callable[[Outcome], None]


def run_locally(path: Path, runs: Iterable[Run], workers: int, report: Report) -> None:
    """Run a scenario in separate processes.

    If a process dies, it is replaced, and its run is repeated once.

    Args:
        path: the scenario's file.
        runs: the runs to execute.
        workers: the number of parallel processes.
        report: called with the outcome of each run, in the order in which the runs finish.
    """
    waiting = deque(runs)
    attempts: dict[int, int] = {}
    busy: dict[Connection, _Worker] = {}
    idle: list[_Worker] = []
    try:
        while waiting or busy:
            while waiting and len(busy) < workers:
                worker = idle.pop() if idle else _Worker(path)
                worker.start_run(waiting.popleft())
                busy[worker.connection] = worker
            for ready in wait(list(busy)):
                worker = busy.pop(ready)  # type: ignore[call-overload]  # connections only were waited for
                outcome = worker.outcome()
                if outcome is not None:
                    idle.append(worker)
                    report(outcome)
                    continue
                run, died = worker.run, worker.end()
                attempts[run.row] = attempts.get(run.row, 0) + 1
                if attempts[run.row] < MOST_ATTEMPTS:
                    waiting.appendleft(run)
                else:
                    report(Outcome(run.row, error=f"the process that ran it {died}, twice"))
    finally:
        for worker in (*busy.values(), *idle):
            worker.stop()
        for worker in (*busy.values(), *idle):
            worker.end()


class _Worker:
    """A process that executes runs one after another, and the connection to this process."""

    def __init__(self, path: Path) -> None:
        spawn = multiprocessing.get_context("spawn")
        self.connection, theirs = spawn.Pipe()
        self.run = Run(0, {}, 0)
        self._process = spawn.Process(target=_serve, args=(path, theirs), daemon=True)
        with _no_interrupt():
            self._process.start()
        theirs.close()

    def start_run(self, run: Run) -> None:
        """Send a run to the process, which executes it."""
        self.run = run
        with suppress(OSError):  # the process has died, as the caller learns when waiting for the outcome
            self.connection.send(run)

    def outcome(self) -> Outcome | None:
        """Receive the outcome of the run; return None if the process has died."""
        try:
            outcome: Outcome = self.connection.recv()
        except (EOFError, OSError):
            return None
        return outcome

    def stop(self) -> None:
        """Terminate the process, even during a run."""
        self._process.terminate()

    def end(self) -> str:
        """Wait until the process has ended, and return a description of its exit status."""
        self.connection.close()
        self._process.join(_PATIENCE)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()
        status = self._process.exitcode or 0
        self._process.close()
        return f"was ended by {signal.Signals(-status).name}" if status < 0 else f"ended with status {status}"


def _serve(path: Path, connection: Connection) -> None:
    """Execute the runs received from the connection, as the main function of a worker."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    sys.stdout = sys.stderr
    with suppress(EOFError, OSError):
        try:
            scenario = prepare(path)
        except LinkwrightError as error:
            while True:
                run: Run = connection.recv()
                connection.send(Outcome(run.row, error=described(error)))
        while True:
            connection.send(run_once(scenario, connection.recv()))


def _end_with_parent() -> None:
    """Make this process end when its parent ends for any reason, so that no run outlives the parent."""
    parent = multiprocessing.parent_process()
    assert parent is not None, "it is a process of a pool"
    parent.join()
    os._exit(1)


@contextmanager
def _no_interrupt() -> Iterator[None]:
    """Block Ctrl-C in the context, in which a process is started.

    The new process inherits the blocked signal.
    """
    if sys.platform == "win32":
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
