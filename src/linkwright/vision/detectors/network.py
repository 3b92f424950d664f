"""A detector that runs an ONNX network: YOLOv5, v8, v10, v11, 26, or one of Linkwright."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.model_files.onnx_sessions import describe_error
from linkwright.vision.detections import Detections
from linkwright.vision.detector import Detector, Limits
from linkwright.vision.detectors.class_names import read_labels
from linkwright.vision.detectors.layouts import BoxArrangement, Candidates, class_count_error, find_layout
from linkwright.vision.detectors.letterbox import GRAY, letterbox_image, to_tensor
from linkwright.vision.detectors.metadata import Metadata
from linkwright.vision.detectors.options import MAX_SIZE, DetectorOptions
from linkwright.vision.detectors.sessions import create_session
from linkwright.vision.detectors.settings import setting_error
from linkwright.vision.detectors.suppression import non_maximum_suppression

_ELEMENT_TYPES: dict[str, type[np.floating]] = {"tensor(float)": np.float32, "tensor(float16)": np.float16}
_DEFAULT_SIZE = (640, 640)


class NetworkDetector(Detector):
    """A detector that runs a network with onnxruntime.

    Args:
        file: the ONNX file.
        options: the options; the label file, the device and the input size are used.

    Raises:
        LinkwrightError: VISION101 onnxruntime or OpenCV is missing, VISION103 the file cannot be loaded, VISION105 its
            input is not an image, VISION106 and VISION107 see `find_layout`, VISION108 the labels cannot be read,
                VISION109 the device has a wrong form, or the input size is too large.
    """

    def __init__(self, file: Path, options: DetectorOptions) -> None:
        self._file, self._labels = file, options.labels
        labels = read_labels(options.labels) if options.labels is not None else None
        if options.size is not None and max(options.size) > MAX_SIZE:
            raise setting_error("imgsz", max(options.size), phrase("give at most {maximum} pixels", maximum=MAX_SIZE))
        self._session, self._notes = create_session(file, options.device)
        metadata = Metadata.of(self._session.get_modelmeta().custom_metadata_map)
        self._input, self._kind, fixed_size = _find_image_input(file, self._session.get_inputs())
        self._stride = None if fixed_size else metadata.stride
        self._size = fixed_size or _round_up(options.size or metadata.size or _DEFAULT_SIZE, metadata.stride)
        if fixed_size and options.size not in (None, fixed_size):
            size_text = phrase("{columns} x {rows}", columns=fixed_size[1], rows=fixed_size[0])
            self._notes.append(phrase("the input of '{file}' is always {size} pixels", file=file.name, size=size_text))
        gray = np.full((*self._size, 3), GRAY, np.uint8)
        shapes = [output.shape for output in self._run(to_tensor(gray, self._kind))]
        label_count = len(labels) if labels is not None else None
        self._layout = find_layout(shapes, self._size, metadata, file, label_count, options.labels)
        self._names = self._choose_names(metadata.names, labels)
        if self._layout.ignored_outputs:
            ignored = phrase("masks") if self._layout.ignored_outputs == "masks" else phrase("keypoints")
            self._notes.append(
                phrase(
                    "only the boxes of '{file}' are used; its {outputs} are ignored", file=file.name, outputs=ignored
                )
            )

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the network's classes."""
        return self._names

    @property
    def notes(self) -> tuple[Phrase, ...]:
        """Remarks on ignored outputs, missing class names, the input size, and the device."""
        return tuple(self._notes)

    def detect(self, image: NDArray[np.uint8], limits: Limits) -> Detections:
        """Detect objects in an image.

        Raises:
            LinkwrightError: VISION105 the network fails, VISION106 its outputs contain NaN or infinite values.
        """
        if not image.size:
            return Detections.empty(self._names)
        pixels, letterbox = letterbox_image(image, self._size, self._stride)
        candidates = self._find_candidates(
            np.asarray(self._run(to_tensor(pixels, self._kind))[0], np.float32), limits.threshold
        )
        boxes, scores, classes = candidates.boxes, candidates.scores, candidates.classes
        if limits.classes is not None:
            wanted_classes = [index for index, name in enumerate(self._names) if name in limits.classes]
            is_wanted = np.isin(classes, wanted_classes)
            boxes, scores, classes = boxes[is_wanted], scores[is_wanted], classes[is_wanted]
        if self._layout.arrangement is BoxArrangement.FINAL:
            has_name = (classes >= 0) & (classes < len(self._names))
            kept_indices = np.flatnonzero(has_name)[np.argsort(-scores[has_name], kind="stable")][
                : limits.max_detections
            ]
        else:
            kept_indices = non_maximum_suppression(boxes, scores, classes, limits.iou, limits.max_detections)
        return Detections(
            letterbox.to_image_boxes(boxes[kept_indices]), scores[kept_indices], classes[kept_indices], self._names
        )

    def _find_candidates(self, output: NDArray[np.float32], threshold: float) -> Candidates:
        with np.errstate(invalid="ignore"):
            candidates = self._layout.find_candidates(output, threshold)
        if np.isnan(output).any() or not (np.isfinite(candidates.boxes).all() and np.isfinite(candidates.scores).all()):
            message = phrase(
                "the network in '{file}' outputs boxes or scores that are not numbers", file=self._file.name
            )
            hint = phrase("the network is broken, or 16-bit floats are too imprecise for it: export it with 32 bits")
            raise LinkwrightError(Diagnostic("VISION106", message, hint=hint))
        return candidates

    def _run(self, tensor: NDArray[np.floating]) -> Sequence[NDArray[Any]]:
        try:
            outputs: Sequence[NDArray[Any]] = self._session.run(None, {self._input: tensor})
        except Exception as error:  # noqa: BLE001 - onnxruntime raises many undocumented classes
            shape = list(tensor.shape)
            reason = describe_error(error)
            message = phrase(
                "the network in '{file}' fails on an input of {shape}: {reason}",
                file=self._file.name,
                shape=shape,
                reason=reason,
            )
            raise LinkwrightError(Diagnostic("VISION105", message)) from None
        return outputs

    def _choose_names(self, metadata_names: tuple[str, ...] | None, labels: tuple[str, ...] | None) -> tuple[str, ...]:
        classes = self._layout.classes or (len(metadata_names) if metadata_names is not None else 0)
        if labels is not None:
            if classes and len(labels) != classes:
                raise class_count_error(self._file, classes, len(labels), self._labels)
            return labels
        if metadata_names is not None:
            return metadata_names
        raw_names = self._session.get_modelmeta().custom_metadata_map.get("names")
        if raw_names:
            note = phrase(
                "the names of the classes in '{file}' cannot be read, so they are numbered; pass a labels file",
                file=self._file.name,
            )
        else:
            note = phrase(
                "'{file}' does not name its classes, so they are numbered; pass a labels file", file=self._file.name
            )
        self._notes.append(note)
        return tuple(map(str, range(classes or 1000)))


