"""apriltag_node: detections and poses, against values of the AprilTag library and against projected poses."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.arrays import quaternion_from_matrix
from linkwright.graph import LogLevel
from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from linkwright.testing.stepped import AsyncSteppedGraph
from linkwright.vision.detectors.april_tags import FAMILIES, AprilTagFinder
from linkwright.vision.nodes.apriltag_node import AprilTagNode

pytestmark = pytest.mark.extra("vision")

FOCAL, CENTER, SIDE = 600.0, 300.0, 600


def marker(family: str = "36h11", number: int = 7, wrong_bits: int = 0) -> np.ndarray:
    """Return the image of a tag with a white border, 20 pixels for each cell."""
    cv2 = pytest.importorskip("cv2")
    dictionary = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, FAMILIES[family]))
    cells = dictionary.markerSize + 2
    image = cv2.aruco.generateImageMarker(dictionary, number, 20 * cells)
    for bit in range(wrong_bits):
        corner = 20 * (2 + 2 * bit)
        image[corner : corner + 20, 40:60] = 255 - image[corner : corner + 20, 40:60]
    return np.pad(image, 20, constant_values=255)


def flat_image(**options) -> np.ndarray:
    image = np.full((SIDE, SIDE), 255, np.uint8)
    tag = marker(**options)
    image[180 : 180 + len(tag), 130 : 130 + len(tag)] = tag
    return image


def messages(pixels: np.ndarray, stamp: int = 1, focal: float = FOCAL):
    image = get_message("sensor_msgs/msg/Image")(width=SIDE, height=SIDE, step=SIDE, encoding="mono8")
    image.data = pixels.tobytes()
    info = get_message("sensor_msgs/msg/CameraInfo")(width=SIDE, height=SIDE)
    info.p = [focal, 0.0, CENTER, 0.0, 0.0, focal, CENTER, 0.0, 0.0, 0.0, 1.0, 0.0]
    for message in (image, info):
        message.header.stamp.sec, message.header.frame_id = stamp, "camera"
    return image, info


def warnings_of(test) -> list[str]:
    return [record.text for record in test.log if record.level is LogLevel.WARN]


@pytest.fixture
async def test():
    async with AsyncSteppedGraph() as graph:
        yield graph


@pytest.fixture
async def process(test):
    """Return a function that starts the node, sends an image, and returns the detections and the transforms."""
    nodes = []

    async def run(pixels, focal=FOCAL, **parameters):
        nodes.append(AprilTagNode(test.graph, NodeOptions(parameters=parameters)))
        detections, transforms = test.record("/detections"), test.record("/tf")
        await test.settle()
        image, info = messages(pixels, focal=focal)
        test.publish("/image_rect", image)
        test.publish("/camera_info", info)
        await test.settle()
        return detections, transforms

    yield run
    for node in nodes:
        node.close()


@pytest.mark.parametrize("family", FAMILIES)
def test_corners_and_homography_are_those_of_the_apriltag_library(family):
    (tag,) = AprilTagFinder(family, refine=True).find(flat_image(family=family))
    last = 150 + 20 * {"16h5": 6, "25h9": 7, "36h11": 8}[family]
    bottom = last + 50
    np.testing.assert_allclose(tag.corners, [(last, 200), (150, 200), (150, bottom), (last, bottom)], atol=0.6)
    for corner, place in zip(tag.corners, [(-1, 1), (1, 1), (1, -1), (-1, -1)], strict=True):
        x, y, scale = tag.homography @ (*place, 1.0)
        np.testing.assert_allclose((x / scale, y / scale), corner, atol=1e-3)
    assert (tag.number, tag.hamming) == (7, 0)
    assert tag.center == pytest.approx(((150 + last) / 2, (200 + bottom) / 2), abs=0.5)
    assert tag.decision_margin > 100.0


@pytest.mark.parametrize("method", ["pnp", "homography"])
async def test_pose_is_the_one_from_which_the_image_was_drawn(process, method):
    cv2 = pytest.importorskip("cv2")
    size, position = 0.2, np.array((0.05, -0.04, 0.8))
    tilt, turn = cv2.Rodrigues(np.array((0.5, 0.3, 0.0)))[0], np.diag((-1.0, 1.0, -1.0))
    rotation = tilt @ turn  # x left and y down in the image of OpenCV, which shows the tag turned by half a turn
    tag = marker()
    edge = 0.5 * size
    corners = np.array([(-edge, -edge, 0), (edge, -edge, 0), (edge, edge, 0), (-edge, edge, 0)]) @ rotation.T + position
    pixels = corners[:, :2] / corners[:, 2:] * FOCAL + CENTER
    last = len(tag) - 20
    drawn = np.array([(last, 20), (20, 20), (20, last), (last, last)], np.float32) - 0.5
    transform = cv2.getPerspectiveTransform(drawn, (pixels - 0.5).astype(np.float32))
    image = cv2.warpPerspective(tag, transform, (SIDE, SIDE), borderValue=255, flags=cv2.INTER_AREA)
    detections, transforms = await process(image, size=size, pose_estimation_method=method)
    (found,) = transforms.last.transforms
    assert (found.header.frame_id, found.child_frame_id) == ("camera", "tag36h11:7")
    translation, quaternion = found.transform.translation, found.transform.rotation
    np.testing.assert_allclose((translation.x, translation.y, translation.z), position, atol=0.01)
    expected = quaternion_from_matrix(rotation)
    similarity = abs(expected @ (quaternion.x, quaternion.y, quaternion.z, quaternion.w))
    assert similarity > np.cos(np.radians(3.0) / 2)
    (detection,) = detections.last.detections
    assert (detection.family, detection.id, detection.hamming) == ("tag36h11", 7, 0)


async def test_listed_tags_have_their_frames_and_sizes(process):
    image = flat_image()
    other = marker(number=9)
    image[390 : 390 + len(other), 330 : 330 + len(other)] = other
    parameters = {"tag.ids": [7, 3], "tag.frames": ["dock", "shelf"], "tag.sizes": [0.3, 0.1]}
    detections, transforms = await process(image, **parameters)
    assert [detection.id for detection in detections.last.detections] == [7]
    (found,) = transforms.last.transforms
    assert found.child_frame_id == "dock"
    assert found.transform.translation.z == pytest.approx(FOCAL * 0.3 / 160, rel=0.01)


@pytest.mark.parametrize(("max_hamming", "found"), [(0, []), (1, [1])])
async def test_corrected_tags_are_rejected_beyond_max_hamming(process, max_hamming, found):
    detections, _ = await process(flat_image(wrong_bits=1), max_hamming=max_hamming)
    assert [detection.hamming for detection in detections.last.detections] == found


async def test_uncalibrated_camera_gives_detections_without_poses(process, test):
    detections, transforms = await process(flat_image(), focal=0.0)
    assert len(detections.last.detections) == 1
    assert [list(message.transforms) for message in transforms] == [[]]
    assert any("not calibrated" in text for text in warnings_of(test))


async def test_empty_method_publishes_no_transforms(process, test):
    detections, transforms = await process(flat_image(), focal=0.0, pose_estimation_method="")
    assert len(detections.last.detections) == 1
    assert not list(transforms)
    assert not warnings_of(test)


@pytest.mark.parametrize(
    "parameters",
    [
        {"family": "Standard41h12"},
        {"qos_profile": "fast"},
        {"tag.ids": [1, 2], "tag.frames": ["one"]},
        {"tag.sizes": [0.1]},
    ],
)
async def test_invalid_parameters_are_refused(test, parameters):
    with pytest.raises(LinkwrightError) as caught:
        AprilTagNode(test.graph, NodeOptions(parameters=parameters))
    assert caught.value.diagnostics[0].code == "NODE433"
