"""Run a scenario in processes on this machine."""

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
from linkwright.sweep.execution import Outcome, load_into_process, run_once
from linkwright.sweep.plan import Run
from linkwright.sweep.scenario import describe_error

MAX_ATTEMPTS = 2
"""The maximum number of attempts for a run whose process dies."""

_TIMEOUT_S = 10.0
"""The seconds that a process has to exit before it is killed."""

Report = Callable[[Outcome], None]


def run_locally(path: Path, runs: Iterable[Run], workers: int, report: Report) -> None:
    """Run a scenario in separate processes.

    If a process dies, it is replaced, and its run is repeated once.

    Args:
        path: the file of the scenario.
        runs: the runs to execute.
        workers: the number of parallel processes.
        report: called with the outcome of each run when it has finished.
    """
    pending = deque(runs)
    attempts: dict[int, int] = {}
    busy_workers: dict[Connection, _Worker] = {}
    idle_workers: list[_Worker] = []
    try:
        while pending or busy_workers:
            while pending and len(busy_workers) < workers:
                worker = idle_workers.pop() if idle_workers else _Worker(path)
                worker.start_run(pending.popleft())
                busy_workers[worker.connection] = worker
            for connection in wait(list(busy_workers)):
                worker = busy_workers.pop(connection)  # type: ignore[call-overload]  # only connections are waited for
                outcome = worker.receive_outcome()
                if outcome is not None:
                    idle_workers.append(worker)
                    report(outcome)
                    continue
                run, exit_description = worker.run, worker.wait_for_end()
                attempts[run.row] = attempts.get(run.row, 0) + 1
                if attempts[run.row] < MAX_ATTEMPTS:
                    pending.appendleft(run)
                else:
                    report(Outcome(run.row, error=f"the process of the run {exit_description}, twice"))
    finally:
        for worker in (*busy_workers.values(), *idle_workers):
            worker.stop()
        for worker in (*busy_workers.values(), *idle_workers):
            worker.wait_for_end()


class _Worker:
    """A process that executes one run after another, and the connection to it."""

    def __init__(self, path: Path) -> None:
        spawn = multiprocessing.get_context("spawn")
        self.connection, child_connection = spawn.Pipe()
        self.run = Run(0, {}, 0)
        self._process = spawn.Process(target=_run_worker, args=(path, child_connection), daemon=True)
        with _block_interrupts():
            self._process.start()
        child_connection.close()

    def start_run(self, run: Run) -> None:
        """Send a run to the process for execution."""
        self.run = run
        with suppress(OSError):  # the process has died; the caller notices this when waiting for the outcome
            self.connection.send(run)

    def receive_outcome(self) -> Outcome | None:
        """Return the outcome of the run, or None if the process has died."""
        try:
            received_outcome: Outcome = self.connection.recv()
        except (EOFError, OSError):
            return None
        return received_outcome

    def stop(self) -> None:
        """Terminate the process, even during a run."""
        self._process.terminate()

    def wait_for_end(self) -> str:
        """Wait until the process has ended, and describe its end as a clause without a subject."""
        self.connection.close()
        self._process.join(_TIMEOUT_S)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()
        status = self._process.exitcode or 0
        self._process.close()
        return f"was ended by {signal.Signals(-status).name}" if status < 0 else f"ended with status {status}"


def _run_worker(path: Path, connection: Connection) -> None:
    """Execute the runs that arrive on the connection, in a worker process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_exit_with_parent, daemon=True).start()
    sys.stdout = sys.stderr
    with suppress(EOFError, OSError):
        try:
            scenario = load_into_process(path)
        except LinkwrightError as error:
            while True:
                run: Run = connection.recv()
                connection.send(Outcome(run.row, error=describe_error(error)))
        while True:
            connection.send(run_once(scenario, connection.recv()))


def _exit_with_parent() -> None:
    """Exit this process when its parent ends for any reason, so that no run outlives the parent."""
    parent = multiprocessing.parent_process()
    assert parent is not None, "it is a process of a pool"
    parent.join()
    os._exit(1)


@contextmanager
def _block_interrupts() -> Iterator[None]:
    """Block Ctrl-C while a process is started in the context.

    The new process inherits the blocked signal.
    """
    if sys.platform == "win32":
        yield
        return
    previous_mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, previous_mask)
