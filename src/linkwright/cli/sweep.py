"""``linkwright sweep``: run a scenario with several parameter values and seeds."""

from __future__ import annotations

import argparse
import os
import time
import traceback
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import FINDINGS, FINE, print_message
from linkwright.cli.model_arguments import add_values
from linkwright.cli.numbers import positive_int
from linkwright.cli.progress import ProgressLine
from linkwright.diagnostics import Diagnostic, LinkwrightError, counted, display_path, phrase
from linkwright.diagnostics.translation import localized
from linkwright.process.assignments import parse_assignments
from linkwright.process.interruption import INTERRUPTED
from linkwright.process.processors import usable_processors

if TYPE_CHECKING:
    from linkwright.sweep.scenario import Scenario
    from linkwright.sweep.sweep import Runner
    from linkwright.sweep.table import Table


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``sweep``."""
    parser.add_argument("file", metavar="FILE", help="a Python file with a function decorated with @scenario(...)")
    add_values(
        parser,
        values_help="values of a parameter, separated by commas, which replace its values in the file",
        metavar="NAME:=VALUES",
    )
    parser.add_argument(
        "--seeds",
        metavar="N",
        type=positive_int,
        help="the number of seeds, which start at 0 and replace the seeds in the file",
    )
    parser.add_argument(
        "--workers",
        metavar="N",
        type=positive_int,
        help="the number of parallel processes (default: one for each processor)",
    )
    parser.add_argument(
        "--out",
        metavar="TABLE",
        help="the file of the table, .csv or .parquet; the summary is written beside it (default: the "
        "name of FILE, with .csv)",
    )
    parser.add_argument(
        "--paths",
        metavar="FILE",
        type=Path,
        help="write the paths of the robots, and results that are paths, of each run as JSON",
    )
    parser.add_argument("--resume", action="store_true", help="resume an interrupted sweep")
    parser.add_argument("--rerun", metavar="ROW", type=positive_int, help="run one row again, and print its results")
    parser.add_argument(
        "--ray", metavar="ADDRESS", help="run on a Ray cluster: auto, local, HOST:PORT or ray://HOST:PORT"
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the sweep.

    Returns:
        0, 1 if a run failed, or 130 if the sweep was interrupted.
    """
    from linkwright.sweep.execution import load_into_process
    from linkwright.sweep.plan import plan_runs, replace_values
    from linkwright.sweep.sweep import Sweep
    from linkwright.sweep.table import check_format

    path = Path(arguments.file).absolute()
    table_path = Path(arguments.out or f"{path.stem}.csv").absolute()
    check_format(table_path)
    start_folder = Path.cwd()
    scenario = replace_values(load_into_process(path), parse_assignments(arguments.values), arguments.seeds)
    if arguments.rerun is not None:
        return _rerun(scenario, arguments.rerun)
    os.chdir(start_folder)  # `prepare` changed to the folder of the scenario
    command = ["linkwright", "sweep", arguments.file, *arguments.values]
    if arguments.seeds is not None:
        command += ["--seeds", str(arguments.seeds)]
    start_time = time.monotonic()
    paths = None if arguments.paths is None else arguments.paths.absolute()
    sweep = Sweep(scenario, table_path, command, paths)
    progress = _Progress()
    table = sweep.run(_choose_runner(arguments, path), resume=arguments.resume, progress=progress.show)
    progress.end()
    missing = len(plan_runs(scenario)) - len(table)
    _print_summary(table, time.monotonic() - start_time, progress.run_count)
    for created_file in filter(None, (sweep.table, sweep.page, sweep.paths)):
        print(localized(phrase("Created file {file}", file=display_path(created_file))))
    if missing:
        missing_runs = counted("{count} run is left", "{count} runs are left", missing)
        print_message(localized(phrase("{left}; `--resume` continues the sweep", left=missing_runs)))
        return INTERRUPTED
    return FINDINGS if table.failed_rows else FINE


def _choose_runner(arguments: argparse.Namespace, path: Path) -> Runner:
    if arguments.ray is not None:
        from linkwright.sweep.ray_workers import run_on_ray

        return lambda runs, report: run_on_ray(path, runs, arguments.ray, report)
    from linkwright.sweep.workers import run_locally

    workers = arguments.workers or usable_processors()
    return lambda runs, report: run_locally(path, runs, workers, report)


def _rerun(scenario: Scenario, row: int) -> int:
    """Run one row of the sweep in this process, and print its parameters and its outcome."""
    from linkwright.sweep.execution import run_scenario
    from linkwright.sweep.plan import plan_runs

    runs = plan_runs(scenario)
    if row > len(runs):
        message = phrase("there is no row {row}", row=row)
        hint = phrase("the sweep has rows 1 to {count}", count=len(runs))
        raise LinkwrightError(Diagnostic("SWEEP112", message, hint=hint))
    scenario_run = runs[row - 1]
    for name, value in {**scenario_run.parameters, "seed": scenario_run.seed}.items():
        print(f"{name}: {value}", flush=True)
    try:
        results = run_scenario(scenario, scenario_run).results
    except (Exception, SystemExit) as error:  # noqa: BLE001 - a scenario may raise any exception
        traceback.print_exception(error)
        return FINDINGS
    for name, result in results.items():
        print(f"{name}: {result}")
    return FINE


class _Progress:
    """The progress line of a sweep, with a count of the runs."""

    def __init__(self) -> None:
        self.run_count = 0
        self._line = ProgressLine()

    def show(self, done_count: int, count: int, failed_count: int) -> None:
        """Count a run, and show the numbers of finished and of failed runs."""
        self.run_count += 1
        self._line.show(
            phrase("{done} of {count} runs, {failed} failed", done=done_count, count=count, failed=failed_count)
        )

    def end(self) -> None:
        """End the progress line."""
        self._line.end()


def _print_summary(table: Table, seconds: float, finished_runs: int) -> None:
    """Print the number of runs, the duration and the number of failures to standard error."""
    summary = phrase(
        "{runs} in {seconds} s, {rate} per second, {failed} failed",
        runs=counted("{count} run", "{count} runs", finished_runs),
        seconds=f"{seconds:.1f}",
        rate=f"{finished_runs / max(seconds, 1e-9):.1f}",
        failed=len(table.failed_rows),
    )
    print_message(localized(summary))
