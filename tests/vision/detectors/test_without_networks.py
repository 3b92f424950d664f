"""Colors, markers, codes and lines: found in drawn images."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.images.color_words import RGB_BY_COLOR_WORD
from linkwright.vision.detections import Detections
from linkwright.vision.detector import Limits
from linkwright.vision.detectors.drawing import choose_class_color, draw_detections
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.registry import make_detector

LIMITS = Limits()
FLOOR = (150, 150, 145)


def blank_image(height=240, width=320):
    return np.full((height, width, 3), FLOOR, np.uint8)


def open_detector(name, **settings):
    return make_detector(name, DetectorOptions(settings=settings))


def detected_names(detections):
    return [detections.name(index) for index in range(len(detections))]


def test_color_detector_finds_balls_and_boxes():
    image = blank_image()
    cv2.circle(image, (80, 100), 30, (200, 20, 30), cv2.FILLED)
    image[40:80, 200:260] = (20, 60, 200)
    image[150:152, 10:14] = (20, 200, 40)
    detections = open_detector("colors").detect(image, LIMITS)
    assert detected_names(detections) == ["blue", "red"]
    assert detections.boxes[0].tolist() == [200, 40, 260, 80]
    assert detections.boxes[1] == pytest.approx([50, 70, 111, 131], abs=1)
    assert detections.scores == pytest.approx([1.0, 0.785], abs=0.05)


def test_custom_colors_and_class_selection_are_applied():
    image = blank_image()
    image[40:80, 200:260] = (20, 60, 200)
    image[40:80, 20:60] = (200, 20, 30)
    color_detector = open_detector(
        "colors", colors={"sky": [100, 100, 50, 130, 255, 255], "rose": [170, 100, 50, 5, 255, 255]}
    )
    assert sorted(detected_names(color_detector.detect(image, LIMITS))) == ["rose", "sky"]
    assert detected_names(color_detector.detect(image, Limits(classes=frozenset({"sky"})))) == ["sky"]
    assert detected_names(color_detector.detect(image, Limits(max_detections=1))) == ["sky"]
    assert len(open_detector("colors", least_area=1e6).detect(image, LIMITS)) == 0


@pytest.mark.parametrize(
    ("name", "dictionary", "kind", "number"),
    [
        ("aruco", None, cv2.aruco.DICT_4X4_50, 7),
        ("aruco", "DICT_6X6_250", cv2.aruco.DICT_6X6_250, 123),
        ("apriltag", None, cv2.aruco.DICT_APRILTAG_36h11, 3),
    ],
)
def test_marker_detections_are_named_by_id(name, dictionary, kind, number):
    image = np.full((240, 320, 3), 255, np.uint8)
    marker = cv2.aruco.generateImageMarker(cv2.aruco.getPredefinedDictionary(kind), number, 80)
    image[60:140, 100:180] = marker[..., np.newaxis]
    detections = open_detector(name, **({"dictionary": dictionary} if dictionary else {})).detect(image, LIMITS)
    assert detected_names(detections) == [str(number)]
    assert detections.boxes[0] == pytest.approx([100, 60, 180, 140], abs=1)
    assert detections.corners is not None
    assert detections.corners[0] == pytest.approx(np.array([[100, 60], [180, 60], [180, 140], [100, 140]]), abs=1)


def test_qr_code_detections_are_named_by_text():
    code = cv2.QRCodeEncoder.create().encode("kitchen")
    large = cv2.resize(code, None, fx=5, fy=5, interpolation=cv2.INTER_NEAREST)
    image = np.full((300, 400, 3), 255, np.uint8)
    image[50 : 50 + large.shape[0], 80 : 80 + large.shape[1]] = large[..., np.newaxis]
    detections = open_detector("qr").detect(image, LIMITS)
    assert detected_names(detections) == ["kitchen"]
    left, top, right, bottom = detections.boxes[0]
    assert 70 <= left < right <= 90 + large.shape[1]
    assert 40 <= top < bottom <= 60 + large.shape[0]
    assert len(open_detector("qr").detect(image, Limits(classes=frozenset({"bath"})))) == 0


@pytest.mark.parametrize("turned", [0.0, 0.3], ids=["from the front", "from the side"])
def test_small_qr_code_is_read(turned):
    code = cv2.copyMakeBorder(cv2.QRCodeEncoder.create().encode("kitchen"), *(4,) * 4, cv2.BORDER_CONSTANT, value=255)
    side = code.shape[0]
    corners = np.array([(0, 0), (side, 0), (side, side), (0, side)], np.float32)
    high = 100.0
    small_code = np.array(
        [(100, 80), (100 + high, 80 + turned * 20), (100 + high, 80 + high - turned * 20), (100, 80 + high)], np.float32
    )
    larger = cv2.getPerspectiveTransform(corners, 4 * small_code)
    image = cv2.warpPerspective(code, larger, (4 * 320, 4 * 240), flags=cv2.INTER_NEAREST, borderValue=120)
    image = cv2.resize(image, (320, 240), interpolation=cv2.INTER_AREA)
    detections = open_detector("qr").detect(np.repeat(image[..., np.newaxis], 3, axis=2), LIMITS)
    assert detected_names(detections) == ["kitchen"]
    # The box does not include the quiet zone of six modules.
    assert detections.boxes[0] == pytest.approx([118, 98, 182, 162], abs=4)


def test_partial_qr_codes_are_not_an_error():
    code = cv2.resize(cv2.QRCodeEncoder.create().encode("kitchen"), None, fx=6, fy=6, interpolation=cv2.INTER_NEAREST)
    numbers = np.random.default_rng(4)
    qr_detector = open_detector("qr")
    for _ in range(40):
        image = numbers.integers(0, 255, (240, 320), dtype=np.uint8)
        top, left = (int(integer) for integer in numbers.integers(0, 120, 2))
        part = code[: 240 - top, : 320 - left]
        image[top : top + part.shape[0], left : left + part.shape[1]] = part
        for _ in range(int(numbers.integers(0, 4))):
            y, x = (int(integer) for integer in numbers.integers(0, 200, 2))
            image[y : y + 30, x : x + 30] = 255
        detections = qr_detector.detect(np.repeat(image[..., np.newaxis], 3, axis=2), LIMITS)
        assert set(detected_names(detections)) <= {"kitchen"}


def test_line_on_floor_is_detected():
    image = blank_image()
    cv2.line(image, (200, 239), (200, 100), (20, 20, 20), 21)
    image[:100] = 0  # above the searched part of the image
    detections = open_detector("line").detect(image, LIMITS)
    assert detected_names(detections) == ["line"]
    left, top, right, bottom = detections.boxes[0]
    assert (left + right) / 2 == pytest.approx(200.5, abs=1)
    assert (top, bottom) == (180, 240)
    assert detections.scores[0] == 1.0
    line_detections = open_detector("line", part=1.0, color=[0, 0, 100, 179, 60, 200]).detect(image, LIMITS)
    assert line_detections.boxes[0][1] == 100


@pytest.mark.parametrize("name", ["colors", "aruco", "apriltag", "qr", "line"])
@pytest.mark.parametrize("shape", [(240, 320), (1, 1), (3, 400), (0, 0)])
def test_empty_images_have_no_detections(name, shape):
    image = np.full((*shape, 3), 200, np.uint8)
    assert len(open_detector(name).detect(image, LIMITS)) == 0


@pytest.mark.parametrize(
    ("name", "settings", "words"),
    [
        ("colors", {"colors": {}}, "'colors'"),
        ("colors", {"colors": {"red": [1, 2, 3]}}, "'colors.red'"),
        ("colors", {"colors": {"red": [200, 0, 0, 10, 255, 255]}}, "'colors.red'"),
        ("colors", {"least_area": "much"}, "'least_area'"),
        ("aruco", {"dictionary": "4X4_5"}, "'dictionary'"),
        ("line", {"part": 2.0}, "'part'"),
        ("line", {"color": "black"}, "'color'"),
    ],
)
def test_invalid_settings_are_rejected(name, settings, words):
    with pytest.raises(LinkwrightError) as raised:
        open_detector(name, **settings)
    (finding,) = raised.value.diagnostics
    assert finding.code == "VISION109"
    assert words in str(finding.message)


def test_detections_are_drawn_on_copy_of_image():
    image = blank_image()
    boxes = np.array([[50, 60, 150, 160], [200, 5, 400, 90]], np.float32)
    detections = Detections(boxes, np.array([0.9, 0.6], np.float32), np.array([0, 1], np.int32), ("ball", "box"))
    canvas = draw_detections(image, detections)
    assert tuple(canvas[160, 100]) == choose_class_color("ball")
    assert tuple(canvas[90, 300]) == choose_class_color("box")
    assert (image == FLOOR).all()
    assert (draw_detections(image, Detections.empty(("ball",))) == image).all()
    marker = Detections(
        boxes[:1],
        detections.scores[:1],
        detections.classes[:1],
        detections.names,
        np.array([[[50, 60], [150, 60], [150, 160], [50, 160]]], np.float32),
    )
    assert tuple(draw_detections(image, marker)[160, 100]) == choose_class_color("ball")
    assert choose_class_color("red") == choose_class_color("red cube") == RGB_BY_COLOR_WORD["red"]


NETWORKLESS_DETECTORS = ("colors", "aruco", "apriltag", "qr", "line")


@pytest.mark.parametrize("name", NETWORKLESS_DETECTORS)
@pytest.mark.parametrize(
    ("setting", "options"),
    [
        ("'labels'", {"labels": Path("names.txt")}),
        ("'imgsz'", {"size": (320, 640)}),
        ("'device'", {"device": "gpu"}),
    ],
)
def test_network_options_are_rejected(name, setting, options):
    with pytest.raises(LinkwrightError) as caught:
        make_detector(name, DetectorOptions(**options))
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "VISION109"
    assert setting in str(diagnostic.message)
    assert diagnostic.hint is not None


@pytest.mark.parametrize("name", NETWORKLESS_DETECTORS)
def test_unused_gpu_is_noted(name):
    (note,) = make_detector(name, DetectorOptions(device="cuda:0")).notes
    assert "'cuda:0'" in str(note)
    assert make_detector(name, DetectorOptions()).notes == ()
