"""Common options of bag commands: ``--storage`` and ``--qos-profile-overrides-path``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase

if TYPE_CHECKING:
    from linkwright.graph import QoSProfile


def add_storage_argument(parser: argparse.ArgumentParser) -> None:
    """Declare the option ``--storage``."""
    parser.add_argument(
        "-s",
        "--storage",
        choices=("mcap", "sqlite3"),
        help="accepted for compatibility with ros2; the format is read from the files",
    )


def add_overrides_argument(parser: argparse.ArgumentParser) -> None:
    """Declare the option ``--qos-profile-overrides-path``."""
    parser.add_argument(
        "--qos-profile-overrides-path",
        metavar="FILE",
        help="a YAML file that maps topics to QoS policies, which override the policies of the "
        "discovered publishers and subscriptions",
    )


def read_overrides(arguments: argparse.Namespace) -> dict[str, QoSProfile]:
    """Return the QoS profiles by topic from the overrides file, or an empty dict without one.

    Raises:
        LinkwrightError: BAG106, the file cannot be read or is not a valid overrides file.
    """
    path = arguments.qos_profile_overrides_path
    if path is None:
        return {}
    import yaml

    from linkwright.bag.qos import parse_overrides
    from linkwright.files.input_files import read_text

    try:
        document = yaml.safe_load(read_text(path))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise LinkwrightError(
            Diagnostic(
                "BAG106",
                phrase("'{path}' cannot be read as QoS overrides: {reason}", path=path, reason=foreign(reason)),
            )
        ) from error
    return parse_overrides(document, path)
