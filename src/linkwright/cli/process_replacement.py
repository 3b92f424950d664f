"""The replacement of this process by another program, which then receives the signals."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase


def replace_process(command: list[str], environment: Mapping[str, str]) -> int:
    """Replace this process by a program.

    On Windows, run the program in a child process and return its exit status.

    Raises:
        LinkwrightError: CLI110, the program cannot be run.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    try:
        if os.name == "posix":
            os.execvpe(command[0], command, environment)  # noqa: S606 - the user requested this program
        return subprocess.run(command, env=environment, check=False).returncode  # noqa: S603 - as above
    except OSError as error:
        message = phrase(
            "'{command}' cannot be run: {strerror}", command=command[0], strerror=foreign(error.strerror or error)
        )
        raise LinkwrightError(Diagnostic("CLI110", message)) from error
