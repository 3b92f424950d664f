"""Severities, and the levels of loggers: a tree of names in which levels are inherited (rcutils)."""

from __future__ import annotations

from enum import IntEnum


class LogLevel(IntEnum):
    """Severities with rcutils' numbers and names."""

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


def level_named(name: str) -> LogLevel | None:
    """The severity of a name, in upper or lower case; None for an unknown name."""
    return LogLevel.__members__.get(name.upper())


class LogLevels:
    """The levels of the loggers of a graph.

    A logger without a level of its own has that of the nearest one above it, ``robot`` for ``robot.arm``; the topmost
    is the default level.

    Attributes:
        revision: changes with every change of a level.
    """

    def __init__(self, default: LogLevel = LogLevel.INFO) -> None:
        self._default = default
        self._own: dict[str, LogLevel] = {}
        self.revision = 0

    def set(self, name: str, level: LogLevel) -> None:
        """Set the level of a logger; UNSET removes it. The empty name sets the default level."""
        if not name:
            self._default = level or LogLevel.INFO
        else:
            self._own[name] = level
        self.revision += 1

    def reset(self) -> None:
        """Forget every level that was set."""
        self._default = LogLevel.INFO
        self._own.clear()
        self.revision += 1

    def own(self, name: str) -> LogLevel:
        """The level that was set for a logger itself; UNSET where none was."""
        return self._own.get(name, LogLevel.UNSET) if name else self._default

    def effective(self, name: str) -> LogLevel:
        """The level in force for a logger: its own, or that of the nearest logger above it, or the default."""
        while name:
            level = self._own.get(name)
            if level:
                return level
            name = name.rpartition(".")[0]
        return self._default
