"""Functions for parameter files (``moveit.utils``)."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from itertools import pairwise
from tempfile import NamedTemporaryFile
from typing import Any

import yaml


def create_params_file_from_dict(params: Mapping[str, Any], node_name: str) -> str:
    """Write parameters of a node to a temporary file, and return its path."""
    with NamedTemporaryFile("w", prefix="launch_params_", suffix=".yaml", delete=False, encoding="utf-8") as file:
        yaml.safe_dump({node_name: {"ros__parameters": dict(params)}}, file)
    return file.name


def get_launch_params_filepaths(cli_args: Sequence[str] | None = None) -> list[str]:
    """Return the parameter files of a command line.

    Args:
        cli_args: the words of the command line; None for ``sys.argv``.
    """
    words = sys.argv if cli_args is None else cli_args
    return [path for option, path in pairwise(words) if option == "--params-file"]
