"""Fixtures for check processes and sandbox supervisors, which count for coverage.

Confined programs do not.
"""

import sys

import pytest

from linkwright.learning.checks import check_process
from linkwright.learning.sandbox import run
from tests.measuring import coverage_options, measured_program


@pytest.fixture(autouse=True)
def measured_checks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(check_process, "PYTHON", [sys.executable, *coverage_options()])
    monkeypatch.setattr(
        run, "_SUPERVISOR_CODE", measured_program(run._SUPERVISOR_CODE, "from {module} import main; main()")
    )
