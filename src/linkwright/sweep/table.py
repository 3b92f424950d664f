"""The results of a sweep as one table, in CSV or Parquet."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.diagnostics.extras import missing_extra
from linkwright.sweep.execution import Outcome, Result
from linkwright.sweep.plan import Run
from linkwright.sweep.scenario import SEED

FORMAT_SUFFIXES = (".csv", ".parquet")


@dataclass(frozen=True)
class Table:
    """The runs of a sweep, ordered by row number.

    Attributes:
        parameters: the names of parameters, and ``seed``.
        results: the names of results, in the order of their first occurrence.
        columns: the columns by name, with a value for each row: ``row``, parameters, ``seed``, results, ``error``. A
            value that a row does not have is None.
    """

    parameters: tuple[str, ...]
    results: tuple[str, ...]
    columns: Mapping[str, Sequence[Result]]

    @classmethod
    def of(cls, runs: Sequence[Run], outcomes: Mapping[int, Outcome]) -> Table:
        """Return the table of the finished runs."""
        finished = [(run, outcomes[run.row]) for run in runs if run.row in outcomes]
        result_names = tuple(dict.fromkeys(name for _, outcome in finished for name in outcome.results))
        parameters = tuple(runs[0].parameters) if runs else ()
        columns: dict[str, list[Result]] = {"row": [run.row for run, _ in finished]}
        columns |= {name: [run.parameters[name] for run, _ in finished] for name in parameters}
        columns[SEED] = [run.seed for run, _ in finished]
        columns |= {name: [outcome.results.get(name) for _, outcome in finished] for name in result_names}
        columns["error"] = [outcome.error for _, outcome in finished]
        return cls((*parameters, SEED), result_names, columns)

    def __len__(self) -> int:
        return len(self.columns["row"])

    @property
    def failed_rows(self) -> list[int]:
        """The indices of the rows with an error."""
        return [index for index, error in enumerate(self.columns["error"]) if error]


def check_format(path: Path) -> None:
    """Raise if a table cannot be written to a file.

    Call this before the first run.

    Raises:
        LinkwrightError: SWEEP110, the extension is not supported; SWEEP111, pyarrow is not installed.
    """
    if path.suffix not in FORMAT_SUFFIXES or path.is_dir():
        message = phrase("a table cannot be written to '{path}'", path=str(path))
        raise LinkwrightError(Diagnostic("SWEEP110", message, hint=phrase("use a name that ends in .csv or .parquet")))
    if path.suffix == ".parquet":
        _load_pyarrow()


def encode_table(table: Table, path: Path) -> bytes:
    """Return the table in the format that the extension of a path selects."""
    return _to_parquet(table) if path.suffix == ".parquet" else _to_csv(table)


def _to_csv(table: Table) -> bytes:
    """Return the table as CSV with a header line.

    Floats keep their full precision.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(table.columns)
    writer.writerows([_format_cell(value) for value in row] for row in zip(*table.columns.values(), strict=True))
    return text.getvalue().encode()


def _format_cell(value: Result) -> str:
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _to_parquet(table: Table) -> bytes:
    arrow = _load_pyarrow()
    import pyarrow.parquet as pq  # type: ignore[import-not-found, import-untyped, unused-ignore]

    columns = {name: arrow.array(_to_one_type(values)) for name, values in table.columns.items()}
    file = io.BytesIO()
    pq.write_table(arrow.table(columns), file)
    return file.getvalue()


def _to_one_type(values: Sequence[Result]) -> list[Result]:
    """Return values converted to one type, as a Parquet column requires.

    Integers and floats become floats. Other mixed types become strings.
    """
    types = {type(value) for value in values if value is not None}
    if len(types) < 2:
        return list(values)
    if types == {int, float}:
        return [None if value is None else float(value) for value in values]
    return [None if value is None else _format_cell(value) for value in values]


def _load_pyarrow() -> Any:
    try:
        import pyarrow as pa  # type: ignore[import-not-found, import-untyped, unused-ignore]
    except ModuleNotFoundError as error:
        raise missing_extra("SWEEP111", error) from None
    return pa
