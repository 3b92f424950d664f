"""AprilTags with the facts that apriltag_ros publishes: corners in its order, corrected bits, homography and pose.

OpenCV draws and finds the tags of the AprilTag library turned by half a turn, so the corners are reordered. The library
lists them counterclockwise in the image, beginning at (-1, 1) of the tag; x points right and y down there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.vision.detectors.library import load_opencv
from linkwright.vision.detectors.markers import MIN_IMAGE_SIDE_PIXELS

Array = NDArray[np.float64]

FAMILIES = {"16h5": "DICT_APRILTAG_16h5", "25h9": "DICT_APRILTAG_25h9", "36h11": "DICT_APRILTAG_36h11"}
"""The supported tag families, and OpenCV's names of their dictionaries."""
_ORDER = [1, 0, 3, 2]
"""The positions of the library's corners among OpenCV's."""
_TAG_CORNERS = np.array([(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)], np.float32)
_POSE_CORNERS = np.array([(-0.5, -0.5, 0.0), (0.5, -0.5, 0.0), (0.5, 0.5, 0.0), (-0.5, 0.5, 0.0)])
_BORDER_CELLS = 1


@dataclass(frozen=True, slots=True)
class AprilTag:
    """A tag in an image.

    Attributes:
        number: its ID.
        hamming: the number of wrong bits, which were corrected.
        decision_margin: the mean difference of cells from the threshold between black and white, 0 to 127.5.
        corners: in pixels, in the library's order, shape (4, 2); integers are the borders of pixels.
        homography: maps tag coordinates from -1 to 1 to pixels, shape (3, 3).
    """

    number: int
    hamming: int
    decision_margin: float
    corners: Array
    homography: Array

    @property
    def center(self) -> tuple[float, float]:
        """The center in pixels."""
        x, y, scale = self.homography[:, 2]
        return float(x / scale), float(y / scale)


class AprilTagFinder:
    """A finder of the tags of a family.

    Args:
        family: a key of `FAMILIES`.
        refine: whether corners are found to a fraction of a pixel.

    Raises:
        LinkwrightError: VISION101, OpenCV is missing.
    """

    def __init__(self, family: str, *, refine: bool) -> None:
        self._cv2 = load_opencv()
        aruco = self._cv2.aruco
        self._dictionary = aruco.getPredefinedDictionary(getattr(aruco, FAMILIES[family]))
        parameters = aruco.DetectorParameters()
        parameters.cornerRefinementMethod = aruco.CORNER_REFINE_SUBPIX if refine else aruco.CORNER_REFINE_NONE
        self._detector = aruco.ArucoDetector(self._dictionary, parameters)

    def find(self, image: NDArray[np.uint8]) -> list[AprilTag]:
        """Return the tags in a gray image."""
        if min(image.shape) < MIN_IMAGE_SIDE_PIXELS:
            return []
        corner_sets, numbers, _ = self._detector.detectMarkers(np.ascontiguousarray(image))
        if numbers is None:
            return []
        found = zip(corner_sets, np.ravel(numbers), strict=True)
        return [self._describe(image, np.reshape(corners, (4, 2)), int(number)) for corners, number in found]

    def _describe(self, image: NDArray[np.uint8], corners: Any, number: int) -> AprilTag:
        cv2, side = self._cv2, self._dictionary.markerSize + 2 * _BORDER_CELLS
        edge = side - 0.5
        square = np.array([(-0.5, -0.5), (edge, -0.5), (edge, edge), (-0.5, edge)], np.float32)
        cells = cv2.warpPerspective(image, cv2.getPerspectiveTransform(corners, square), (side, side)).astype(float)
        threshold = (cells.min() + cells.max()) / 2.0
        bits = (cells > threshold)[_BORDER_CELLS:-_BORDER_CELLS, _BORDER_CELLS:-_BORDER_CELLS]
        code = self._dictionary.getBitsFromByteList(
            self._dictionary.bytesList[number : number + 1], self._dictionary.markerSize
        )
        points = corners[_ORDER].astype(np.float32) + 0.5
        return AprilTag(
            number,
            int((bits != (code > 0)).sum()),
            float(np.abs(cells - threshold).mean()),
            points.astype(np.float64),
            cv2.getPerspectiveTransform(_TAG_CORNERS, points),
        )


def estimate_pose(tag: AprilTag, intrinsics: Array, size: float, *, is_iterative: bool) -> tuple[Array, Array]:
    """Return the pose of a tag in the frame of the camera: its rotation as a matrix, and its position in m.

    The tag's x axis points right, its y axis up, and its z axis out of the tag.

    Args:
        tag: the tag.
        intrinsics: focal lengths and principal point of the rectified image in pixels: fx, fy, cx, cy.
        size: the length of an edge of the black square in m.
        is_iterative: whether the distance between the corners and their projections is minimized; otherwise the pose
            follows from the homography in one step.
    """
    cv2 = load_opencv()
    fx, fy, cx, cy = intrinsics
    matrix = np.array([(fx, 0.0, cx), (0.0, fy, cy), (0.0, 0.0, 1.0)])
    if is_iterative:
        _, rotation, position = cv2.solvePnP(_POSE_CORNERS * size, tag.corners, matrix, None)
    else:
        _, rotation, position = cv2.solvePnP(_POSE_CORNERS * size, tag.corners, matrix, None, flags=cv2.SOLVEPNP_IPPE)
    return cv2.Rodrigues(rotation)[0], np.ravel(position)
