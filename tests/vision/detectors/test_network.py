"""Networks in ONNX files.

Each layout is compared with direct calls of onnxruntime and with a slow decoder.
"""

from __future__ import annotations

import json

import cv2
import numpy as np
import onnx
import onnxruntime
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.model_files.onnx_sessions import load_session
from linkwright.vision.detector import Limits
from linkwright.vision.detectors import sessions
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.registry import detector_names, make_detector
from tests.vision.detectors.networks import write_column_network, write_constant_network

NAMES = {"names": "{0: 'ball', 1: 'box', 2: 'cat'}", "task": "detect", "stride": "32", "imgsz": "[96, 128]"}
LIMITS = Limits(threshold=0.6, iou=0.45)


@pytest.fixture
def image():
    random = np.random.default_rng(7)
    coarse = random.integers(0, 256, (12, 20, 3), dtype=np.uint8)
    return cv2.resize(coarse, (200, 120), interpolation=cv2.INTER_CUBIC)


def open_detector(path, **options):
    return make_detector(str(path), DetectorOptions(**options))


def run_by_hand(path, image, rows, cols, padded=None):
    """Compute the input step by step, and return onnxruntime's output for it."""
    height, width = image.shape[:2]
    scale = min(rows / height, cols / width)
    new = (round(width * scale), round(height * scale))
    free = cols - new[0], rows - new[1]
    if padded:
        free = free[0] % padded, free[1] % padded
    left, top = round(free[0] / 2 - 0.1), round(free[1] / 2 - 0.1)
    resized = cv2.resize(image, new, interpolation=cv2.INTER_LINEAR)
    bordered = cv2.copyMakeBorder(
        resized, top, free[1] - top, left, free[0] - left, cv2.BORDER_CONSTANT, value=(114, 114, 114)
    )
    session = onnxruntime.InferenceSession(path, providers=["CPUExecutionProvider"])
    kind = np.float16 if "float16" in session.get_inputs()[0].type else np.float32
    tensor = (bordered.astype(np.float32) / 255).astype(kind).transpose(2, 0, 1)[None]
    scales = new[0] / width, new[1] / height
    return session.run(None, {"images": tensor})[0].astype(np.float32), scales, left, top


def intersection_over_union(first, second):
    width = min(first[2], second[2]) - max(first[0], second[0])
    height = min(first[3], second[3]) - max(first[1], second[1])
    common = max(0, width) * max(0, height)
    union_area = (
        (first[2] - first[0]) * (first[3] - first[1]) + (second[2] - second[0]) * (second[3] - second[1]) - common
    )
    return common / union_area


def decode_boxes_slowly(rows, classes, limits, objectness=False):
    """Return the boxes by a slow reference algorithm: (score, class, corners in the input)."""
    detections = []
    for row in rows:
        scores = [float(row[4 + objectness + index]) * (float(row[4]) if objectness else 1) for index in range(classes)]
        best_class = max(range(classes), key=scores.__getitem__)
        if scores[best_class] >= limits.threshold:
            x, y, w, h = map(float, row[:4])
            detections.append((scores[best_class], best_class, (x - w / 2, y - h / 2, x + w / 2, y + h / 2)))
    detections.sort(key=lambda detection: -detection[0])
    selected = []
    for detection in detections:
        if all(
            other[1] != detection[1] or intersection_over_union(other[2], detection[2]) <= limits.iou
            for other in selected
        ):
            selected.append(detection)
    return selected[: limits.max_detections]


def check_detections(detections, expected, image, scale, left, top, tolerance=1e-3):
    assert len(detections) == len(expected) > 3
    height, width = image.shape[:2]
    for index, (score, which, box) in enumerate(expected):
        placed = [(coordinate - (left, top)[axis % 2]) / scale[axis % 2] for axis, coordinate in enumerate(box)]
        limits = [width, height, width, height]
        assert detections.boxes[index] == pytest.approx(
            [min(max(coordinate, 0), limit) for coordinate, limit in zip(placed, limits, strict=True)], abs=tolerance
        )
        assert detections.scores[index] == pytest.approx(score, abs=1e-5)
        assert detections.classes[index] == which
    assert len(set(map(detections.name, range(len(detections))))) > 1


