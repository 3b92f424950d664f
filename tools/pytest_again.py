"""Run pytest, and run failed tests three more times, in which they must pass each time.

For ``.ci/run``: see decision 0037. Tests that did not pass at once are named at the end in any case.

    python tools/pytest_again.py ARGUMENTS OF PYTEST
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

ROUNDS = 3
MAX_FAILURES = 10
"""With more failures than this, nothing is run again, because they are not accidental."""

_TESTS_FAILED_STATUS = 1  # pytest's exit status; any other status means that not all tests were run
_FAILED_TESTS_FILE = Path(".pytest_cache/v/cache/lastfailed")


def main(arguments: list[str]) -> int:
    """Run the tests, and return 0 if each test passed at once or in all repetitions."""
    _FAILED_TESTS_FILE.unlink(missing_ok=True)
    status = _run_command("pytest", *arguments)
    failed = _list_failed_tests()
    if status != _TESTS_FAILED_STATUS or not 0 < len(failed) <= MAX_FAILURES:
        return status
    for _ in range(ROUNDS):
        if _run_command("pytest", *failed):
            print("\nfailed again, of", *failed, sep="\n  ", flush=True)
            return status
    if "--cov" in arguments and _run_command("coverage", "report", "--format=total"):
        return status
    print(f"\nUNSTEADY: failed once, then passed {ROUNDS} times over:", *failed, sep="\n  ", flush=True)
    return 0


def _run_command(*command: str) -> int:
    return subprocess.run([sys.executable, "-m", *command], check=False).returncode


def _list_failed_tests() -> list[str]:
    return list(json.loads(_FAILED_TESTS_FILE.read_text(encoding="utf-8"))) if _FAILED_TESTS_FILE.exists() else []


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
