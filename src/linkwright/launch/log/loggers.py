"""The loggers of ``launch.logging``: Python's loggers with the format of launch lines.

These loggers are separate from the launcher's own log (`linkwright.hosting.launch_log`). They have the same format,
and use the same environment variables. A log file is opened when its first line is written.
"""

from __future__ import annotations

import logging
import logging.handlers
import os
import sys
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from linkwright.hosting.launch_log import FILE_FORMATS, FORMATS, create_log_folder, find_log_base
from linkwright.launch.log.handlers import FileHandler, ForEachLogger, Handler, StreamHandler, WatchedFileHandler

MAIN_LOG = "launch.log"

_STREAMS = ("stdout", "stderr", "both")
_DESTINATIONS = frozenset({"screen", "log", "own_log"})
_DESTINATIONS_BY_OUTPUT: Mapping[str, Mapping[str, set[str]]] = {
    "screen": {"both": {"screen"}},
    "log": {"both": {"log"}, "stderr": {"screen"}},
    "both": {"both": {"log", "screen"}},
    "own_log": {"both": {"own_log"}, "stdout": {"own_log"}, "stderr": {"own_log"}},
    "full": {"both": {"screen", "log", "own_log"}, "stdout": {"own_log"}, "stderr": {"own_log"}},
}


class _ScreenHandler(StreamHandler):
    """A handler that writes lines to the current ``sys.stdout``.

    A program may replace this stream at any time.
    """

    @property
    def stream(self) -> Any:
        return sys.stdout

    @stream.setter
    def stream(self, _: Any) -> None:
        pass


class _MainFileHandler(Handler):
    """A handler that writes lines to the main log file.

    The file is opened when the first line is written.
    """

    def emit(self, record: logging.LogRecord) -> None:
        """Write a log record, unless its logger has its own handler for the main log file."""
        handler = launch_config.get_log_file_handler(launch_config.log_file_name)
        if handler not in logging.getLogger(record.name).handlers:
            handler.handle(record)


def _get_logging_directory() -> str:
    return os.path.normpath(find_log_base())


def _make_unique_log_dir(*, base_path: str) -> str:
    return str(create_log_folder(Path(base_path)))


def _renew_latest_log_dir(*, log_dir: str) -> bool:  # noqa: ARG001 - ROS's tests replace a function with this signature
    return True  # `create_log_folder` has already updated the link


