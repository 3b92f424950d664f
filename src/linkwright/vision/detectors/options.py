"""The options of detectors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

MAX_SIZE = 8192
"""The maximum length in pixels of the longer side of a network's input."""


@dataclass(frozen=True, slots=True)
class DetectorOptions:
    """The options of a detector.

    Each detector uses only the options that apply to it.

    Attributes:
        labels: a file with the names of the classes; None for the names in the network's file.
        device: where a network runs: ``cpu``, ``cuda``, ``cuda:0``, ``0``.
        size: the height and width of a network's input, if it takes any size; None for the size used in training.
        settings: the settings of detectors without a network, by name.
    """

    labels: Path | None = None
    device: str = "cpu"
    size: tuple[int, int] | None = None
    settings: Mapping[str, object] = field(default_factory=dict)
