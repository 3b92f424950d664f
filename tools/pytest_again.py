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
MOST = 10
"""With more failures than this, nothing is run again, because they are not accidental."""

_TESTS_FAILED = 1  # pytest's exit status; any other status means that not all tests were run
_FAILED = Path(".pytest_cache/v/cache/lastfailed")


def main(arguments: list[str]) -> int:
    """Run the tests, and return 0 if each test passed at once or in all repetitions."""
    _FAILED.unlink(missing_ok=True)
    status = _run("pytest", *arguments)
    failed = _failed()
    if status != _TESTS_FAILED or not 0 < len(failed) <= MOST:
        return status
    for _ in range(ROUNDS):
        if _run("pytest", *failed):
            print("\nfailed again, of", *failed, sep="\n  ", flush=True)
            return status
    if "--cov" in arguments and _run("coverage", "report", "--format=total"):
        return status
    print(f"\nUNSTEADY: failed once, then passed {ROUNDS} times over:", *failed, sep="\n  ", flush=True)
    return 0


def _run(*command: str) -> int:
    return subprocess.run([sys.executable, "-m", *command], check=False).returncode


def _failed() -> list[str]:
    return list(json.loads(_FAILED.read_text(encoding="utf-8"))) if _FAILED.exists() else []


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
