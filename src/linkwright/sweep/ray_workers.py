"""Run a scenario in processes of a Ray cluster."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.sweep.execution import Outcome, load_into_process, run_once
from linkwright.sweep.plan import Run
from linkwright.sweep.ray_cluster import LostTask, connect_to_ray
from linkwright.sweep.scenario import Scenario, describe_error
from linkwright.sweep.workers import Report

_scenario: Scenario | None = None
"""The scenario that this process of the cluster has loaded.

Ray uses a process for several runs.
"""


def run_on_ray(path: Path, runs: Iterable[Run], address: str, report: Report) -> None:
    """Copy the files in a scenario's folder to a Ray cluster, and run the scenario there.

    If a process or a machine fails, its run is repeated once.

    Args:
        path: the file of the scenario.
        runs: the runs to execute.
        address: the address of the cluster, as ``ray.init`` accepts it.
        report: called with the outcome of each run when it has finished.

    Raises:
        LinkwrightError: SWEEP113, Ray is not installed; SWEEP114, there is no cluster at the address.
    """
    planned = list(runs)
    with connect_to_ray(address, path.parent) as cluster:
        for index, outcome in cluster.run_tasks(_run_in_cluster, ((path.name, run) for run in planned)):
            if isinstance(outcome, LostTask):
                message = f"the process of the run was lost twice: {outcome.error}"
                report(Outcome(planned[index].row, error=message))
            else:
                report(outcome)


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
