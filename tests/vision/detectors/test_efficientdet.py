"""EfficientDet-Lite in TFLite files, with a fake of LiteRT's interpreter."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType
from typing import ClassVar
from zipfile import ZipFile

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.vision.detector import Limits
from linkwright.vision.detectors.library import load_litert
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.registry import make_detector

BOXES = [[0.25, 0.5, 0.75, 1.5], [0, 0, 0.5, 0.25], [0, 0, 1, 1], [9, 9, 9, 9]]
OPERATIONS = [
    {"op_name": "CONV_2D", "outputs": [3]},
    {"op_name": "TFLite_Detection_PostProcess", "outputs": [9, 7, 8, 6]},
]


class Interpreter:
    """A fake of LiteRT's interpreter with three boxes, and space for a fourth."""

    shape = (1, 320, 320, 3)
    kind = np.uint8
    operations = OPERATIONS
    seen: ClassVar[list[tuple[int, ...]]] = []

    def __init__(self, model_path: str, num_threads: int) -> None:
        if not Path(model_path).read_bytes().startswith(b"TFL3"):
            raise ValueError("Model provided has model identifier 'x'")

    def allocate_tensors(self):
        pass

    def get_input_details(self):
        return [{"index": 5, "shape": np.array(self.shape), "dtype": self.kind}]

    def _get_ops_details(self):
        return self.operations

    def set_tensor(self, index, value):
        assert (index, value.dtype) == (5, np.uint8)
        self.seen.append(value.shape)

    def invoke(self):
        pass

    def get_tensor(self, index):
        values = {9: [BOXES], 7: [[2, 0, 77, 0]], 8: [[0.9, 0.6, 0.8, 0.0]], 6: [3]}
        return np.array(values[index], np.float32)


@pytest.fixture
def litert(monkeypatch):
    """Return the fake's module, whose class a test may change."""
    kind = type("Changed", (Interpreter,), {"seen": []})
    package, module = ModuleType("ai_edge_litert"), ModuleType("ai_edge_litert.interpreter")
    package.interpreter, module.Interpreter = module, kind
    monkeypatch.setitem(sys.modules, "ai_edge_litert", package)
    monkeypatch.setitem(sys.modules, "ai_edge_litert.interpreter", module)
    load_litert.cache_clear()
    yield kind
    load_litert.cache_clear()


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "efficientdet.tflite"
    path.write_bytes(b"TFL3")
    with ZipFile(path, "a") as archive:
        archive.writestr("labelmap.txt", "person\nbicycle\ncar\n")
    return path


def refusal(path, **options):
    with pytest.raises(LinkwrightError) as raised:
        make_detector(str(path), DetectorOptions(**options))
    return raised.value.diagnostics[0].code


def test_boxes_and_names_are_read_from_model(litert, file):
    detector = make_detector(str(file), DetectorOptions())
    assert detector.names == ("person", "bicycle", "car")
    detections = detector.detect(np.zeros((100, 200, 3), np.uint8), Limits())
    assert litert.seen == [(1, 320, 320, 3)]
    assert [detections.name(index) for index in range(len(detections))] == ["car", "person"]
    assert detections.boxes.tolist() == [[100, 25, 200, 75], [0, 0, 50, 50]]
    assert detections.scores == pytest.approx([0.9, 0.6])
    assert len(detector.detect(np.zeros((0, 0, 3), np.uint8), Limits())) == 0


def test_labels_file_overrides_names_of_model(litert, file, tmp_path):
    (tmp_path / "labels.txt").write_text("a\nb\nc\n")
    assert make_detector(str(file), DetectorOptions(labels=tmp_path / "labels.txt")).names == ("a", "b", "c")


def test_malformed_model_files_are_rejected(litert, file):
    file.write_bytes(b"TFL3 without names")
    assert refusal(file) == "VISION108"
    file.write_bytes(b"no network")
    assert refusal(file) == "VISION103"


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"shape": (1, 3, 320, 320)}, "VISION105"),
        ({"kind": np.float32}, "VISION105"),
        ({"operations": OPERATIONS[:1]}, "VISION106"),
    ],
)
def test_unsupported_networks_are_rejected(litert, file, changes, code):
    for name, value in changes.items():
        setattr(litert, name, value)
    assert refusal(file) == code


def test_missing_litert_is_an_error(monkeypatch, file):
    monkeypatch.setitem(sys.modules, "ai_edge_litert", None)
    load_litert.cache_clear()
    assert refusal(file) == "VISION101"


def test_model_not_downloaded_is_an_error(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    assert refusal("efficientdet-lite0") == "MODEL102"
