"""Fixtures for check processes and sandbox supervisors, which count for coverage.

Confined programs do not.
"""

import sys
from collections.abc import Iterator

import pytest

from linkwright.learning.checks import check_process
from linkwright.learning.sandbox import run
from linkwright.process.forked import ForkServer
from tests.measuring import coverage_options, measured_program


@pytest.fixture(scope="session")
def check_server() -> Iterator[ForkServer]:
    """Return the server that forks the checks of all tests, because its imports take 2 s of the processor."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(check_process, "PYTHON", _measured_python())
        server = check_process.create_check_server()
    with server:
        yield server


def _measured_python() -> list[str]:
    return [sys.executable, *coverage_options()]


@pytest.fixture(autouse=True)
def measured_checks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(check_process, "PYTHON", _measured_python())
    monkeypatch.setattr(
        run, "_SUPERVISOR_CODE", measured_program(run._SUPERVISOR_CODE, "from {module} import main; main()")
    )
