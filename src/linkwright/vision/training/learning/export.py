"""The export of a network to an ONNX file in the layout of YOLOv8."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from io import BytesIO
from typing import Any

import numpy as np
import onnx
import torch
from onnx import TensorProto, helper, numpy_helper
from torch import Tensor, nn

from linkwright.vision.training.learning.network import STRIDES, Network

_OPSET = 17
_MIN_HALVED_WEIGHT_COUNT = 64  # weights with fewer numbers than this are not halved


class _YoloOutput(nn.Module):
    """A network whose output concatenates boxes and scores as YOLOv8 does."""

    def __init__(self, network: Network, threshold: float) -> None:
        super().__init__()
        self.network = network
        self.shift = math.log((1 - threshold) / threshold)

    def forward(self, images: Tensor) -> Tensor:
        """Return center, width and height in pixels, and the scores.

        The shape is (batch, 4 + classes, cells).
        """
        boxes, logits = self.network(images)
        top_left, bottom_right = boxes[..., :2], boxes[..., 2:]
        return torch.cat(
            ((top_left + bottom_right) / 2, bottom_right - top_left, (logits + self.shift).sigmoid()), 2
        ).transpose(1, 2)


def export_to_onnx(
    network: Network,
    names: tuple[str, ...],
    width: int,
    height: int,
    facts: Mapping[str, str],
    threshold: float = 0.5,
) -> bytes:
    """Export a network as the content of an ONNX file.

    The input is one image with the given width and height; the output has shape ``[1, 4 + classes, cells]``. Weights
    are stored in 16 bits and used in 32, which halves the file and changes scores by less than a thousandth.

    Args:
        network: the network to export.
        names: the names of the network's classes.
        width: the width of the input images in pixels, a multiple of 32.
        height: the height of the input images in pixels, a multiple of 32.
        facts: further metadata for the file.
        threshold: the score of the network that becomes 0.5 in the file; the order of the scores stays the same.
    """
    file = BytesIO()
    image = torch.zeros(1, 3, height, width)
    with warnings.catch_warnings():
        # The newer exporter, which the warning recommends, needs another library and produces the same graph.
        warnings.simplefilter("ignore")
        torch.onnx.export(
            _YoloOutput(network, threshold).eval(),
            (image,),
            file,
            dynamo=False,
            opset_version=_OPSET,
            input_names=["images"],
            output_names=["output0"],
        )
    model = onnx.load_from_string(file.getvalue())
    _halve_precision(model)
    entries = {
        "task": "detect",
        "stride": str(max(STRIDES)),
        "imgsz": str([height, width]),
        "batch": "1",
        "names": str(dict(enumerate(names))),
        **facts,
    }
    helper.set_model_props(model, entries)
    model.producer_name = "linkwright"
    model.producer_version = ""
    onnx.checker.check_model(model)
    data: bytes = model.SerializeToString()
    return data


def _halve_precision(model: Any) -> None:
    """Store weights as 16-bit floats that the graph casts back to 32 bits."""
    casts = []
    for weights in model.graph.initializer:
        array = numpy_helper.to_array(weights)
        if array.dtype != np.float32 or array.size < _MIN_HALVED_WEIGHT_COUNT:
            continue
        name = weights.name
        weights.CopyFrom(numpy_helper.from_array(array.astype(np.float16), f"{name}_16"))
        casts.append(helper.make_node("Cast", [f"{name}_16"], [name], to=TensorProto.FLOAT))
    for index, cast in enumerate(casts):
        model.graph.node.insert(index, cast)
