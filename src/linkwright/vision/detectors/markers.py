"""The detectors ``aruco``, ``apriltag`` and ``qr``, for fiducial markers and QR codes."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase
from linkwright.vision.detections import Detections
from linkwright.vision.detector import Detector, Limits
from linkwright.vision.detectors.devices import refuse_network_options
from linkwright.vision.detectors.library import load_opencv
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.selection import select_detections
from linkwright.vision.detectors.settings import read_choice

_PREFIX = "DICT_"
_DEFAULT_MARKERS, _DEFAULT_TAGS = "4X4_50", "APRILTAG_36h11"


class MarkerDetector(Detector):
    """A detector of ArUco markers and AprilTags.

    The class of a marker is its ID, and the score is 1. Corners are in OpenCV's order: clockwise from the marker's
    upper left corner.

    Settings:
        ``dictionary``
            the marker dictionary, as OpenCV names it: ``4X4_50``, ``6X6_250``, ``APRILTAG_36h11``, ...

    Raises:
        LinkwrightError: VISION101 OpenCV is missing, VISION109 there is no such dictionary.
    """

    def __init__(self, options: DetectorOptions, dictionary: str = _DEFAULT_MARKERS) -> None:
        aruco = load_opencv().aruco
        self._notes = refuse_network_options(options)
        dictionaries = [name.removeprefix(_PREFIX) for name in sorted(dir(aruco)) if name.startswith(_PREFIX)]
        settings = {
            name: str(value).removeprefix(_PREFIX) for name, value in options.settings.items() if name == "dictionary"
        }
        dictionary_name = read_choice(settings, "dictionary", dictionary, dictionaries)
        marker_dictionary = aruco.getPredefinedDictionary(getattr(aruco, _PREFIX + dictionary_name))
        self._names = tuple(map(str, range(len(marker_dictionary.bytesList))))
        parameters = aruco.DetectorParameters()
        parameters.cornerRefinementMethod = aruco.CORNER_REFINE_SUBPIX
        self._detector = aruco.ArucoDetector(marker_dictionary, parameters)

    @property
    def names(self) -> tuple[str, ...]:
        """The IDs of the markers."""
        return self._names

    @property
    def notes(self) -> tuple[Phrase, ...]:
        """A remark that the detector does not need a GPU, if one was requested."""
        return self._notes

    def detect(self, image: NDArray[np.uint8], limits: Limits) -> Detections:
        """Detect the markers of the dictionary."""
        if min(image.shape[:2]) < MIN_IMAGE_SIDE_PIXELS:
            return Detections.empty(self._names)
        corners, ids, _ = self._detector.detectMarkers(to_gray(image))
        classes = [] if ids is None else [int(number) for number in np.ravel(ids)]
        marker_corners = [np.asarray(corner, np.float32).reshape(4, 2) + 0.5 for corner in corners]
        boxes = [_find_bounding_box(points) for points in marker_corners]
        return select_detections(boxes, [1.0] * len(classes), classes, self._names, limits, marker_corners)


class AprilTagDetector(MarkerDetector):
    """A `MarkerDetector` with another default: 36h11, the tag family that robots usually use."""

    def __init__(self, options: DetectorOptions) -> None:
        super().__init__(options, _DEFAULT_TAGS)


class QrDetector(Detector):
    """A detector of QR codes.

    The class of a code is its text, and the score is 1. Unreadable codes are omitted. OpenCV finds some codes that are
    too small for it to read. They are cut out, rectified, enlarged and read again.

    Raises:
        LinkwrightError: VISION101 OpenCV is missing, VISION109 there are options that only networks have.
    """

    def __init__(self, options: DetectorOptions) -> None:
        self._detector = load_opencv().QRCodeDetectorAruco()
        self._notes = refuse_network_options(options)

    @property
    def names(self) -> tuple[str, ...]:
        """Always empty: the classes are the texts in the images."""
        return ()

    @property
    def notes(self) -> tuple[Phrase, ...]:
        """A remark that the detector does not need a GPU, if one was requested."""
        return self._notes

    def detect(self, image: NDArray[np.uint8], limits: Limits) -> Detections:
        """Detect and read QR codes."""
        if min(image.shape[:2]) < MIN_IMAGE_SIDE_PIXELS:
            return Detections.empty(())
        gray = to_gray(image)
        has_codes, texts, corners, _ = self._detector.detectAndDecodeMulti(gray)
        codes = [np.asarray(corner, np.float32).reshape(4, 2) for corner in corners] if has_codes else []
        decoded = [text or self._read(gray, code) for text, code in zip(texts, codes, strict=False)]
        readable = [index for index, text in enumerate(decoded) if text]
        names = tuple(dict.fromkeys(decoded[index] for index in readable))
        code_corners = [codes[index] + 0.5 for index in readable]
        classes = [names.index(decoded[index]) for index in readable]
        return select_detections(
            [_find_bounding_box(points) for points in code_corners],
            [1.0] * len(readable),
            classes,
            names,
            limits,
            code_corners,
        )

    def _read(self, gray: NDArray[np.uint8], corners: NDArray[np.float32]) -> str:
        """Rectify and enlarge a code, and return its text, or an empty string if it cannot be read."""
        cv2 = load_opencv()
        start, end = _QUIET_ZONE_PIXELS, _QUIET_ZONE_PIXELS + _ENLARGED_SIDE_PIXELS
        square = np.array([(start, start), (end, start), (end, end), (start, end)], np.float32)
        size = (start + end, start + end)
        rectified = cv2.warpPerspective(gray, cv2.getPerspectiveTransform(corners, square), size, flags=cv2.INTER_CUBIC)
        return str(self._detector.detectAndDecode(rectified)[0])


_ENLARGED_SIDE_PIXELS, _QUIET_ZONE_PIXELS = 340, 40
"""The side of an enlarged code, and the width of the empty border around it, in pixels."""
MIN_IMAGE_SIDE_PIXELS = 8
"""The minimum side of an image in pixels: OpenCV fails on smaller images."""


def to_gray(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return an RGB image in shades of gray."""
    cv2 = load_opencv()
    gray: NDArray[np.uint8] = cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)
    return gray


def _find_bounding_box(corners: NDArray[np.floating[Any]]) -> list[float]:
    """Return the bounding box of four points: left, top, right, bottom."""
    return [*map(float, corners.min(axis=0)), *map(float, corners.max(axis=0))]
