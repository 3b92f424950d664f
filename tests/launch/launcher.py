"""A launcher in a separate process, for tests of the start and end of launches."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

from tests.waiting import TIMEOUT_S

LAUNCHER_PROGRAM = """
from linkwright.process.interruption import end_on_interrupt
end_on_interrupt()
print("begun", flush=True)
import sys
from linkwright.diagnostics import LinkwrightError, print_diagnostics
from linkwright.hosting.plans import HostOptions
from linkwright.hosting.view import run_view
from linkwright.launch import LaunchOptions, parse_launch_words, run_launch
from linkwright.standins import activate
activate()
try:
    if sys.argv[1] == "view":
        sys.exit(run_view(sys.argv[2], {}, HostOptions(open_browser=False, network="--join" in sys.argv)))
    sys.exit(run_launch(*parse_launch_words(sys.argv[1:]), LaunchOptions(open_browser=False)))
except LinkwrightError as error:
    print_diagnostics(error.diagnostics, sys.stderr)
    sys.exit(1)
"""


class Running:
    """A launch in a separate process; its output is collected in files.

    Attributes:
        identity: a number by which a test identifies the launch.
    """

    identity = 0

    def __init__(self, folder: Path, words: list[str], cwd: Path) -> None:
        self._files = [folder / f"{len(list(folder.glob('*-out')))}-{name}" for name in ("out", "err")]
        streams = [path.open("w") for path in self._files]
        self.process = subprocess.Popen(
            [sys.executable, "-c", LAUNCHER_PROGRAM, *words], stdout=streams[0], stderr=streams[1], cwd=cwd
        )
        for stream in streams:
            stream.close()

    @property
    def has_begun(self) -> bool:
        """Return whether the launcher handles Ctrl-C itself; see `tests.begun`."""
        return self._files[0].read_text().startswith("begun\n")

    @property
    def out(self) -> str:
        return self._files[0].read_text().partition("begun\n")[2]

    @property
    def err(self) -> str:
        return self._files[1].read_text()

    def until(self, text: str, seconds: float = TIMEOUT_S) -> None:
        deadline = time.monotonic() + seconds
        while text not in self.out and text not in self.err:
            assert self.process.poll() is None, f"the launch ended:\n{self.out}\n{self.err}"
            assert time.monotonic() < deadline, f"'{text}' was not printed in time:\n{self.out}\n{self.err}"
            time.sleep(0.01)

    def end(self, number: int = signal.SIGINT) -> tuple[int, float]:
        """Send a signal, and return the exit status and the time in seconds until the end."""
        start_s = time.monotonic()
        self.process.send_signal(number)
        return self.process.wait(TIMEOUT_S), time.monotonic() - start_s

    @property
    def url(self) -> str:
        self.until("Viewer: ")
        match = re.search(r"^Viewer: (http://127\.0\.0\.1:\d+/\?token=\S+)$", self.out, re.MULTILINE)
        assert match
        return match[1]


def is_gone(pid: int) -> bool:
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, 0)
        return "\nState:\tZ" in Path(f"/proc/{pid}/status").read_text()
    return True


def launch_file(*actions: str, head: str = "") -> str:
    lines = ",\n        ".join(actions)
    return (
        "import sys, time\nfrom launch import LaunchDescription\nfrom launch.actions import *\n"
        "from launch.substitutions import *\nfrom launch_ros.actions import Node\n"
        f"{head}\ndef generate_launch_description():\n    return LaunchDescription([\n        {lines}\n    ])\n"
    )