def test_yolov8_columns_are_decoded(tmp_path, image):
    path = write_column_network(tmp_path / "v8.onnx", metadata=NAMES)
    output, *place = run_by_hand(path, image, 96, 128)
    assert output.shape == (1, 7, 252)
    detector = open_detector(path)
    assert detector.names == ("ball", "box", "cat")
    assert detector.notes == ()
    check_detections(detector.detect(image, LIMITS), decode_boxes_slowly(output[0].T, 3, LIMITS), image, *place)


def test_yolov5_rows_with_objectness_are_decoded(tmp_path, image):
    limits = Limits(threshold=0.3, iou=0.45)
    path = write_column_network(
        tmp_path / "v5.onnx", transposed=True, objectness=True, metadata={"names": "['ball', 'box', 'cat']"}
    )
    output, *place = run_by_hand(path, image, 96, 128)
    assert output.shape == (1, 756, 8)
    check_detections(
        open_detector(path).detect(image, limits), decode_boxes_slowly(output[0], 3, limits, True), image, *place
    )


def test_yolov5_with_one_class_is_not_mistaken_for_final_boxes(tmp_path, image):
    limits = Limits(threshold=0.3, iou=0.45)
    path = write_column_network(
        tmp_path / "v5.onnx", 1, transposed=True, objectness=True, metadata={"names": "['ball']"}
    )
    output, *_ = run_by_hand(path, image, 96, 128)
    assert output.shape == (1, 756, 6)
    detections = open_detector(path).detect(image, limits)
    assert len(detections) == len(decode_boxes_slowly(output[0], 1, limits, True))


@pytest.mark.parametrize("message", [{"end2end": "True"}, {"args": "{'batch': 1, 'nms': True}"}, {}])
def test_final_boxes_are_decoded(tmp_path, image, message):
    rows = np.zeros((1, 300, 6), np.float32)
    rows[0, 0] = [10, 20, 40, 60, 0.9, 2]
    rows[0, 1] = [11, 20, 40, 60, 0.8, 2]
    rows[0, 2] = [0, 0, 128, 96, 0.7, 0]
    rows[0, 3] = [0, 0, 50, 50, 0.3, 1]
    path = write_constant_network(tmp_path / "v10.onnx", rows, {**NAMES, **message})
    detections = open_detector(path).detect(image, LIMITS)
    assert [detections.name(index) for index in range(len(detections))] == ["cat", "cat", "ball"]
    x_scale, y_scale, top = 128 / 200, 77 / 120, round((96 - 77) / 2 - 0.1)
    assert detections.boxes[0] == pytest.approx(
        [10 / x_scale, (20 - top) / y_scale, 40 / x_scale, (60 - top) / y_scale], abs=1e-4
    )
    assert detections.boxes[2].tolist() == [0, 0, 200, 120]


def test_dynamic_input_has_smallest_size_for_image(tmp_path, image):
    path = write_column_network(tmp_path / "any.onnx", size=None, metadata=NAMES)
    output, *place = run_by_hand(path, image, 128, 160, padded=32)
    assert output.shape[2] == 12 * 20 + 6 * 10 + 3 * 5  # 96 x 160
    detections = open_detector(path, size=(120, 160)).detect(image, LIMITS)
    check_detections(detections, decode_boxes_slowly(output[0].T, 3, LIMITS), image, *place)


def test_half_precision_network_is_decoded(tmp_path, image):
    path = write_column_network(tmp_path / "half.onnx", metadata=NAMES, is_half_precision=True)
    output, *place = run_by_hand(path, image, 96, 128)
    check_detections(
        open_detector(path).detect(image, LIMITS),
        decode_boxes_slowly(output[0].T, 3, LIMITS),
        image,
        *place,
        tolerance=1e-2,
    )


@pytest.mark.parametrize("task", ["segment", ""])
def test_masks_are_ignored_with_note(tmp_path, image, task):
    facts = {**NAMES, "task": task}
    path = write_column_network(tmp_path / "seg.onnx", metadata=facts, masks=32)
    output, *place = run_by_hand(path, image, 96, 128)
    detector = open_detector(path)
    check_detections(detector.detect(image, LIMITS), decode_boxes_slowly(output[0].T, 3, LIMITS), image, *place)
    assert [str(note) for note in detector.notes] == ["only the boxes of 'seg.onnx' are used; its masks are ignored"]