class LaunchConfig:
    """The configuration of the loggers."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Reset the configuration to its defaults."""
        self._log_dir: str | None = None
        self.log_file_name = MAIN_LOG
        self.file_handlers: dict[str, logging.Handler] = {}
        self.screen_handler: logging.Handler | None = None
        self.main_file_handler = _MainFileHandler()
        self.screen_formatter: logging.Formatter | None = None
        self.file_formatter: logging.Formatter | None = None
        self._log_handler_factory: Callable[..., logging.Handler] | None = None
        self.is_level_set = False
        self.set_screen_format("default")
        self.set_log_format("default")

    @property
    def level(self) -> int:
        """The minimum level of the lines that are logged."""
        return logging.root.getEffectiveLevel()

    @level.setter
    def level(self, new_level: int) -> None:
        logging.root.setLevel(new_level)
        self.is_level_set = True

    @property
    def log_dir(self) -> str:
        """The folder of the launch's log files, created on first access."""
        if self._log_dir is None:
            module = _public_module()
            self._log_dir = module._make_unique_log_dir(base_path=_get_logging_directory())
            module._renew_latest_log_dir(log_dir=self._log_dir)
        assert self._log_dir is not None
        return self._log_dir

    @log_dir.setter
    def log_dir(self, new_log_dir: str | None) -> None:
        if new_log_dir is not None:
            if self.file_handlers:
                message = (
                    f"Loggers have been already configured to output to log files below {self._log_dir}. "
                    "Proceed at your own risk."
                )
                warnings.warn(message, stacklevel=2)
            if not Path(new_log_dir).is_dir():
                raise ValueError(f"{new_log_dir} is not a directory")
        self._log_dir = None if new_log_dir is None else str(new_log_dir)

    def use_launch_folder(self, folder: Path) -> None:
        """Use the log folder of the running launch, unless log files have already been opened."""
        if not self.file_handlers:
            self._log_dir = str(folder)

    @property
    def log_handler_factory(self) -> Callable[..., logging.Handler]:
        """The factory of file handlers.

        It is called with a path and the keyword argument ``encoding``.
        """
        return self._log_handler_factory or (FileHandler if os.name == "nt" else WatchedFileHandler)

    @log_handler_factory.setter
    def log_handler_factory(self, factory: Callable[..., logging.Handler]) -> None:
        self._log_handler_factory = factory

    def set_screen_format(self, screen_format: str | None, *, screen_style: Any = None) -> None:
        """Set the format of lines on the screen.

        The environment variable ``OVERRIDE_LAUNCH_SCREEN_FORMAT`` takes precedence.

        Args:
            screen_format: ``default``, ``default_with_timestamp``, or a format string.
            screen_style: the style of a format string, as in `logging.Formatter`; ``{`` by default.
        """
        overriding_format = os.environ.get("OVERRIDE_LAUNCH_SCREEN_FORMAT")
        self.screen_formatter = _create_formatter(screen_format, screen_style, overriding_format, FORMATS, "screen")
        if self.screen_handler is not None:
            self.screen_handler.setFormatter(self.screen_formatter)

    def set_log_format(self, log_format: str | None, *, log_style: Any = None) -> None:
        """Set the format of lines in log files.

        The environment variable ``OVERRIDE_LAUNCH_LOG_FORMAT`` takes precedence.

        Args:
            log_format: ``default``, or a format string.
            log_style: the style of a format string, as in `logging.Formatter`; ``{`` by default.
        """
        overriding_format = os.environ.get("OVERRIDE_LAUNCH_LOG_FORMAT")
        self.file_formatter = _create_formatter(log_format, log_style, overriding_format, FILE_FORMATS, "log")
        for handler in self.file_handlers.values():
            handler.setFormatter(self.file_formatter)

    def get_screen_handler(self) -> logging.Handler:
        """Return the handler for the screen."""
        if self.screen_handler is None:
            self.screen_handler = _ScreenHandler()
            self.screen_handler.setFormatter(self.screen_formatter)
        return self.screen_handler

    def get_log_file_path(self, file_name: str = MAIN_LOG) -> str:
        """Return the path of a file in the log folder."""
        return str(Path(self.log_dir) / file_name)

    def get_log_file_handler(self, file_name: str = MAIN_LOG) -> logging.Handler:
        """Return the handler for a file in the log folder.

        Repeated calls return the same handler.
        """
        if file_name not in self.file_handlers:
            handler = self.log_handler_factory(self.get_log_file_path(file_name), encoding="utf-8")
            handler.setFormatter(self.file_formatter)
            self.file_handlers[file_name] = handler
        return self.file_handlers[file_name]


def _create_formatter(
    format_text: str | None, style: Any, overriding_format: str | None, named_formats: Mapping[str, str], kind: str
) -> logging.Formatter | None:
    if overriding_format:
        format_text, style = overriding_format.encode("latin1").decode("unicode_escape"), "{"
    if format_text is None:
        return None
    if format_text in named_formats:
        if style is not None:
            raise ValueError(f'Cannot set a custom format style for the "{format_text}" {kind} format.')
        format_text = named_formats[format_text]
    return logging.Formatter(format_text, style=style or "{")


def _public_module() -> Any:
    """Return the module ``launch.logging`` if it is loaded, otherwise this module.

    Users and ROS's tests replace functions in ``launch.logging`` that create log folders.
    """
    return sys.modules.get("launch.logging") or sys.modules[__name__]


launch_config = LaunchConfig()


def get_logger(name: str | None = None) -> logging.Logger:
    """Return a logger that writes to the screen and the main log file.

    Its lines have the format of launch lines.
    """
    logger = logging.getLogger(name)
    for handler in (launch_config.get_screen_handler(), launch_config.main_file_handler):
        if handler not in logger.handlers and not _is_handled_by_parent(logger, handler):
            logger.addHandler(handler)
    if not launch_config.is_level_set and logger.getEffectiveLevel() > logging.INFO:
        logger.setLevel(logging.INFO)  # Python's default would hide lines that the launcher shows
    return logger


