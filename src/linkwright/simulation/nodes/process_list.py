"""Show the command of a simulation in the list of processes.

A simulation may run in the process of the launcher. Some programs, such as the one that ends the launch files of boats
when Gazebo is closed, look for ``gz sim`` in the list of processes (``pgrep -f``). For them, a waiting process has this
command line as long as the simulation runs.
"""

from __future__ import annotations

import shlex
import shutil
import subprocess
import sys
from collections.abc import Sequence


class ListedCommand:
    """A process that waits under another program's command line.

    It ends with `close`, and with the process that created it. Where the list of processes does not show a chosen
    command line (Windows), there is no process.

    Args:
        command: the command line to show.
    """

    def __init__(self, command: Sequence[str]) -> None:
        waiting_program = None if sys.platform == "win32" else shutil.which("cat")
        self._process = (
            None
            if waiting_program is None
            else subprocess.Popen(  # noqa: S603 - cat without arguments waits for the end of its input
                [shlex.join(command)],
                executable=waiting_program,
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                start_new_session=True,
            )
        )

    @property
    def pid(self) -> int | None:
        """The identifier of the process, or None if there is none."""
        return None if self._process is None else self._process.pid

    def close(self) -> None:
        """End the process. Repeated calls have no further effect."""
        if self._process is not None:
            self._process.terminate()
            self._process.communicate()
