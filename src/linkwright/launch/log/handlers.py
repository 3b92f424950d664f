"""The handlers of Python's `logging.handlers`, with formats for some loggers (``launch.logging.handlers``)."""

from __future__ import annotations

import logging
import logging.handlers
from typing import Any

from linkwright.launch.log.loggers import ForEachLogger

_CLASSES: dict[str, type[Any]] = {}


def handler_class(name: str) -> type[Any]:
    """The class of a name in `logging.handlers`, extended; for use as the ``__getattr__`` of a module.

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
