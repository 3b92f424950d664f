"""Handlers with separate formats for individual loggers (``launch.logging.handlers``)."""

from __future__ import annotations

import logging
import logging.handlers
from typing import Any

_EXTENDED_CLASSES: dict[str, type[Any]] = {}


class ForEachLogger:
    """A handler with separate formatters for individual loggers."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._formatters: dict[str, logging.Formatter] = {}

    def setFormatterFor(self, logger: logging.Logger, formatter: logging.Formatter) -> None:  # noqa: N802 - ROS's name
        """Set the formatter for the lines of a logger."""
        self._formatters[logger.name] = formatter

    def unsetFormatterFor(self, logger: logging.Logger) -> None:  # noqa: N802 - ROS's name
        """Remove the formatter for the lines of a logger."""
        self._formatters.pop(logger.name, None)

    def format(self, record: logging.LogRecord) -> str:
        """Return the formatted line for a log record."""
        record.msg, record.args = record.getMessage(), None
        formatter = self._formatters.get(record.name)
        if formatter is not None:
            return formatter.format(record)
        return str(super().format(record))  # type: ignore[misc]  # defined by the other base class


class Handler(ForEachLogger, logging.Handler):
    """The base class for users' handlers."""


class StreamHandler(ForEachLogger, logging.StreamHandler):  # type: ignore[type-arg]  # not generic at run time
    """A handler that writes lines to a stream."""


class FileHandler(ForEachLogger, logging.FileHandler):
    """A handler that writes lines to a file."""


class WatchedFileHandler(ForEachLogger, logging.handlers.WatchedFileHandler):
    """A handler that writes lines to a file, and reopens the file if another program moves it."""


def handler_class(name: str) -> type[Any]:
    """Return a class of `logging.handlers` combined with `ForEachLogger`.

    A module uses this function as its ``__getattr__``.

    Raises:
        AttributeError: there is no such handler.
    """
    base_class = getattr(logging.handlers, name, None)
    if isinstance(base_class, type) and issubclass(base_class, logging.Handler):
        return _extend(base_class)
    raise AttributeError(f"module 'launch.logging.handlers' has no attribute '{name}'")


def _extend(kind: Any) -> type[Any]:
    if kind.__name__ not in _EXTENDED_CLASSES:
        _EXTENDED_CLASSES[kind.__name__] = type(kind.__name__, (ForEachLogger, kind), {"__doc__": kind.__doc__})
    return _EXTENDED_CLASSES[kind.__name__]
