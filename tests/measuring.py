"""The coverage of processes that tests start."""

from __future__ import annotations

import sys
from pathlib import Path

from tests.places import REPOSITORY

_SETTINGS = REPOSITORY / "pyproject.toml"
"""Processes in other folders would not find the settings, and would also measure the learner's programs."""


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
    return ["-m", "coverage", "run", "--parallel-mode", f"--data-file={data_file}", f"--rcfile={_SETTINGS}"]


def measured_program(program: str, part: str) -> str:
    """Return a program for ``python -c`` that measures the coverage of a part.

    It measures only if the tests' coverage is measured.
    """
    data_file = _data_file()
    if data_file is None:
        return program
    options = f"data_file={str(data_file)!r}, data_suffix=True, config_file={str(_SETTINGS)!r}"
    measured = f"import coverage; c = coverage.Coverage({options}); c.start(); {part}; c.stop(); c.save()"
    return program.replace(part, measured)
