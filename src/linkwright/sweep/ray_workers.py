"""Runs a scenario in processes of a Ray cluster."""

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
from linkwright.sweep.running import Outcome, prepare, run_once
from linkwright.sweep.scenario import Scenario, described
from linkwright.sweep.workers import MOST_ATTEMPTS, Report

_AHEAD = 2
"""Runs that are handed out at once for each processor of the cluster."""

_PATIENCE = 10.0
"""Seconds for a machine to answer."""

_scenario: Scenario | None = None
"""The scenario that a process of the cluster has loaded: the cluster uses its processes for several runs."""


def run_on_ray(path: Path, runs: Iterable[Run], address: str, report: Report) -> None:
    """Run a scenario on a Ray cluster, after copying the files in the scenario's folder to it.

    If a process or machine fails, its run is repeated once.

    Args:
        path: the scenario's file.
        runs: the runs to execute.
        address: the address of the cluster, as ``ray.init`` accepts it.
        report: called with the outcome of each run when the run has finished.

    Raises:
        LinkwrightError: SWEEP113, ray is not installed; SWEEP114, there is no cluster at the address.
    """
    ray = _connected(path, address)
    try:
        run_there = ray.remote(max_retries=0)(_run_there)
        waiting = deque(runs)
        attempts: dict[int, int] = {}
        busy: dict[Any, Run] = {}
        most = max(int(ray.cluster_resources().get("CPU", 1)), 1) * _AHEAD
        while waiting or busy:
            while waiting and len(busy) < most:
                run = waiting.popleft()
                busy[run_there.remote(path.name, run)] = run
            for ready in ray.wait(list(busy))[0]:
                run = busy.pop(ready)
                try:
                    report(ray.get(ready))
                except ray.exceptions.RayError as error:
                    attempts[run.row] = attempts.get(run.row, 0) + 1
                    if attempts[run.row] < MOST_ATTEMPTS:
                        waiting.appendleft(run)
                    else:
                        report(
                            Outcome(run.row, error=f"the process that ran it was lost, twice: {type(error).__name__}")
                        )
    finally:
        ray.shutdown()


def _connected(path: Path, address: str) -> Any:
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")  # disable usage statistics, which Ray sends without asking
    try:
        import ray  # type: ignore[import-not-found, import-untyped, unused-ignore]
    except ModuleNotFoundError as error:
        raise missing_extra("SWEEP113", error) from None
    try:
        _reach(address)
        ray.init(
            address=address,
            runtime_env={"working_dir": str(path.parent)},
            log_to_driver=False,
            logging_level=logging.ERROR,
        )
    except (ConnectionError, ValueError, RuntimeError, OSError) as error:
        reason = foreign(" ".join(str(error).split()))
        message = phrase("there is no Ray cluster at '{address}': {reason}", address=address, reason=reason)
        hint = phrase("start one with `ray start --head`, and use the address auto on that machine")
        raise LinkwrightError(Diagnostic("SWEEP114", message, hint=hint)) from None
    return ray


def _reach(address: str) -> None:
    """Check that an address accepts connections, if it has a port.

    Without this check, Ray would retry for minutes, and log each attempt.

    Raises:
        OSError: the address does not accept connections.
    """
    host, _, port = address.removeprefix("ray://").rpartition(":")
    if host and port.isdigit():
        socket.create_connection((host, int(port)), _PATIENCE).close()


def _run_there(name: str, run: Run) -> Outcome:
    """Execute a run in a process of the cluster.

    The working directory of the process contains the copied files.
    """
    global _scenario  # noqa: PLW0603 - the process is used for one run after the other
    path = Path(name).absolute()
    if _scenario is None or _scenario.path != path:
        try:
            _scenario = prepare(path)
        except LinkwrightError as error:
            return Outcome(run.row, error=described(error))
    return run_once(_scenario, run)
