"""Measure a new contributor's first test: a fresh clone, its environment, one room's tests."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.measure import ROOT, Row, show

TESTS = "tests/urdf"


def rows() -> list[Row]:
    """Measure, with packages from uv's cache if possible.

    The speed of the network is not of interest.
    """
    with tempfile.TemporaryDirectory() as folder:
        clone = Path(folder) / "clone"
        start_seconds = _get_processor_seconds()
        _run_program("git", "clone", "--quiet", "--no-hardlinks", str(ROOT), str(clone))
        _run_program("make", "--directory", str(clone), "test-base", f"ARGS={TESTS}", f"PYTHON={sys.executable}")
        seconds = _get_processor_seconds() - start_seconds
        size = sum(path.lstat().st_blocks * 512 for path in clone.rglob("*")) / 1e6
    what = f"clone, make test-base ARGS={TESTS}"
    return [Row(f"{what}: processor", seconds, "s", "40 s"), Row(f"{what}: disk", size, "MB", "300 MB")]


def _run_program(*words: str) -> None:
    known = {
        name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MAKELEVEL", "VERSION", "ARGS")
    }
    subprocess.run(words, check=True, env=known, stdout=subprocess.DEVNULL)


def _get_processor_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    show(rows())
