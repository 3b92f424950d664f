"""A file with the marks of an unfinished grading, from which the next run resumes."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path

from linkwright._version import __version__
from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.learning.grading.jobs import Job
from linkwright.learning.grading.marks import Mark

SUFFIX = ".unfinished"


class Journal:
    """A store of marks by a hash of their inputs.

    The inputs are the course, the student's files and answer, and the limits.

    Args:
        path: the file; None to store nothing.
    """

    def __init__(self, path: Path | None) -> None:
        self.path = path
        self._marks: dict[str, Mark] = {}
        if path is not None and path.exists():
            self._read(path)

    def _read(self, path: Path) -> None:
        with report_write_errors(path):
            lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
        for line in lines:
            with suppress(ValueError, KeyError, TypeError):  # a line that was not written completely
                entry = json.loads(line)
                self._marks[entry["key"]] = Mark.from_data(entry["mark"])

    def find(self, key: str) -> Mark | None:
        """Return the mark with a key from an interrupted run, or None."""
        return self._marks.get(key)

    def add(self, key: str, mark: Mark) -> None:
        """Append a mark and the key of its inputs to the file, if there is a file.

        Raises:
            LinkwrightError: LEARN121, the file cannot be written.
        """
        if self.path is None:
            return
        line = json.dumps({"key": key, "mark": mark.to_data()})
        with report_write_errors(self.path), self.path.open("a", encoding="utf-8") as file:
            file.write(f"\n{line}")  # the last line of an interrupted run may be incomplete

    def remove(self) -> None:
        """Delete the file after all marks are written to the result."""
        if self.path is not None:
            self.path.unlink(missing_ok=True)


@contextmanager
def report_write_errors(path: Path) -> Iterator[None]:
    """Raise LEARN121 in place of an OSError in the context."""
    try:
        yield
    except OSError as error:
        message = phrase(
            "cannot write '{path}': {reason}", path=display_path(path), reason=foreign(error.strerror or error)
        )
        raise LinkwrightError(
            Diagnostic("LEARN121", message, hint=phrase("choose a file in a writable folder"))
        ) from None


def hash_folder(folder: Path) -> str:
    """Return a hash of the names and contents of all files in a folder."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            name, content = os.fsencode(path.relative_to(folder)), path.read_bytes()
            digest.update(b"%d %d %s" % (len(name), len(content), name))
            digest.update(content)
    return digest.hexdigest()


def compute_mark_key(job: Job, course: str, copy: str) -> str:
    """Return the key of a job's mark, a hash of all inputs of the mark."""
    parts = [__version__, course, copy, job.step.address, job.answer, asdict(job.limits)]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()
