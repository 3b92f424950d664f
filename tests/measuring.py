"""The coverage of processes that tests start."""

from __future__ import annotations

import sys
from pathlib import Path

from tests.places import REPOSITORY

_SETTINGS = REPOSITORY / "tests" / "measured_processes.toml"
_MEASURED_FILES = str(REPOSITORY / "src" / "linkwright" / "*")
"""Only these files, so that the learner's programs are not measured."""


_RUN_MEASURED = """\
import os, sys
from coverage import Coverage
from coverage.cmdline import main
os.register_at_fork(before=lambda: Coverage.current() and Coverage.current().save())
sys.exit(main())
"""
"""The program ``coverage``, which saves what it has measured before each fork.

Otherwise each forked process saves all the lines that its server has run, half a megabyte, at its own end.
"""


def _data_file() -> Path | None:
    """Return the data file of the tests' coverage, or None if coverage is not measured."""
    coverage = sys.modules.get("coverage")
    measuring = None if coverage is None else coverage.Coverage.current()
    return None if measuring is None else Path(measuring.get_option("run:data_file")).resolve()


def coverage_options() -> list[str]:
    """Return the options that measure the coverage of a Python process.

    They are empty unless the tests' coverage is measured.
    """
    data_file = _data_file()
    if data_file is None:
        return []
    settings = [f"--data-file={data_file}", f"--rcfile={_SETTINGS}", f"--include={_MEASURED_FILES}"]
    return ["-c", _RUN_MEASURED, "run", "--parallel-mode", *settings]


def measured_program(program: str, part: str) -> str:
    """Return a program for ``python -c`` that measures the coverage of a part.

    It measures only if the tests' coverage is measured.
    """
    data_file = _data_file()
    if data_file is None:
        return program
    options = (
        f"data_file={str(data_file)!r}, data_suffix=True, config_file={str(_SETTINGS)!r}, include=[{_MEASURED_FILES!r}]"
    )
    measured = f"import coverage; c = coverage.Coverage({options}); c.start(); {part}; c.stop(); c.save()"
    return program.replace(part, measured)
