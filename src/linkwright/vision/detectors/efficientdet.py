"""EfficientDet-Lite networks in TFLite files, whose outputs are final boxes."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any
from zipfile import BadZipFile, ZipFile

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.vision.detections import Detections
from linkwright.vision.detector import Detector, Limits
from linkwright.vision.detectors.class_names import read_labels
from linkwright.vision.detectors.library import load_litert, load_opencv
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.selection import select_detections

_FINAL_OPERATION = "TFLite_Detection_PostProcess"
"""The operation that outputs final boxes. Its four outputs are boxes, classes, scores and the number of boxes."""
_MAX_LABELS_BYTES = 1_000_000
_MAX_THREADS = 4


class EfficientDetDetector(Detector):
    """A detector that runs a network with LiteRT.

    The class names are read from a zip archive at the end of the file.

    Args:
        file: the TFLite file.
        options: the options; only the label file is used.

    Raises:
        LinkwrightError: VISION101 LiteRT or OpenCV is missing, VISION103 the file cannot be loaded, VISION105 its input
                is not an 8-bit image, VISION106 it has no final boxes, VISION108 there are no class names.
    """

    def __init__(self, file: Path, options: DetectorOptions) -> None:
        litert = load_litert()
        load_opencv()
        threads = min(_MAX_THREADS, os.cpu_count() or 1)
        try:
            self._interpreter = litert.Interpreter(model_path=str(file), num_threads=threads)
            self._interpreter.allocate_tensors()
        except (ValueError, RuntimeError) as error:
            message = phrase("cannot load the network in '{file}': {reason}", file=file, reason=foreign(error))
            raise LinkwrightError(Diagnostic("VISION103", message)) from None
        inputs = self._interpreter.get_input_details()
        shape = [int(length) for length in inputs[0]["shape"]] if len(inputs) == 1 else []
        if len(shape) != 4 or shape[0] != 1 or shape[3] != 3 or inputs[0]["dtype"] is not np.uint8:
            input_shapes = ", ".join(f"{np.dtype(entry['dtype'])} {list(map(int, entry['shape']))}" for entry in inputs)
            message = phrase(
                "the network in '{file}' does not accept an image: its inputs are {inputs}",
                file=file.name,
                inputs=input_shapes,
            )
            raise LinkwrightError(Diagnostic("VISION105", message))
        self._input, self._size = inputs[0]["index"], (shape[2], shape[1])
        self._outputs = _find_outputs(file, self._interpreter)
        self._names = _read_embedded_names(file) if options.labels is None else read_labels(options.labels)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the network's classes."""
        return self._names

    def detect(self, image: NDArray[np.uint8], limits: Limits) -> Detections:
        """Detect objects in an image, stretched to the input size as in TFLite's own library."""
        if not image.size:
            return Detections.empty(self._names)
        cv2 = load_opencv()
        self._interpreter.set_tensor(self._input, cv2.resize(image, self._size)[np.newaxis])
        self._interpreter.invoke()
        boxes, classes, scores, count = (self._interpreter.get_tensor(index) for index in self._outputs)
        detected = int(np.ravel(count)[0])
        height, width = image.shape[:2]
        boxes_in_pixels = np.clip(boxes[0, :detected][:, [1, 0, 3, 2]], 0.0, 1.0) * [width, height, width, height]
        class_numbers = classes[0, :detected].astype(int)
        valid = [index for index in range(detected) if 0 <= class_numbers[index] < len(self._names)]
        return select_detections(
            [boxes_in_pixels[index].tolist() for index in valid],
            [float(scores[0, index]) for index in valid],
            [int(class_numbers[index]) for index in valid],
            self._names,
            limits,
        )


def _find_outputs(file: Path, interpreter: Any) -> list[int]:
    """Return the tensor indices of the outputs: boxes, classes, scores and count.

    The indices come from the final operation, because the order and the names of outputs differ between files.
    """
    final_operations = [
        operation for operation in interpreter._get_ops_details() if operation["op_name"] == _FINAL_OPERATION
    ]
    if len(final_operations) != 1:
        message = phrase(
            "the network in '{file}' does not output final boxes as EfficientDet-Lite does", file=file.name
        )
        raise LinkwrightError(Diagnostic("VISION106", message, hint=phrase("export it as ONNX")))
    return [int(output) for output in final_operations[0]["outputs"]]


def _read_embedded_names(file: Path) -> tuple[str, ...]:
    try:
        with ZipFile(file) as archive:
            label_file = next(member for member in archive.infolist() if member.filename.endswith(".txt"))
            with archive.open(label_file) as stream:
                lines = stream.read(_MAX_LABELS_BYTES).decode().splitlines()
        return tuple(line.strip() for line in lines)
    except (BadZipFile, StopIteration, UnicodeDecodeError, OSError):
        message = phrase("there are no labels in '{path}'", path=file)
        raise LinkwrightError(Diagnostic("VISION108", message, hint=phrase("pass a labels file"))) from None
