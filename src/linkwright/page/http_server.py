"""Loads the server of aiohttp without the client.

``import aiohttp`` loads both. The client takes about as long to load as the server, because it reads the certificates
of the system twice. This module registers the package without running its ``__init__``, and loads only the modules that
a server needs. ``__init__`` runs when one of its names is first used, for example by a node of the user that downloads
a file.
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
    distributions = [path.stem for path in Path(spec.origin).parents[1].glob("aiohttp-*.dist-info")]

    def missing(name: str) -> Any:
        if name == "__version__" and len(distributions) == 1:
            return distributions[0].partition("-")[2]  # the server puts the version into its name in responses
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
except (AttributeError, ImportError):  # in this version of aiohttp, the server needs `__init__`
    _unregister_package()
    from aiohttp import web
    from aiohttp.http_exceptions import HttpProcessingError

__all__ = ["SERVER_LOGGER", "HttpProcessingError", "web"]


def _is_server_error(record: logging.LogRecord) -> bool:
    """Return whether to log a record.

    An error that a malformed request or a disconnect caused is not logged.
    """
    error = record.exc_info[1] if record.exc_info else None
    return not isinstance(error, (HttpProcessingError, web.RequestPayloadError, ConnectionError))


SERVER_LOGGER = logging.getLogger(__name__)
"""The logger for each ``web.AppRunner``. The logger of aiohttp prints a traceback if a client disconnects."""
SERVER_LOGGER.addFilter(_is_server_error)