def test_keypoints_are_ignored_with_note(tmp_path, image):
    facts = {"names": "{0: 'person'}", "task": "pose", "kpt_shape": "[17, 3]"}
    path = write_column_network(tmp_path / "pose.onnx", 1, metadata=facts, extra_columns=51)
    output, *_ = run_by_hand(path, image, 96, 128)
    detector = open_detector(path)
    assert len(detector.detect(image, LIMITS)) == len(decode_boxes_slowly(output[0].T, 1, LIMITS))
    assert "keypoints are ignored" in str(detector.notes[0])


def test_limits_select_classes_and_number_of_detections(tmp_path, image):
    path = write_column_network(tmp_path / "v8.onnx", metadata=NAMES)
    detector = open_detector(path)
    detections = detector.detect(image, Limits(0.6, 0.45, classes=frozenset({"cat"})))
    assert {detections.name(index) for index in range(len(detections))} == {"cat"}
    assert len(detector.detect(image, Limits(0.6, 0.45, max_detections=2))) == 2
    assert len(detector.detect(image, Limits(0.9999))) == 0


def test_labels_file_overrides_names_of_network(tmp_path, image):
    path = write_column_network(tmp_path / "v8.onnx", metadata=NAMES)
    for name, text in {
        "labels.txt": "one\ntwo\n\nthree\n",
        "data.yaml": "names: {0: one, 1: two, 2: three}",
        "labels.json": json.dumps(["one", "two", "three"]),
    }.items():
        labels = tmp_path / name
        labels.write_text(text)
        assert open_detector(path, labels=labels).names == ("one", "two", "three")


def test_classes_without_names_are_numbered(tmp_path):
    detector = open_detector(write_column_network(tmp_path / "v8.onnx"))
    assert detector.names == ("0", "1", "2")
    assert "pass a labels file" in str(detector.notes[0])


def test_missing_gpu_is_noted(tmp_path):
    path = write_column_network(tmp_path / "v8.onnx", metadata=NAMES)
    if "CUDAExecutionProvider" in onnxruntime.get_available_providers():
        pytest.skip("this machine has a GPU")
    assert [str(note) for note in open_detector(path, device="cuda:0").notes] == [
        "this installation of onnxruntime does not support 'cuda:0'; the network runs on the CPU"
    ]


def test_missing_cuda_libraries_fall_back_to_cpu_with_note(tmp_path, monkeypatch):
    """Without CUDA, onnxruntime-gpu lists the provider, but creates a session without it."""
    path = write_column_network(tmp_path / "v8.onnx", metadata=NAMES)
    monkeypatch.setattr(sessions, "has_cuda", lambda: True)
    monkeypatch.setattr(sessions, "load_session", lambda file, gpu: load_session(file))
    assert [str(note) for note in open_detector(path, device="cuda:0").notes] == [
        "CUDA does not work with 'cuda:0' on this machine; the network runs on the CPU"
    ]


def test_fixed_input_size_is_noted(tmp_path):
    path = write_column_network(tmp_path / "v8.onnx", metadata=NAMES)
    assert "is always 128 x 96 pixels" in str(open_detector(path, size=(320, 320)).notes[0])


def refusal(path, **options):
    with pytest.raises(LinkwrightError) as raised:
        open_detector(path, **options)
    (finding,) = raised.value.diagnostics
    return finding.code, str(finding.message), str(finding.hint)


def test_corrupt_file_is_rejected(tmp_path):
    path = write_column_network(tmp_path / "v8.onnx", metadata=NAMES)
    path.write_bytes(path.read_bytes()[:-100])
    code, message, _ = refusal(path)
    assert code == "VISION103"
    assert "v8.onnx" in message
    path.write_bytes(b"")
    assert refusal(path)[0] == "VISION103"


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "the file is empty"),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n", "it is a Git LFS pointer"),
        (b"\n<!DOCTYPE html><html></html>", "it is a web page"),
        (b"not a network\n", "it is a text file, not an ONNX file"),
        (bytes(1000), "it is not an ONNX file, or it is incomplete"),
    ],
)
def test_files_that_are_not_networks_are_rejected_with_reason(tmp_path, content, reason):
    path = tmp_path / "best.onnx"
    path.write_bytes(content)
    code, message, _ = refusal(path)
    assert code == "VISION103"
    assert message.startswith(f"cannot load the network in '{path}': {reason}")


