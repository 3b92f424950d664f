"""Stands in for ``launch.logging.handlers``."""

from linkwright.launch.engine.log_handlers import handler_class as __getattr__
from linkwright.launch.engine.user_logging import FileHandler, Handler, StreamHandler, WatchedFileHandler

__all__ = ["FileHandler", "Handler", "StreamHandler", "WatchedFileHandler"]
