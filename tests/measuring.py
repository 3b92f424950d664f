"""The coverage of processes that tests start."""

from __future__ import annotations

import sys
from pathlib import Path


def coverage_options() -> list[str]:
    """Return the options that measure the coverage of a Python process, if that of the tests is measured."""
    coverage = sys.modules.get("coverage")
    measuring = None if coverage is None else coverage.Coverage.current()
    if measuring is None:
        return []
    data_file = Path(measuring.get_option("run:data_file")).resolve()
    return ["-m", "coverage", "run", "--parallel-mode", f"--data-file={data_file}"]
