"""A detector that runs a network in an ONNX file: any YOLOv5, v8, v10, v11 or 26, or our own."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.model_files.onnx_sessions import reason_of
from linkwright.vision.detections import Detections
from linkwright.vision.detector import Detector, Limits
from linkwright.vision.detectors.class_names import read_labels
from linkwright.vision.detectors.layouts import Candidates, Form, find_layout, wrong_number
from linkwright.vision.detectors.letterbox import GREY, letterboxed, tensor_of
from linkwright.vision.detectors.metadata import Metadata
from linkwright.vision.detectors.options import LARGEST_SIZE, DetectorOptions
from linkwright.vision.detectors.sessions import session_on
from linkwright.vision.detectors.settings import bad_setting
from linkwright.vision.detectors.suppression import suppressed

_NUMBERS: dict[str, type[np.floating]] = {"tensor(float)": np.float32, "tensor(float16)": np.float16}
_USUAL_SIZE = (640, 640)


class NetworkDetector(Detector):
    """Runs a network with onnxruntime.

    Args:
        file: the ONNX file.
        options: the options; labels, device and input size are used.

    Raises:
        LinkwrightError: VISION101 onnxruntime or OpenCV is missing, VISION103 the file cannot be loaded, VISION105 its
            input is not an image, VISION106 and VISION107 see `find_layout`, VISION108 the labels cannot be read,
            VISION109 the device is unknown, or the network has no input of that size.
    """

    def __init__(self, file: Path, options: DetectorOptions) -> None:
        self._file, self._labels = file, options.labels
        labels = read_labels(options.labels) if options.labels is not None else None
        if options.size is not None and max(options.size) > LARGEST_SIZE:
            raise bad_setting("imgsz", max(options.size), phrase("give at most {largest} pixels", largest=LARGEST_SIZE))
        self._session, self._notes = session_on(file, options.device)
        metadata = Metadata.of(self._session.get_modelmeta().custom_metadata_map)
        self._input, self._kind, fixed = _image_input(file, self._session.get_inputs())
        self._stride = None if fixed else metadata.stride
        self._size = fixed or _multiple(options.size or metadata.size or _USUAL_SIZE, metadata.stride)
        if fixed and options.size not in (None, fixed):
            shown = phrase("{columns} x {rows}", columns=fixed[1], rows=fixed[0])
            self._notes.append(phrase("the input of '{file}' is always {size} pixels", file=file.name, size=shown))
        grey = np.full((*self._size, 3), GREY, np.uint8)
        shapes = [output.shape for output in self._run(tensor_of(grey, self._kind))]
        named = len(labels) if labels is not None else None
        self._layout = find_layout(shapes, self._size, metadata, file, named, options.labels)
        self._names = self._named(metadata.names, labels)
        if self._layout.left_out:
            left_out = phrase("masks") if self._layout.left_out == "masks" else phrase("keypoints")
            self._notes.append(
                phrase("only the boxes of '{file}' are used; {what} are left out", file=file.name, what=left_out)
            )

    @property
    def names(self) -> tuple[str, ...]:
        """The names of its classes."""
        return self._names

    @property
    def notes(self) -> tuple[Phrase, ...]:
        """Remarks on ignored outputs, and on the device if it is not the requested one."""
        return tuple(self._notes)

    def detect(self, image: NDArray[np.uint8], limits: Limits) -> Detections:
        """Detect objects in an image.

        Raises:
            LinkwrightError: VISION105 the network fails, VISION106 its outputs contain values that are not numbers.
        """
        if not image.size:
            return Detections.none(self._names)
        pixels, place = letterboxed(image, self._size, self._stride)
        found = self._candidates(np.asarray(self._run(tensor_of(pixels, self._kind))[0], np.float32), limits.threshold)
        boxes, scores, classes = found.boxes, found.scores, found.classes
        if limits.classes is not None:
            wanted = [index for index, name in enumerate(self._names) if name in limits.classes]
            chosen = np.isin(classes, wanted)
            boxes, scores, classes = boxes[chosen], scores[chosen], classes[chosen]
        if self._layout.form is Form.FINAL:
            known = (classes >= 0) & (classes < len(self._names))
            kept = np.flatnonzero(known)[np.argsort(-scores[known], kind="stable")][: limits.most]
        else:
            kept = suppressed(boxes, scores, classes, limits.iou, limits.most)
        return Detections(place.boxes_in_image(boxes[kept]), scores[kept], classes[kept], self._names)

    def _candidates(self, output: NDArray[np.float32], threshold: float) -> Candidates:
        with np.errstate(invalid="ignore"):
            found = self._layout.candidates(output, threshold)
        if np.isnan(output).any() or not (np.isfinite(found.boxes).all() and np.isfinite(found.scores).all()):
            message = phrase(
                "the network in '{file}' outputs boxes or scores that are not numbers", file=self._file.name
            )
            hint = phrase("the network is broken, or needs more than 16 bits: export it with 32 bits")
            raise LinkwrightError(Diagnostic("VISION106", message, hint=hint))
        return found

    def _run(self, tensor: NDArray[np.floating]) -> Sequence[NDArray[Any]]:
        try:
            outputs: Sequence[NDArray[Any]] = self._session.run(None, {self._input: tensor})
        except Exception as error:  # noqa: BLE001 - of many classes, which onnxruntime does not document
            shape = list(tensor.shape)
            reason = reason_of(error)
            message = phrase(
                "the network in '{file}' fails on an input of {shape}: {reason}",
                file=self._file.name,
                shape=shape,
                reason=reason,
            )
            raise LinkwrightError(Diagnostic("VISION105", message)) from None
        return outputs

    def _named(self, own: tuple[str, ...] | None, labels: tuple[str, ...] | None) -> tuple[str, ...]:
        classes = self._layout.classes or (len(own) if own is not None else 0)
        if labels is not None:
            if classes and len(labels) != classes:
                raise wrong_number(self._file, classes, len(labels), self._labels)
            return labels
        if own is not None:
            return own
        metadata = self._session.get_modelmeta().custom_metadata_map.get("names")
        if metadata:
            note = phrase(
                "the names of the classes in '{file}' cannot be read, so they are numbered; give a labels file",
                file=self._file.name,
            )
        else:
            note = phrase(
                "'{file}' does not name its classes, so they are numbered; give a labels file", file=self._file.name
            )
        self._notes.append(note)
        return tuple(map(str, range(classes or 1000)))


def _image_input(file: Path, inputs: Sequence[Any]) -> tuple[str, type[np.floating], tuple[int, int] | None]:
    """Return the name and element type of the input, and its height and width if they are fixed."""
    shape = list(inputs[0].shape) if len(inputs) == 1 else []
    kind = _NUMBERS.get(inputs[0].type) if len(inputs) == 1 else None
    if len(shape) == 4 and isinstance(shape[0], int) and shape[0] > 1:
        message = phrase("the network in '{file}' takes {count} images at once", file=file.name, count=shape[0])
        raise LinkwrightError(Diagnostic("VISION105", message, hint=phrase("export it with batch 1")))
    if kind is None or len(shape) != 4 or shape[1] != 3:
        shown = (
            ", ".join(f"{network_input.type[7:-1]} {list(network_input.shape)}" for network_input in inputs) or "none"
        )
        message = phrase(
            "the network in '{file}' does not take an image: its inputs are {inputs}", file=file.name, inputs=shown
        )
        hint = phrase("use a network whose input is float or float16 [1, 3, height, width]")
        raise LinkwrightError(Diagnostic("VISION105", message, hint=hint))
    rows, columns = shape[2:]
    size = (rows, columns) if isinstance(rows, int) and isinstance(columns, int) else None
    return inputs[0].name, kind, size


def _multiple(size: tuple[int, int], stride: int) -> tuple[int, int]:
    return -(-size[0] // stride) * stride, -(-size[1] // stride) * stride