@pytest.mark.parametrize("change", ["ir", "opset"])
def test_file_for_newer_onnxruntime_is_rejected(tmp_path, change):
    path = write_column_network(tmp_path / "new.onnx", metadata=NAMES)
    model = onnx.load(path)
    if change == "ir":
        model.ir_version = 99
    else:
        model.opset_import[0].version = 99
    onnx.save(model, path)
    code, message, hint = refusal(path)
    assert (code, "requires a newer onnxruntime" in hint) == ("VISION103", True)
    assert "onnxruntime_src" not in message


@pytest.mark.parametrize("size_threshold", [0, 64])
def test_missing_external_weights_are_reported(tmp_path, size_threshold):
    path = write_column_network(tmp_path / "two.onnx", metadata=NAMES)
    onnx.save(onnx.load(path), path, save_as_external_data=True, location="weights.bin", size_threshold=size_threshold)
    (tmp_path / "weights.bin").unlink()
    code, _, hint = refusal(path)
    assert (code, "second file" in hint) == ("VISION103", True)


@pytest.mark.parametrize("device", ["gpu", "tpu", "cuda:x"])
def test_unknown_device_is_rejected(tmp_path, device):
    code, message, hint = refusal(write_column_network(tmp_path / "v8.onnx", metadata=NAMES), device=device)
    assert (code, f"'{device}'" in message, "cuda:0" in hint) == ("VISION109", True, True)


def test_excessive_sizes_are_rejected_or_ignored(tmp_path):
    path = write_column_network(
        tmp_path / "any.onnx", size=None, metadata={**NAMES, "imgsz": "[1000000, 1000000]", "stride": "1e9"}
    )
    assert open_detector(path).names == ("ball", "box", "cat"), "impossible metadata are ignored"
    assert refusal(path, size=(10**6, 64))[0] == "VISION109"


@pytest.mark.parametrize("number", [np.nan, np.inf])
def test_nonfinite_boxes_are_rejected(tmp_path, image, number):
    path = write_constant_network(tmp_path / "broken.onnx", np.full((1, 7, 252), number, np.float32), NAMES)
    with pytest.raises(LinkwrightError, match="not numbers") as raised:
        open_detector(path).detect(image, LIMITS)
    assert raised.value.diagnostics[0].code == "VISION106"


def test_malformed_metadata_names_are_noted(tmp_path):
    detector = open_detector(write_column_network(tmp_path / "v8.onnx", metadata={"names": "{0: 'a', 2: 'b', 3: 'c'}"}))
    assert detector.names == ("0", "1", "2")
    assert "cannot be read" in str(detector.notes[0])


def test_labels_yaml_error_has_line_and_column(tmp_path):
    labels = tmp_path / "labels.yaml"
    labels.write_text("names:\n  0: ball\n  1: [box\n")
    _, message, hint = refusal(write_column_network(tmp_path / "v8.onnx"), labels=labels)
    assert "line 4, column 1" in message
    assert "one name per line" in hint


def test_missing_file_and_unknown_detector_name_are_rejected(tmp_path):
    code, _, hint = refusal(tmp_path / "no.onnx")
    assert (code, "colors" in hint) == ("VISION102", True)
    assert refusal("color")[2] == "did you mean 'colors'?"
    assert set(detector_names()) >= {"apriltag", "aruco", "colors", "line", "qr"}


@pytest.mark.parametrize("ending", ["pt", "engine", "torchscript"])
def test_unsupported_network_formats_are_rejected(tmp_path, ending):
    path = tmp_path / f"yolov8n.{ending}"
    path.write_bytes(b"x")
    code, _, hint = refusal(path)
    assert code == "VISION104"
    assert ("yolo export model=yolov8n.pt format=onnx" in hint) == (ending == "pt")


