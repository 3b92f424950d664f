"""Loads aiohttp's server without its client, which takes about as long to load as the server.

``import aiohttp`` loads both, and the client reads the system's certificates twice while it loads. This module
registers the package without running its ``__init__``, and loads only the modules that a server needs. ``__init__``
runs at the first access to one of its names, for example by a user's node that downloads a file.
"""

from __future__ import annotations

import logging
import sys
from importlib.util import find_spec, module_from_spec
from pathlib import Path
from threading import RLock
from typing import Any


def _register_package() -> None:
    """Register an empty aiohttp package, whose ``__init__`` is run on demand."""
    spec = find_spec("aiohttp")
    if spec is None or spec.loader is None or spec.origin is None:
        return  # the import of aiohttp below raises the error
    package, loader, lock = module_from_spec(spec), spec.loader, RLock()
    installed = [path.stem for path in Path(spec.origin).parents[1].glob("aiohttp-*.dist-info")]

    def missing(name: str) -> Any:
        if name == "__version__" and len(installed) == 1:
            return installed[0].partition("-")[2]  # the version, which is part of the server's name in responses
        with lock:
            if package.__dict__.get("__getattr__") is missing:
                if find_spec(f"aiohttp.{name}"):
                    raise AttributeError(name)  # the import system then loads that module
                del package.__dict__["__getattr__"]
                loader.exec_module(package)
        return getattr(package, name)

    package.__dict__["__getattr__"] = missing
    sys.modules["aiohttp"] = package


def _unregister_package() -> None:
    """Unregister all modules of aiohttp, so that they are imported again."""
    for name in [module for module in sys.modules if module == "aiohttp" or module.startswith("aiohttp.")]:
        del sys.modules[name]


if "aiohttp" not in sys.modules:
    _register_package()

try:
    from aiohttp import web
    from aiohttp.http_exceptions import HttpProcessingError
except (AttributeError, ImportError):  # a later version, whose server needs `__init__`
    _unregister_package()
    from aiohttp import web
    from aiohttp.http_exceptions import HttpProcessingError

__all__ = ["SERVER_LOGGER", "HttpProcessingError", "web"]


def _is_server_error(record: logging.LogRecord) -> bool:
    """Return whether a record is logged: not if a malformed request or a disconnect caused the error."""
    error = record.exc_info[1] if record.exc_info else None
    return not isinstance(error, (HttpProcessingError, web.RequestPayloadError, ConnectionError))


SERVER_LOGGER = logging.getLogger(__name__)
"""The logger for each ``web.AppRunner``: aiohttp's own one prints a traceback whenever a client leaves."""
SERVER_LOGGER.addFilter(_is_server_error)
