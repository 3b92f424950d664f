"""Processes of checks, whose coverage counts."""

import sys

import pytest

from linkwright.learning.checks import running
from tests.measuring import coverage_options


@pytest.fixture(autouse=True)
def measured_checks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "PYTHON", [sys.executable, *coverage_options()])
