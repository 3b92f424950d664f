"""Tasks on a Ray cluster: the connection, and the repetition of lost tasks."""

from __future__ import annotations

import logging
import os
import socket
from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.diagnostics.extras import missing_extra
from linkwright.sweep.workers import MAX_ATTEMPTS

_TASKS_PER_PROCESSOR = 2
"""The number of tasks that are submitted ahead for each processor of the cluster."""

_LOCAL_ADDRESS = "local"
"""The address for which Ray starts a cluster on this computer."""

_TIMEOUT_S = 10.0
"""The timeout of a connection to the cluster, in seconds."""

Result = TypeVar("Result")


@dataclass(frozen=True)
class LostTask:
    """A task whose process was lost each time.

    Attributes:
        error: the name of Ray's error.
    """

    error: str


class RayCluster:
    """A connection to a Ray cluster.

    Args:
        ray: the module.
    """

    def __init__(self, ray: Any) -> None:
        self._ray = ray

    def share(self, value: object) -> Any:
        """Copy a value to the cluster, and return a reference; tasks that get it receive the value."""
        return self._ray.put(value)

    def run_tasks(
        self, function: Callable[..., Result], tasks: Iterable[tuple[Any, ...]]
    ) -> Iterator[tuple[int, Result | LostTask]]:
        """Call a function in the cluster's processes, and yield each result with its task's index.

        If a process or a machine fails, its task is repeated once.

        Args:
            function: the function, which the processes import.
            tasks: the arguments of each call.
        """
        ray = self._ray
        call_remotely = ray.remote(max_retries=0)(function)
        max_running = max(int(ray.cluster_resources().get("CPU", 1)), 1) * _TASKS_PER_PROCESSOR
        waiting = enumerate(tasks)
        repeated_tasks: deque[tuple[int, tuple[Any, ...]]] = deque()
        failures: Counter[int] = Counter()
        running: dict[Any, tuple[int, tuple[Any, ...]]] = {}
        while True:
            while len(running) < max_running and (
                task := repeated_tasks.popleft() if repeated_tasks else next(waiting, None)
            ):
                running[call_remotely.remote(*task[1])] = task
            if not running:
                return
            for reference in ray.wait(list(running))[0]:
                index, arguments = running.pop(reference)
                try:
                    result = ray.get(reference)
                except ray.exceptions.RayError as error:
                    failures[index] += 1
                    if failures[index] < MAX_ATTEMPTS:
                        repeated_tasks.append((index, arguments))
                    else:
                        yield index, LostTask(type(error).__name__)
                else:
                    yield index, result


@contextmanager
def connect_to_ray(address: str, folder: Path | None = None) -> Iterator[RayCluster]:
    """Connect to a Ray cluster, and disconnect at the end.

    Args:
        address: the address of the cluster, as ``ray.init`` accepts it.
        folder: a folder whose files are copied to the working directory of Ray's worker processes.

    Raises:
        LinkwrightError: SWEEP113, Ray is not installed; SWEEP114, there is no cluster at the address, or Ray does not
            start on this computer.
    """
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")  # disable usage statistics, which Ray sends without asking
    try:
        import ray  # type: ignore[import-not-found, import-untyped, unused-ignore]
    except ModuleNotFoundError as error:
        raise missing_extra("SWEEP113", error) from None
    try:
        _check_address(address)
        ray.init(
            address=address,
            runtime_env={} if folder is None else {"working_dir": str(folder)},
            log_to_driver=False,
            logging_level=logging.ERROR,
        )
    except Exception as error:  # noqa: BLE001 - Ray raises plain exceptions if its processes do not start
        reason = foreign(" ".join(str(error).split()))
        if address == _LOCAL_ADDRESS:
            message = phrase("Ray does not start on this computer: {reason}", reason=reason)
            hint = phrase("try again when the computer is less busy, or omit `--ray`")
        else:
            message = phrase("there is no Ray cluster at '{address}': {reason}", address=address, reason=reason)
            hint = phrase("start a cluster with `ray start --head`, and use the address 'auto' on that machine")
        raise LinkwrightError(Diagnostic("SWEEP114", message, hint=hint)) from None
    try:
        yield RayCluster(ray)
    finally:
        ray.shutdown()


def _check_address(address: str) -> None:
    """Raise if an address with a port does not accept connections.

    Without this check, Ray would retry for minutes, and log each attempt.

    Raises:
        OSError: the address does not accept connections.
    """
    host, _, port = address.removeprefix("ray://").rpartition(":")
    if host and port.isdigit():
        socket.create_connection((host, int(port)), _TIMEOUT_S).close()
