"""The logging setup that the ROS arguments of a process specify: levels, console, log file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from linkwright.graph.command_line.ros_arguments import RosArguments
from linkwright.graph.log.console import print_to_console
from linkwright.graph.log.file import LogFile
from linkwright.graph.log.logger import LogLevels, LogRecord, LogSink


@dataclass(slots=True)
class LoggingSetup:
    """The logging setup of a process.

    Attributes:
        sink: receives the log records of the process's graph.
        levels: the logger levels of the process.
        rosout: whether nodes publish their log records on ``/rosout``.
        file: the log file of the process; None if there is none.
    """

    sink: LogSink
    levels: LogLevels = field(default_factory=LogLevels)
    rosout: bool = True
    file: LogFile | None = None

    def close(self) -> None:
        """Flush the buffered log records and close the log file, if there is one."""
        if self.file is not None:
            self.file.close()


def set_levels(levels: LogLevels, arguments: RosArguments) -> None:
    """Set the logger levels that ``--log-level`` specifies."""
    if arguments.log_level is not None:
        levels.set("", arguments.log_level)
    for name, level in arguments.log_levels.items():
        levels.set(name, level)


def set_up_logging(arguments: RosArguments, executable: str, levels: LogLevels | None = None) -> LoggingSetup:
    """Set up the logging of a process as its ROS arguments specify.

    Args:
        arguments: the ROS arguments of the process.
        executable: the program's name, used in the name of the log file.
        levels: the object that stores the levels; a new one by default.
    """
    levels = levels or LogLevels()
    set_levels(levels, arguments)
    file = None if arguments.external_lib_logs is False else LogFile(executable)
    sinks: list[Callable[[LogRecord], None]] = []
    if arguments.stdout_logs is not False:
        sinks.append(print_to_console)
    if file is not None:
        sinks.append(file.write)

    def sink(record: LogRecord) -> None:
        for write in sinks:
            write(record)

    return LoggingSetup(sink, levels, rosout=arguments.rosout_logs is not False, file=file)
