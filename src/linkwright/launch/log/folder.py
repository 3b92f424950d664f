"""The folders of the log files of launches and nodes, laid out as in ROS."""

from __future__ import annotations

import os
import socket
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

LATEST = "latest"


def log_base(environment: Mapping[str, str] | None = None) -> Path:
    """The folder of all logs: ``ROS_LOG_DIR``, else ``ROS_HOME/log``, else ``~/.ros/log``."""
    environment = os.environ if environment is None else environment
    given = environment.get("ROS_LOG_DIR")
    if given:
        return Path(given).expanduser()
    home = environment.get("ROS_HOME")
    return (Path(home).expanduser() if home else Path.home() / ".ros") / "log"


def new_log_folder(base: Path) -> Path:
    """Make the folder of one launch, named by the date, the machine and the process; ``latest`` links to it.

    Raises:
        OSError: it cannot be made.
    """
    while True:
        # The machine's own time, as ROS names these folders; a person is to find the launch of this morning.
        seconds, nanoseconds = divmod(time.time_ns(), 1_000_000_000)
        stamp = f"{time.strftime('%Y-%m-%d-%H-%M-%S', time.localtime(seconds))}-{nanoseconds // 1000:06d}"
        folder = base / f"{stamp}-{socket.gethostname()}-{os.getpid()}"
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            continue
        _link_latest(base, folder)
        return folder


def _link_latest(base: Path, folder: Path) -> None:
    waiting = base / f".{LATEST}-{os.getpid()}"
    with suppress(OSError, NotImplementedError):  # a file system without links
        waiting.unlink(missing_ok=True)
        waiting.symlink_to(folder.name)
        waiting.replace(base / LATEST)
