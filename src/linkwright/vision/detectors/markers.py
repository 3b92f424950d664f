"""The detectors ``aruco``, ``apriltag`` and ``qr``: fiducial markers and codes."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase
from linkwright.vision.detections import Detections
from linkwright.vision.detector import Detector, Limits
from linkwright.vision.detectors.devices import without_network
from linkwright.vision.detectors.library import load_opencv
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.selection import most_certain
from linkwright.vision.detectors.settings import choice

_PREFIX = "DICT_"
_USUAL_MARKERS, _USUAL_TAGS = "4X4_50", "APRILTAG_36h11"


class MarkerDetector(Detector):
    """Detects ArUco markers and AprilTags; the class of a marker is its ID, its score 1.

    Corners are in OpenCV's order: clockwise, from the marker's upper left corner.

    Settings:
        ``dictionary``
            the marker dictionary, as OpenCV names it: ``4X4_50``, ``6X6_250``, ``APRILTAG_36h11``, ...

    Raises:
        LinkwrightError: VISION101 OpenCV is missing, VISION109 there is no such dictionary.
    """

    def __init__(self, options: DetectorOptions, dictionary: str = _USUAL_MARKERS) -> None:
        aruco = load_opencv().aruco
        self._notes = without_network(options)
        known = [name.removeprefix(_PREFIX) for name in sorted(dir(aruco)) if name.startswith(_PREFIX)]
        given = {
            name: str(value).removeprefix(_PREFIX) for name, value in options.settings.items() if name == "dictionary"
        }
        chosen = choice(given, "dictionary", dictionary, known)
        markers = aruco.getPredefinedDictionary(getattr(aruco, _PREFIX + chosen))
        self._names = tuple(map(str, range(len(markers.bytesList))))
        parameters = aruco.DetectorParameters()
        parameters.cornerRefinementMethod = aruco.CORNER_REFINE_SUBPIX
        self._detector = aruco.ArucoDetector(markers, parameters)

    @property
    def names(self) -> tuple[str, ...]:
        """The IDs of the markers."""
        return self._names

    @property
    def notes(self) -> tuple[Phrase, ...]:
        """A remark that the detector does not need a GPU, if one was requested."""
        return self._notes

    def detect(self, image: NDArray[np.uint8], limits: Limits) -> Detections:
        """Find markers."""
        if min(image.shape[:2]) < _SMALLEST_SIDE:
            return Detections.none(self._names)
        corners, numbers, _ = self._detector.detectMarkers(_grey(image))
        classes = [] if numbers is None else [int(number) for number in np.ravel(numbers)]
        places = [np.asarray(corner, np.float32).reshape(4, 2) + 0.5 for corner in corners]
        boxes = [_box(place) for place in places]
        return most_certain(boxes, [1.0] * len(classes), classes, self._names, limits, places)


class AprilTagDetector(MarkerDetector):
    """A `MarkerDetector` whose default is the tag family that robots usually use, 36h11."""

    def __init__(self, options: DetectorOptions) -> None:
        super().__init__(options, _USUAL_TAGS)


class QrDetector(Detector):
    """Detects QR codes; the class of a code is its text, its score 1. Unreadable codes are omitted.

    OpenCV finds codes at a size at which it cannot read them yet. Such codes are cut out, rectified, enlarged, and read
    again.

    Raises:
        LinkwrightError: VISION101 OpenCV is missing, VISION109 it is given options that only networks have.
    """

    def __init__(self, options: DetectorOptions) -> None:
        self._detector = load_opencv().QRCodeDetectorAruco()
        self._notes = without_network(options)

    @property
    def names(self) -> tuple[str, ...]:
        """Always empty: the classes are the texts in the images."""
        return ()

    @property
    def notes(self) -> tuple[Phrase, ...]:
        """A remark that the detector does not need a GPU, if one was requested."""
        return self._notes

    def detect(self, image: NDArray[np.uint8], limits: Limits) -> Detections:
        """Find and read codes."""
        if min(image.shape[:2]) < _SMALLEST_SIDE:
            return Detections.none(())
        grey = _grey(image)
        found, texts, corners, _ = self._detector.detectAndDecodeMulti(grey)
        codes = [np.asarray(corner, np.float32).reshape(4, 2) for corner in corners] if found else []
        decoded = [text or self._read(grey, code) for text, code in zip(texts, codes, strict=False)]
        read = [index for index, text in enumerate(decoded) if text]
        names = tuple(dict.fromkeys(decoded[index] for index in read))
        places = [codes[index] + 0.5 for index in read]
        classes = [names.index(decoded[index]) for index in read]
        return most_certain([_box(place) for place in places], [1.0] * len(read), classes, names, limits, places)

    def _read(self, grey: NDArray[np.uint8], corners: NDArray[np.float32]) -> str:
        """Return the text of the code with these corners, or an empty text if it cannot be read.

        The code is rectified and enlarged before.
        """
        cv2 = load_opencv()
        near, far = _QUIET_ZONE, _QUIET_ZONE + _ENLARGED
        square = np.array([(near, near), (far, near), (far, far), (near, far)], np.float32)
        size = (near + far, near + far)
        seen = cv2.warpPerspective(grey, cv2.getPerspectiveTransform(corners, square), size, flags=cv2.INTER_CUBIC)
        return str(self._detector.detectAndDecode(seen)[0])


_ENLARGED, _QUIET_ZONE = 340, 40
"""Pixels along a side of a code that is read once more, and around it."""
_SMALLEST_SIDE = 8
"""The least side of an image: in smaller ones OpenCV fails instead of finding nothing."""


def _grey(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    cv2 = load_opencv()
    grey: NDArray[np.uint8] = cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)
    return grey


def _box(corners: NDArray[np.floating[Any]]) -> list[float]:
    """Return the bounding box of four points: left, top, right, bottom."""
    return [*map(float, corners.min(axis=0)), *map(float, corners.max(axis=0))]
