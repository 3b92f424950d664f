"""Read the metadata of ONNX files, as Ultralytics' exporters write it."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass
from math import prod
from typing import Any

from linkwright.vision.detectors.class_names import names_in_metadata
from linkwright.vision.detectors.options import LARGEST_SIZE

_USUAL_STRIDE = 32
_LARGEST_STRIDE = 256
"""The greatest stride in pixels; greater ones are ignored."""


@dataclass(frozen=True, slots=True)
class Metadata:
    """The metadata of a network, with defaults for missing entries.

    Attributes:
        names: the names of its classes; None if the file has none.
        task: ``detect``, ``segment``, ``pose``, ``obb``, ``classify``; empty if the file has none.
        stride: the sides of the input are multiples of this.
        size: height and width of its input in training.
        suppressed: whether its boxes are final: no two of them are of the same object.
        key_numbers: the number of keypoint values for each box.
    """

    names: tuple[str, ...] | None = None
    task: str = ""
    stride: int = _USUAL_STRIDE
    size: tuple[int, int] | None = None
    suppressed: bool = False
    key_numbers: int = 0

    @classmethod
    def of(cls, entries: Mapping[str, str]) -> Metadata:
        """Read the ``metadata_props`` of a file; malformed ones are ignored."""
        stride = _literal(entries.get("stride", ""))
        size = _literal(entries.get("imgsz", ""))
        points = _literal(entries.get("kpt_shape", ""))
        arguments = _literal(entries.get("args", ""))
        return cls(
            names_in_metadata(entries.get("names", "")),
            entries.get("task", ""),
            stride if isinstance(stride, int) and 0 < stride <= _LARGEST_STRIDE else _USUAL_STRIDE,
            (size[0], size[1]) if _are_numbers(size) and len(size) == 2 and max(size) <= LARGEST_SIZE else None,
            _literal(entries.get("end2end", "")) is True
            or (isinstance(arguments, Mapping) and arguments.get("nms") is True),
            prod(points) if _are_numbers(points) else 0,
        )


def _literal(text: str) -> Any:
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return None


def _are_numbers(found: Any) -> bool:
    return (
        isinstance(found, list | tuple)
        and bool(found)
        and all(isinstance(number, int) and number > 0 for number in found)
    )
