"""A check of the arguments with which the learner's launch file starts RViz."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.learning.checks.not_yet import NotYet

_OPTIONS = ("-d", "--display-config")


def require_rviz_configuration(arguments: Sequence[str], path: Path) -> None:
    """Require the arguments of RViz to name a configuration.

    Raises:
        NotYet: they name none, or another file.
    """
    config_paths = [value for option, value in pairwise(arguments) if option in _OPTIONS]
    if any(Path(value).exists() and Path(value).samefile(path) for value in config_paths):
        return
    if config_paths:
        raise NotYet(
            phrase(
                "rviz2 opens '{actual}', but should open 'rviz/{expected}'", actual=config_paths[0], expected=path.name
            )
        )
    raise NotYet(
        phrase(
            "rviz2 needs two arguments, '-d' and the path of {file}; the launch file passes {arguments}",
            file=path.name,
            arguments=" ".join(f"'{argument}'" for argument in arguments) or phrase("none"),
        )
    )
