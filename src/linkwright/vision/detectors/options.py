"""Options of detectors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

LARGEST_SIZE = 8192
"""Pixels of the longer side of a network's input, at most."""


@dataclass(frozen=True, slots=True)
class DetectorOptions:
    """Options of a detector; each takes those that it has a use for.

    Attributes:
        labels: a file with the names of the classes, instead of those in the network.
        device: where a network runs: ``cpu``, ``cuda``, ``cuda:0``, ``0``.
        size: height and width of a network's input, for those that take any; None for that of its training.
        settings: by name, those of the detectors that need no network.
    """

    labels: Path | None = None
    device: str = "cpu"
    size: tuple[int, int] | None = None
    settings: Mapping[str, object] = field(default_factory=dict)
