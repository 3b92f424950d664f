"""The interface of detectors: an image in, boxes out."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase
from linkwright.vision.detections import Detections


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of detections. Defaults are those of yolo_ros.

    Attributes:
        threshold: the least score.
        iou: how much two boxes of one class may overlap before the less certain is dropped.
        most: the largest number of detections of an image.
        classes: the names of the classes to detect; None for all.
    """

    threshold: float = 0.5
    iou: float = 0.5
    most: int = 300
    classes: frozenset[str] | None = None


class Detector(ABC):
    """Detects objects in images. One thread at a time calls it."""

    @property
    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """The names of its classes; empty if they are only known from images, such as the texts of QR codes."""

    @property
    def notes(self) -> tuple[Phrase, ...]:
        """Remarks for its user, such as which of its results are left out."""
        return ()

    @abstractmethod
    def detect(self, image: NDArray[np.uint8], limits: Limits) -> Detections:
        """Detect objects in an image.

        Args:
            image: shape ``(height, width, 3)``, red, green, blue.
            limits: which detections count.
        """
