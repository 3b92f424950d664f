"""Log files of processes, with the folder and file names of rcl_logging_spdlog."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import TextIO

from linkwright.graph.log.console import format_console_line
from linkwright.graph.log.logger import LogLevel, LogRecord


def find_log_folder(environment: Mapping[str, str] | None = None) -> Path:
    """Return the log folder: ROS_LOG_DIR, or ``log`` in ROS_HOME, or ``~/.ros/log``."""
    environment = os.environ if environment is None else environment
    if environment.get("ROS_LOG_DIR"):
        return Path(environment["ROS_LOG_DIR"]).expanduser()
    if environment.get("ROS_HOME"):
        return Path(environment["ROS_HOME"]).expanduser() / "log"
    return Path.home() / ".ros" / "log"


class LogFile:
    """The log file of this process, created with the first record.

    The file name is ``EXECUTABLE_PID_MILLISECONDS.log``. If the folder is not writable, records are discarded without
    an error.

    Args:
        executable: the name of the program.
        folder: the folder of the file; `find_log_folder` by default.
    """

    def __init__(self, executable: str, folder: Path | None = None) -> None:
        milliseconds = time.time_ns() // 1_000_000
        self.path = (folder or find_log_folder()) / f"{executable}_{os.getpid()}_{milliseconds}.log"
        self._file: TextIO | None = None
        self._failed = False

    def write(self, record: LogRecord) -> None:
        """Write a record.

        Errors are flushed immediately, other records when the buffer is full or the process ends.
        """
        file = self._file or self._open()
        if file is None:
            return
        try:
            file.write(f"{format_console_line(record)}\n")
            if record.level >= LogLevel.ERROR:
                file.flush()
        except OSError:  # For example, the disk is full.
            self.close()

    def close(self) -> None:
        """Flush buffered records, and close the file.

        Later records are discarded.
        """
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
