"""The option ``--storage`` of the verbs that read."""

from __future__ import annotations

import argparse


def add_storage_argument(parser: argparse.ArgumentParser) -> None:
    """Declare the option."""
    parser.add_argument(
        "-s", "--storage", choices=("mcap", "sqlite3"), help="accepted for ros2's sake; the files tell their format"
    )
