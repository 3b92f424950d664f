"""Stands in for ``launch.logging.handlers``."""

from linkwright.launch.engine.user_logging import FileHandler, Handler, StreamHandler, WatchedFileHandler

__all__ = ["FileHandler", "Handler", "StreamHandler", "WatchedFileHandler"]
