"""Stands in for ``launch.logging``."""

from launch.logging import handlers
from linkwright.launch.engine.user_logging import (
    LaunchConfig,
    _get_logging_directory,
    _make_unique_log_dir,
    _normalize_output_configuration,
    _renew_latest_log_dir,
    get_logger,
    get_output_loggers,
    launch_config,
    log_launch_config,
    reset,
)
from linkwright.standins.imported_names import submodules_of

__all__ = [
    "LaunchConfig",
    "_get_logging_directory",
    "_make_unique_log_dir",
    "_normalize_output_configuration",
    "_renew_latest_log_dir",
    "get_logger",
    "get_output_loggers",
    "handlers",
    "launch_config",
    "log_launch_config",
    "reset",
]

__getattr__ = submodules_of(__name__)
