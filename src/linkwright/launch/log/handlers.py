"""The handlers of `logging` with formats for individual loggers (``launch.logging.handlers``)."""

from __future__ import annotations

import logging
import logging.handlers
from typing import Any

_CLASSES: dict[str, type[Any]] = {}


class ForEachLogger:
    """A handler with separate formatters for individual loggers."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._formatters: dict[str, logging.Formatter] = {}

    def setFormatterFor(self, logger: logging.Logger, formatter: logging.Formatter) -> None:  # noqa: N802 - ROS's name
        """Set the formatter for a logger's lines."""
        self._formatters[logger.name] = formatter

    def unsetFormatterFor(self, logger: logging.Logger) -> None:  # noqa: N802 - ROS's name
        """Remove the formatter for a logger's lines."""
        self._formatters.pop(logger.name, None)

    def format(self, record: logging.LogRecord) -> str:
        """Return the line for a log record."""
        record.msg, record.args = record.getMessage(), None
        formatter = self._formatters.get(record.name)
        if formatter is not None:
            return formatter.format(record)
        return str(super().format(record))  # type: ignore[misc]  # the class that it is mixed into defines it


class Handler(ForEachLogger, logging.Handler):
    """The base class for users' handlers."""


class StreamHandler(ForEachLogger, logging.StreamHandler):  # type: ignore[type-arg]  # not generic at run time
    """Writes lines to a stream."""


class FileHandler(ForEachLogger, logging.FileHandler):
    """Writes lines to a file."""


class WatchedFileHandler(ForEachLogger, logging.handlers.WatchedFileHandler):
    """Writes lines to a file, which is reopened if another program moves it."""


def handler_class(name: str) -> type[Any]:
    """Return a class of `logging.handlers` combined with `ForEachLogger`.

    This function is used as the ``__getattr__`` of a module.

    Raises:
        AttributeError: there is no such handler.
    """
    found = getattr(logging.handlers, name, None)
    if isinstance(found, type) and issubclass(found, logging.Handler):
        return _extended(found)
    raise AttributeError(f"module 'launch.logging.handlers' has no attribute '{name}'")


def _extended(kind: Any) -> type[Any]:
    if kind.__name__ not in _CLASSES:
        _CLASSES[kind.__name__] = type(kind.__name__, (ForEachLogger, kind), {"__doc__": kind.__doc__})
    return _CLASSES[kind.__name__]
