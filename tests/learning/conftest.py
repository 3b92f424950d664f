"""Processes of checks and supervisors of sandboxes, whose coverage counts; that of confined programs does not."""

import sys

import pytest

from linkwright.learning.checks import running
from linkwright.learning.sandbox import run
from tests.measuring import coverage_options, measured_program


@pytest.fixture(autouse=True)
def measured_checks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "PYTHON", [sys.executable, *coverage_options()])
    monkeypatch.setattr(run, "_SUPERVISE", measured_program(run._SUPERVISE, "from {module} import main; main()"))
