"""The interface of detectors, which find boxes in an image."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase
from linkwright.vision.detections import Detections


@dataclass(frozen=True, slots=True)
class Limits:
    """The limits that detections must satisfy, with the defaults of yolo_ros.

    Attributes:
        threshold: the minimum score.
        iou: the overlap of two boxes of one class above which the less certain one is dropped.
        max_detections: the maximum number of detections per image.
        classes: the names of the classes to detect; None for all.
    """

    threshold: float = 0.5
    iou: float = 0.5
    max_detections: int = 300
    classes: frozenset[str] | None = None


class Detector(ABC):
    """An object detector, which only one thread at a time may call."""

    @property
    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """The class names, or an empty tuple if they depend on the image, as for QR codes."""

    @property
    def notes(self) -> tuple[Phrase, ...]:
        """Remarks for the user, for example that some outputs of a network are ignored."""
        return ()

    @abstractmethod
    def detect(self, image: NDArray[np.uint8], limits: Limits) -> Detections:
        """Detect objects in an image.

        Args:
            image: shape ``(height, width, 3)``, RGB.
            limits: the limits that the detections must satisfy.
        """
