"""OMPL ends without messages, also in a process that freezes its objects, as the command line does."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytestmark = pytest.mark.extra("arm")

_PROGRAM = """
import gc
from linkwright.planning.library import load_ompl
space = load_ompl().base.RealVectorStateSpace(2)
gc.freeze()
"""


def test_end_of_the_process_reports_no_leaks() -> None:
    result = subprocess.run([sys.executable, "-c", _PROGRAM], capture_output=True, text=True, check=True, timeout=60)
    assert result.stderr == ""
