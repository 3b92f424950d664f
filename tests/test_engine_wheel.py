"""linkwright-core in an empty environment.

It is small and complete, and has the findings of the whole.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from linkwright import __version__
from tests.installed import install
from tests.places import REPOSITORY

pytestmark = pytest.mark.slow
MAX_BYTES = 90 * 1024 * 1024


@pytest.fixture(scope="module")
def engine(tmp_path_factory) -> Path:
    """Return the environment."""
    return install(tmp_path_factory.mktemp("engine"), extra="", project=REPOSITORY / "core")


def test_engine_wheel_is_small_and_runs_its_commands(engine, tmp_path):
    words = [engine / "bin" / "python", "-I", REPOSITORY / "tools" / "try_installation.py", __version__, "--engine"]
    result = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, check=False)
    assert result.returncode == 0, result.stderr
    assert "six commands" in result.stdout
    assert sum(path.stat().st_size for path in engine.rglob("*") if path.is_file()) < MAX_BYTES


@pytest.mark.parametrize("package", sorted(path.name for path in (REPOSITORY / "robots").iterdir() if path.is_dir()))
def test_engine_wheel_reports_same_findings_as_full_package(engine, package):
    found = []
    for python in (engine / "bin" / "python", sys.executable):
        words = [python, "-I", "-m", "linkwright", "check", "--format", "json", "--select", "ALL", package]
        result = subprocess.run(words, capture_output=True, text=True, cwd=REPOSITORY / "robots", check=False)
        assert result.returncode in (0, 1), result.stderr
        found.append((result.returncode, result.stdout))
    assert found[0] == found[1]
