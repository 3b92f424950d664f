"""The options of detectors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

LARGEST_SIZE = 8192
"""Pixels of the longer side of a network's input, at most."""


@dataclass(frozen=True, slots=True)
class DetectorOptions:
    """The options of a detector; each detector uses only those that apply to it.

    Attributes:
        labels: a file with the names of the classes, instead of those in the network.
        device: where a network runs: ``cpu``, ``cuda``, ``cuda:0``, ``0``.
        size: height and width of a network's input, if it takes any size; None for the size used in training.
        settings: the settings of detectors without a network, by name.
    """

    labels: Path | None = None
    device: str = "cpu"
    size: tuple[int, int] | None = None
    settings: Mapping[str, object] = field(default_factory=dict)
