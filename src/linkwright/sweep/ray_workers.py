"""Run a scenario in processes of a Ray cluster."""

from __future__ import annotations

import logging
import os
import socket
from collections import deque
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.diagnostics.extras import missing_extra
from linkwright.sweep.plan import Run
from linkwright.sweep.running import Outcome, load_into_process, run_once
from linkwright.sweep.scenario import Scenario, describe_error
from linkwright.sweep.workers import MAX_ATTEMPTS, Report

_RUNS_PER_PROCESSOR = 2
"""The number of runs that are submitted ahead for each processor of the cluster."""

_TIMEOUT_SECONDS = 10.0
"""The timeout of a connection to the cluster, in seconds."""

_scenario: Scenario | None = None
"""The scenario that this process of the cluster has loaded.

Ray uses a process for several runs.
"""


def run_on_ray(path: Path, runs: Iterable[Run], address: str, report: Report) -> None:
    """Run a scenario on a Ray cluster, to which the files in the scenario's folder are copied.

    If a process or a machine fails, its run is repeated once.

    Args:
        path: the file of the scenario.
        runs: the runs to execute.
        address: the address of the cluster, as ``ray.init`` accepts it.
        report: called with the outcome of each run when it has finished.

    Raises:
        LinkwrightError: SWEEP113, Ray is not installed; SWEEP114, there is no cluster at the address.
    """
    ray = _connect(path, address)
    try:
        run_remotely = ray.remote(max_retries=0)(_run_in_cluster)
        pending = deque(runs)
        attempts: dict[int, int] = {}
        running: dict[Any, Run] = {}
        max_running = max(int(ray.cluster_resources().get("CPU", 1)), 1) * _RUNS_PER_PROCESSOR
        while pending or running:
            while pending and len(running) < max_running:
                run = pending.popleft()
                running[run_remotely.remote(path.name, run)] = run
            for reference in ray.wait(list(running))[0]:
                run = running.pop(reference)
                try:
                    report(ray.get(reference))
                except ray.exceptions.RayError as error:
                    attempts[run.row] = attempts.get(run.row, 0) + 1
                    if attempts[run.row] < MAX_ATTEMPTS:
                        pending.appendleft(run)
                    else:
                        report(Outcome(run.row, error=f"the process of the run was lost twice: {type(error).__name__}"))
    finally:
        ray.shutdown()


def _connect(path: Path, address: str) -> Any:
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")  # disable usage statistics, which Ray sends without asking
    try:
        import ray  # type: ignore[import-not-found, import-untyped, unused-ignore]
    except ModuleNotFoundError as error:
        raise missing_extra("SWEEP113", error) from None
    try:
        _check_address(address)
        ray.init(
            address=address,
            runtime_env={"working_dir": str(path.parent)},
            log_to_driver=False,
            logging_level=logging.ERROR,
        )
    except (ConnectionError, ValueError, RuntimeError, OSError) as error:
        reason = foreign(" ".join(str(error).split()))
        message = phrase("there is no Ray cluster at '{address}': {reason}", address=address, reason=reason)
        hint = phrase("start a cluster with `ray start --head`, and use the address 'auto' on that machine")
        raise LinkwrightError(Diagnostic("SWEEP114", message, hint=hint)) from None
    return ray


def _check_address(address: str) -> None:
    """Raise if an address with a port does not accept connections.

    Without this check, Ray would retry for minutes, and log each attempt.

    Raises:
        OSError: the address does not accept connections.
    """
    host, _, port = address.removeprefix("ray://").rpartition(":")
    if host and port.isdigit():
        socket.create_connection((host, int(port)), _TIMEOUT_SECONDS).close()


def _run_in_cluster(name: str, run: Run) -> Outcome:
    """Execute a run in a process of the cluster, and return its outcome.

    The working directory of the process contains the copied files.
    """
    global _scenario  # noqa: PLW0603 - the process executes several runs
    path = Path(name).absolute()
    if _scenario is None or _scenario.path != path:
        try:
            _scenario = load_into_process(path)
        except LinkwrightError as error:
            return Outcome(run.row, error=describe_error(error))
    return run_once(_scenario, run)
