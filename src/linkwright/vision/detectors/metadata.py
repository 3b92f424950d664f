"""The metadata of ONNX files, as Ultralytics' exporters write it."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass
from math import prod
from typing import Any

from linkwright.vision.detectors.class_names import parse_metadata_names
from linkwright.vision.detectors.options import MAX_SIZE

_DEFAULT_STRIDE = 32
_MAX_STRIDE = 256
"""The maximum stride in pixels. A larger stride in a file is ignored."""


@dataclass(frozen=True, slots=True)
class Metadata:
    """The metadata of a network, with defaults for missing entries.

    Attributes:
        names: the names of its classes; None if the file has none.
        task: ``detect``, ``segment``, ``pose``, ``obb`` or ``classify``; empty if the file has none.
        stride: the number of pixels that must divide the height and width of the input.
        size: the height and width of its input in training, in pixels; None if the file has none.
        is_suppressed: whether its boxes are final, with one box for each object.
        keypoint_value_count: the number of keypoint values for each box.
    """

    names: tuple[str, ...] | None = None
    task: str = ""
    stride: int = _DEFAULT_STRIDE
    size: tuple[int, int] | None = None
    is_suppressed: bool = False
    keypoint_value_count: int = 0

    @classmethod
    def of(cls, entries: Mapping[str, str]) -> Metadata:
        """Read the ``metadata_props`` of a file.

        Malformed entries get their defaults.
        """
        stride = _parse_literal(entries.get("stride", ""))
        size = _parse_literal(entries.get("imgsz", ""))
        keypoint_shape = _parse_literal(entries.get("kpt_shape", ""))
        export_arguments = _parse_literal(entries.get("args", ""))
        return cls(
            parse_metadata_names(entries.get("names", "")),
            entries.get("task", ""),
            stride if isinstance(stride, int) and 0 < stride <= _MAX_STRIDE else _DEFAULT_STRIDE,
            (size[0], size[1]) if _are_positive_integers(size) and len(size) == 2 and max(size) <= MAX_SIZE else None,
            _parse_literal(entries.get("end2end", "")) is True
            or (isinstance(export_arguments, Mapping) and export_arguments.get("nms") is True),
            prod(keypoint_shape) if _are_positive_integers(keypoint_shape) else 0,
        )


def _parse_literal(text: str) -> Any:
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return None


def _are_positive_integers(value: Any) -> bool:
    return (
        isinstance(value, list | tuple)
        and bool(value)
        and all(isinstance(number, int) and number > 0 for number in value)
    )
