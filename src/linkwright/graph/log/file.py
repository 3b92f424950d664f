"""Log files of processes, where rcl_logging_spdlog puts them and named as it names them."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import TextIO

from linkwright.graph.log.console import console_line
from linkwright.graph.log.logger import LogLevel, LogRecord


def log_folder(environment: Mapping[str, str] | None = None) -> Path:
    """The folder of log files: ROS_LOG_DIR, else ``log`` in ROS_HOME, else ``~/.ros/log``."""
    environment = os.environ if environment is None else environment
    if environment.get("ROS_LOG_DIR"):
        return Path(environment["ROS_LOG_DIR"]).expanduser()
    if environment.get("ROS_HOME"):
        return Path(environment["ROS_HOME"]).expanduser() / "log"
    return Path.home() / ".ros" / "log"


class LogFile:
    """The log file of this process: ``EXECUTABLE_PID_MILLISECONDS.log``, made with the first record.

    Where the folder cannot be written there is no file, and the process continues.

    Args:
        executable: name of the program.
        folder: where; `log_folder` when left out.
    """

    def __init__(self, executable: str, folder: Path | None = None) -> None:
        milliseconds = time.time_ns() // 1_000_000
        self.path = (folder or log_folder()) / f"{executable}_{os.getpid()}_{milliseconds}.log"
        self._file: TextIO | None = None
        self._failed = False

    def write(self, record: LogRecord) -> None:
        """Write a record. Errors are flushed at once, the rest when the process ends or the buffer is full."""
        file = self._file or self._open()
        if file is None:
            return
        try:
            file.write(f"{console_line(record)}\n")
            if record.level >= LogLevel.ERROR:
                file.flush()
        except OSError:  # the disk is full
            self.close()

    def close(self) -> None:
        """Write out buffered records, and end."""
        if self._file is not None:
            with suppress(OSError):
                self._file.close()
            self._file = None
        self._failed = True

    def _open(self) -> TextIO | None:
        if self._failed:
            return None
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._file = self.path.open("a", encoding="utf-8")
        except OSError:
            self._failed = True
        return self._file
