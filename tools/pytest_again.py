"""Run pytest as it is told to; what failed is run again, three times over, and has to pass each time.

For ``.ci/run``: see decision 0037. What did not pass at once is named at the end whatever becomes of it.

    python tools/pytest_again.py ARGUMENTS OF PYTEST
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

ROUNDS = 3
MOST = 10
"""More failures than these are no accident, and nothing is run again."""

_TESTS_FAILED = 1  # pytest's exit status; others say that not all tests were run
_FAILED = Path(".pytest_cache/v/cache/lastfailed")


def main(arguments: list[str]) -> int:
    """Run the tests; the exit status is 0 when each passed at once, or passed each time afterwards."""
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
