"""Processes of a Ray cluster that run a scenario."""

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
"""For each processor of the cluster so many runs are handed out."""

_PATIENCE = 10.0
"""Seconds for a machine to answer."""

_scenario: Scenario | None = None
"""What a process of the cluster has loaded: processes are the cluster's, and used again."""


def run_on_ray(path: Path, runs: Iterable[Run], address: str, report: Report) -> None:
    """Run a scenario on a Ray cluster; what is in its folder is sent there.

    Where a process or machine is lost, its run is tried once more.

    Args:
        path: the scenario's file.
        runs: what is to be run.
        address: that of the cluster, as ``ray.init`` takes it.
        report: told of each run when it is done.

    Raises:
        LinkwrightError: SWEEP113 ray is not installed; SWEEP114 there is no cluster at the address.
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
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")  # nothing is told to anybody unasked
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
        hint = phrase("`ray start --head` begins one; its address is then auto on that machine")
        raise LinkwrightError(Diagnostic("SWEEP114", message, hint=hint)) from None
    return ray


def _reach(address: str) -> None:
    """Find out whether anybody listens at an address with a port: Ray would try for minutes, and tell of each time.

    Raises:
        OSError: nobody does.
    """
    host, _, port = address.removeprefix("ray://").rpartition(":")
    if host and port.isdigit():
        socket.create_connection((host, int(port)), _PATIENCE).close()


def _run_there(name: str, run: Run) -> Outcome:
    """What a process of the cluster does; its working directory has what was sent."""
    global _scenario  # noqa: PLW0603 - the process is used for one run after the other
    path = Path(name).absolute()
    if _scenario is None or _scenario.path != path:
        try:
            _scenario = prepare(path)
        except LinkwrightError as error:
            return Outcome(run.row, error=described(error))
    return run_once(_scenario, run)
