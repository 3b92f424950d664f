"""The finished runs of a sweep, in a file beside the table, so that the sweep can be resumed.

The file has one line per run.
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
from linkwright.sweep.running import Outcome

if TYPE_CHECKING:
    from typing_extensions import Self

_ENDING = ".unfinished"


class Journal:
    """The outcomes of a sweep that is not complete yet.

    Args:
        table: the file of the table.
        fingerprint: the fingerprint of the plan; a journal of another plan is rejected.
        resume: whether to resume an existing journal.

    Attributes:
        path: the file of the journal.
        outcomes: the outcomes by row number.

    Raises:
        LinkwrightError: SWEEP107, there is a journal, and `resume` is not set; SWEEP108, the journal belongs to another
            plan; SWEEP109, there is no journal to resume; SWEEP110, the file cannot be written.
    """

    def __init__(self, table: Path, fingerprint: str, *, resume: bool) -> None:
        self.path = table.with_name(f"{table.name}{_ENDING}")
        self.outcomes: dict[int, Outcome] = {}
        self._head = {"plan": fingerprint}
        self._file: FileIO | None = None
        there = self.path.exists()
        if resume:
            if not there:
                message = phrase("there is no unfinished sweep '{path}'", path=display_path(table))
                hint = phrase("omit `--resume` to start one")
                raise LinkwrightError(Diagnostic("SWEEP109", message, hint=hint))
            self._read()
        elif there:
            message = phrase("the sweep '{path}' is not finished", path=display_path(table))
            hint = phrase("use `--resume` to continue, or remove '{path}' to start again", path=display_path(self.path))
            raise LinkwrightError(Diagnostic("SWEEP107", message, hint=hint))

    def __enter__(self) -> Self:
        known = [self._head, *map(_line, self.outcomes.values())]
        with reporting_write_errors(self.path):
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._file = self.path.open("wb", buffering=0)
        try:
            for entry in known:
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
        self._write(_line(outcome))

    def remove(self) -> None:
        """Delete the file after the sweep is complete."""
        self.path.unlink()

    def _write(self, line: dict[str, Any]) -> None:
        assert self._file is not None, "it was entered"
        left = f"{json.dumps(line)}\n".encode()
        with reporting_write_errors(self.path):
            while left:
                left = left[self._file.write(left) :]

    def _read(self) -> None:
        lines = self.path.read_text(encoding="utf-8", errors="replace").splitlines()
        entries = [parsed for parsed in map(_parsed, lines) if parsed is not None]
        if not entries or entries[0] != self._head:
            message = phrase("the unfinished sweep '{path}' has different runs", path=display_path(self.path))
            hint = phrase("give the same scenario, values and seeds, or remove that file to start again")
            raise LinkwrightError(Diagnostic("SWEEP108", message, hint=hint))
        for entry in entries[1:]:
            self.outcomes[entry["row"]] = Outcome(**entry)


@contextmanager
def reporting_write_errors(path: Path) -> Iterator[None]:
    """Convert an OSError in the context to a LinkwrightError.

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


def _line(outcome: Outcome) -> dict[str, Any]:
    return {"row": outcome.row, "results": outcome.results, "error": outcome.error}


def _parsed(line: str) -> dict[str, Any] | None:
    """Parse a line of the journal; return None for a truncated line."""
    try:
        entry = json.loads(line)
    except ValueError:
        return None
    return entry if isinstance(entry, dict) else None
