"""Runs the program of the other robot when the learner's robot gets its first command.

Usage: ``python -m linkwright.cli.learn.rival TOPIC PROGRAM [ARGUMENT...]``. In a world in real time, learners start
their programs by hand, and the other robot must not have a lead of several laps.
"""

from __future__ import annotations

import os
import runpy
import sys
from collections.abc import Sequence
from contextlib import redirect_stdout
from pathlib import Path

from linkwright.cli.entry import main as run_command


def main(words: Sequence[str]) -> int:
    """Wait for a message on a topic, and run a program."""
    topic, program, *arguments = words
    with Path(os.devnull).open("w", encoding="utf-8") as null_output, redirect_stdout(null_output):
        status = run_command(["topic", "echo", "--once", topic])
    if status:
        return status
    sys.argv = [program, *arguments]
    sys.path.insert(0, str(Path(program).parent))
    runpy.run_path(program, run_name="__main__")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