@pytest.mark.parametrize(
    ("shape", "names", "words"),
    [
        ((4, 3, 96, 128), ("images",), "is a batch of 4 images, not 1"),
        ((1, 96, 128, 3), ("images",), "does not accept an image"),
        ((1, 1, 96, 128), ("images",), "does not accept an image"),
        ((1, 10), ("images",), "does not accept an image"),
        ((1, 3, 96, 128), ("images", "sizes"), "does not accept an image"),
    ],
)
def test_inputs_that_are_not_images_are_rejected(tmp_path, shape, names, words):
    path = write_constant_network(tmp_path / "other.onnx", np.zeros((1, 7, 252), np.float32), NAMES, shape, names)
    code, message, _ = refusal(path)
    assert (code, words in message) == ("VISION105", True)


@pytest.mark.parametrize(("task", "shape"), [("classify", (1, 1000)), ("obb", (1, 8, 252))])
def test_tasks_without_upright_boxes_are_rejected(tmp_path, task, shape):
    path = write_constant_network(tmp_path / "other.onnx", np.zeros(shape, np.float32), {**NAMES, "task": task})
    code, message, _ = refusal(path)
    assert (code, f"'{task}'" in message) == ("VISION106", True)


@pytest.mark.parametrize("shape", [(1, 1000), (1, 3, 252), (1, 3, 96, 128), (2, 7, 252)])
def test_outputs_that_are_not_boxes_are_rejected(tmp_path, shape):
    path = write_constant_network(tmp_path / "other.onnx", np.zeros(shape, np.float32))
    code, message, _ = refusal(path)
    assert (code, str(list(shape)) in message) == ("VISION106", True)


@pytest.mark.parametrize("metadata", [None, NAMES])
@pytest.mark.parametrize("rows", [252, 300, 3000], ids=["YOLOX", "RT-DETR", "another"])
def test_yolox_rows_are_not_mistaken_for_yolov5(tmp_path, rows, metadata):
    path = write_constant_network(tmp_path / "other.onnx", np.full((1, rows, 8), 0.9, np.float32), metadata)
    code, message, hint = refusal(path)
    assert (code, f"[1, {rows}, 8]" in message) == ("VISION106", True)
    assert "YOLOX" in hint


def test_wrong_number_of_names_is_rejected(tmp_path):
    path = write_column_network(tmp_path / "v8.onnx", 5, metadata=NAMES)
    code, message, _ = refusal(path)
    assert (code, message) == ("VISION107", "the network in 'v8.onnx' has 5 classes, but its metadata has 3 names")
    labels = tmp_path / "labels.txt"
    labels.write_text("one\ntwo\n")
    code, message, _ = refusal(write_column_network(tmp_path / "v8.onnx", metadata=NAMES), labels=labels)
    assert (code, message) == ("VISION107", f"the network in 'v8.onnx' has 3 classes, but '{labels}' has 2 names")
    assert refusal(write_column_network(tmp_path / "v8.onnx"), labels=labels)[0] == "VISION107"


def test_labels_file_replaces_wrong_metadata_names(tmp_path):
    path = write_column_network(tmp_path / "v8.onnx", 5, metadata=NAMES)
    labels = tmp_path / "labels.txt"
    labels.write_text("one\ntwo\nthree\nfour\nfive\n")
    assert len(open_detector(path, labels=labels).names) == 5


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("labels.yaml", "names: [one"),
        ("labels.json", "{}"),
        ("labels.yaml", "{0: a, 2: b}"),
        ("labels.txt", b"\xff\xfe\xff"),
        ("gone.txt", None),
    ],
)
def test_unreadable_labels_are_rejected(tmp_path, name, content):
    labels = tmp_path / name
    if content is not None:
        labels.write_bytes(content if isinstance(content, bytes) else content.encode())
    code, message, _ = refusal(write_column_network(tmp_path / "v8.onnx"), labels=labels)
    assert (code, name in message) == ("VISION108", True)


def test_metadata_names_are_not_executed(tmp_path, capsys):
    detector = open_detector(write_column_network(tmp_path / "v8.onnx", metadata={"names": "{0: print('run')}"}))
    assert detector.names == ("0", "1", "2")
    assert capsys.readouterr().out == ""