def _find_image_input(file: Path, inputs: Sequence[Any]) -> tuple[str, type[np.floating], tuple[int, int] | None]:
    """Return the name, element type and size of the input.

    The size is height and width, or None if it is not fixed.
    """
    shape = list(inputs[0].shape) if len(inputs) == 1 else []
    element_type = _ELEMENT_TYPES.get(inputs[0].type) if len(inputs) == 1 else None
    if len(shape) == 4 and isinstance(shape[0], int) and shape[0] > 1:
        message = phrase(
            "the input of the network in '{file}' is a batch of {count} images, not 1", file=file.name, count=shape[0]
        )
        raise LinkwrightError(Diagnostic("VISION105", message, hint=phrase("export it with a batch size of 1")))
    if element_type is None or len(shape) != 4 or shape[1] != 3:
        input_types = (
            ", ".join(f"{network_input.type[7:-1]} {list(network_input.shape)}" for network_input in inputs) or "none"
        )
        message = phrase(
            "the network in '{file}' does not accept an image: its inputs are {inputs}",
            file=file.name,
            inputs=input_types,
        )
        hint = phrase("use a network whose input is float or float16 [1, 3, height, width]")
        raise LinkwrightError(Diagnostic("VISION105", message, hint=hint))
    rows, columns = shape[2:]
    size = (rows, columns) if isinstance(rows, int) and isinstance(columns, int) else None
    return inputs[0].name, element_type, size


def _round_up(size: tuple[int, int], stride: int) -> tuple[int, int]:
    return -(-size[0] // stride) * stride, -(-size[1] // stride) * stride
