"""A file with the finished runs of a sweep, for resuming the sweep.

The file is next to the table. It has a line for the plan, and then one line per run.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from io import FileIO
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.sweep.execution import Outcome

if TYPE_CHECKING:
    from typing_extensions import Self

_JOURNAL_SUFFIX = ".unfinished"


class Journal:
    """The outcomes of a sweep that is not complete, in a file.

    Args:
        table: the path of the table's file.
        fingerprint: the hash of the plan; a journal of another plan is rejected.
        resume: whether to continue with an existing journal.

    Attributes:
        path: the path of the journal's file.
        outcomes: the outcomes by row number.

    Raises:
        LinkwrightError: SWEEP107, there is a journal, and `resume` is not set; SWEEP108, the journal belongs to another
            plan; SWEEP109, there is no journal to resume; SWEEP110, the file cannot be written.
    """

    def __init__(self, table: Path, fingerprint: str, *, resume: bool) -> None:
        self.path = table.with_name(f"{table.name}{_JOURNAL_SUFFIX}")
        self.outcomes: dict[int, Outcome] = {}
        self._plan_entry = {"plan": fingerprint}
        self._file: FileIO | None = None
        is_present = self.path.exists()
        if resume:
            if not is_present:
                message = phrase("there is no unfinished sweep '{path}'", path=display_path(table))
                hint = phrase("omit `--resume` to start a new sweep")
                raise LinkwrightError(Diagnostic("SWEEP109", message, hint=hint))
            self._read()
        elif is_present:
            message = phrase("the sweep '{path}' is not finished", path=display_path(table))
            hint = phrase("use `--resume` to continue, or remove '{path}' to start again", path=display_path(self.path))
            raise LinkwrightError(Diagnostic("SWEEP107", message, hint=hint))

    def __enter__(self) -> Self:
        entries = [self._plan_entry, *map(_to_entry, self.outcomes.values())]
        with reporting_write_errors(self.path):
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._file = self.path.open("wb", buffering=0)
        try:
            for entry in entries:
                self._write(entry)
        except LinkwrightError:
            self._file.close()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        assert self._file is not None, "it was entered"
        self._file.close()
        if error is not None and not self.outcomes:
            self.remove()

    def add(self, outcome: Outcome) -> None:
        """Append an outcome to the file.

        Raises:
            LinkwrightError: SWEEP110, the file cannot be written.
        """
        self.outcomes[outcome.row] = outcome
        self._write(_to_entry(outcome))

    def remove(self) -> None:
        """Delete the file, because the sweep is complete."""
        self.path.unlink()

    def _write(self, line: dict[str, Any]) -> None:
        assert self._file is not None, "it was entered"
        remaining = f"{json.dumps(line)}\n".encode()
        with reporting_write_errors(self.path):
            while remaining:
                remaining = remaining[self._file.write(remaining) :]

    def _read(self) -> None:
        lines = self.path.read_text(encoding="utf-8", errors="replace").splitlines()
        entries = [entry for entry in map(_parse_line, lines) if entry is not None]
        if not entries or entries[0] != self._plan_entry:
            message = phrase(
                "the runs of the unfinished sweep '{path}' differ from the runs of this one",
                path=display_path(self.path),
            )
            hint = phrase("use the same scenario, values, seeds and `--paths`, or remove the file to start again")
            raise LinkwrightError(Diagnostic("SWEEP108", message, hint=hint))
        for entry in entries[1:]:
            self.outcomes[entry["row"]] = Outcome(**entry)


@contextmanager
def reporting_write_errors(path: Path) -> Iterator[None]:
    """Raise a LinkwrightError for an OSError that occurs in the context.

    Raises:
        LinkwrightError: SWEEP110, the file cannot be written.
    """
    try:
        yield
    except OSError as error:
        reason = foreign(error.strerror or error)
        message = phrase("cannot write '{path}': {reason}", path=display_path(path), reason=reason)
        hint = phrase("choose a file in a writable folder")
        raise LinkwrightError(Diagnostic("SWEEP110", message, hint=hint)) from None


def _to_entry(outcome: Outcome) -> dict[str, Any]:
    return {"row": outcome.row, "results": outcome.results, "error": outcome.error, "paths": outcome.paths}


def _parse_line(line: str) -> dict[str, Any] | None:
    """Return the content of a line of the journal, or None if the line is truncated."""
    try:
        entry = json.loads(line)
    except ValueError:
        return None
    return entry if isinstance(entry, dict) else None
