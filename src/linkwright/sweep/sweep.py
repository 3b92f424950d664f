"""Run a sweep from its plan to its table."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from linkwright.files.whole_files import write_whole_file
from linkwright.sweep.execution import Outcome
from linkwright.sweep.journal import Journal, reporting_write_errors
from linkwright.sweep.page import format_summary
from linkwright.sweep.paths_file import format_paths
from linkwright.sweep.plan import Run, compute_fingerprint, plan_runs
from linkwright.sweep.scenario import Scenario
from linkwright.sweep.table import Table, encode_table

Runner = Callable[[Sequence[Run], Callable[[Outcome], None]], None]
"""Executes runs, and calls a function with the outcome of each run when it has finished."""


@dataclass(frozen=True)
class Sweep:
    """A scenario, with the files for its results.

    Attributes:
        scenario: the scenario.
        table: the file of the table; its extension selects the format.
        command: the command line of the sweep; the summary page shows it for reruns.
        paths: the file for the paths of robots; None if they are not recorded.
    """

    scenario: Scenario
    table: Path
    command: Sequence[str]
    paths: Path | None = None

    @property
    def page(self) -> Path:
        """The file of the summary page."""
        return self.table.with_suffix(".html")

    def run(self, runner: Runner, *, resume: bool, progress: Callable[[int, int, int], None]) -> Table:
        """Execute all runs without an outcome, and write the table and the summary page.

        Both are also written after an interruption by Ctrl-C.

        Args:
            runner: executes the runs.
            resume: whether to resume an unfinished sweep.
            progress: called with the numbers of finished, planned and failed runs.

        Returns:
            The table; after an interruption, without the remaining runs.

        Raises:
            LinkwrightError: an error of `Journal`; or SWEEP110, a file cannot be written.
        """
        runs = plan_runs(self.scenario, records_paths=self.paths is not None)
        with Journal(self.table, compute_fingerprint(self.scenario, runs), resume=resume) as journal:
            failed = sum(bool(outcome.error) for outcome in journal.outcomes.values())

            def on_outcome(outcome: Outcome) -> None:
                nonlocal failed
                journal.add(outcome)
                failed += bool(outcome.error)
                progress(len(journal.outcomes), len(runs), failed)

            with suppress(KeyboardInterrupt):
                runner([run for run in runs if run.row not in journal.outcomes], on_outcome)
        table = Table.of(runs, journal.outcomes)
        page = format_summary(table, self.scenario.path.name, shlex.join(self.command), len(runs))
        contents: list[tuple[Path, str | bytes]] = [(self.table, encode_table(table, self.table)), (self.page, page)]
        if self.paths is not None:
            contents.append((self.paths, format_paths(runs, journal.outcomes)))
        for path, content in contents:
            with reporting_write_errors(path):
                path.parent.mkdir(parents=True, exist_ok=True)
                write_whole_file(path, content)
        if len(table) == len(runs):
            journal.remove()
        return table