def _is_handled_by_parent(logger: logging.Logger, handler: logging.Handler) -> bool:
    """Return whether the lines of a logger reach a handler through one of its parent loggers."""
    ancestor: logging.Logger | None = logger if logger.propagate else None
    while ancestor is not None and ancestor.parent is not None:
        ancestor = ancestor.parent
        if handler in ancestor.handlers:
            return True
    return False


def log_launch_config(*, logger: logging.Logger = logging.root) -> None:
    """Log the folder of the log files and the minimum level."""
    if launch_config.file_handlers:
        logger.info("All log files can be found below %s", launch_config.log_dir)
    logger.info("Default logging verbosity is set to %s", logging.getLevelName(logging.root.getEffectiveLevel()))


def get_output_loggers(process_name: str, output_config: Any) -> tuple[logging.Logger, logging.Logger]:
    """Return the loggers for the stdout and stderr of a process.

    Args:
        process_name: the name of the process.
        output_config: the destinations, as for ``output`` of `linkwright.launch.model.actions.ExecuteProcess`.

    Raises:
        ValueError: the destinations are not valid.
    """
    destinations_by_source = _normalize_output_configuration(output_config)
    loggers = []
    for source in _STREAMS[:2]:
        logger = logging.getLogger(f"{process_name}-{source}")
        logger.propagate = False
        logger.setLevel(logging.INFO)
        plain_formatter = logging.Formatter("{msg}", style="{")
        timestamp_formatter = logging.Formatter("{created:.7f} {msg}", style="{")
        destinations = destinations_by_source[source] | destinations_by_source["both"]
        if "screen" in destinations:
            _add_handler(logger, launch_config.get_screen_handler(), plain_formatter)
        if "log" in destinations:
            _add_handler(logger, launch_config.get_log_file_handler(), timestamp_formatter)
        if "own_log" in destinations_by_source[source]:
            _add_handler(logger, launch_config.get_log_file_handler(f"{process_name}-{source}.log"), plain_formatter)
        if "own_log" in destinations_by_source["both"]:
            _add_handler(logger, launch_config.get_log_file_handler(f"{process_name}.log"), plain_formatter)
        loggers.append(logger)
    return loggers[0], loggers[1]


def _add_handler(logger: logging.Logger, handler: logging.Handler, formatter: logging.Formatter) -> None:
    if hasattr(handler, "setFormatterFor"):
        handler.setFormatterFor(logger, formatter)
    if handler not in logger.handlers:
        logger.addHandler(handler)


def _normalize_output_configuration(output_config: Any) -> dict[str, set[str]]:
    normalized: dict[str, set[str]] = {source: set() for source in _STREAMS}
    if isinstance(output_config, str) and output_config not in _DESTINATIONS_BY_OUTPUT:
        raise ValueError(f'{output_config} is not a valid standard output config i.e. "screen", "log" or "both"')
    output = _DESTINATIONS_BY_OUTPUT[output_config] if isinstance(output_config, str) else output_config
    if not isinstance(output, Mapping):
        raise ValueError(f"{output} is not a valid standard output config")  # noqa: TRY004 - as in ROS
    for source, destinations in output.items():
        if source not in normalized:
            raise ValueError(f"{source} is not a valid output source")
        chosen_destinations = {destinations} if isinstance(destinations, str) else set(destinations)
        if not chosen_destinations <= _DESTINATIONS:
            raise ValueError(f"{chosen_destinations} is not a valid output sources configuration")
        normalized[source] |= chosen_destinations
    return normalized


def reset() -> None:
    """Reset the configuration, and all loggers that have handlers of this package.

    The handlers are removed from these loggers, and the levels of the loggers are unset.
    """
    for logger in list(logging.root.manager.loggerDict.values()):
        handlers = getattr(logger, "handlers", ())
        remaining_handlers = [handler for handler in handlers if not isinstance(handler, ForEachLogger)]
        if len(remaining_handlers) < len(handlers) and isinstance(logger, logging.Logger):
            logger.handlers = remaining_handlers
            logger.setLevel(logging.NOTSET)
    for handler in launch_config.file_handlers.values():
        handler.close()
    launch_config.reset()
    launch_config.level = logging.INFO
