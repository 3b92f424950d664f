"""Small networks with random weights in ONNX files, whose outputs have YOLO's layout."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

STRIDES = (8, 16, 32)


def write_column_network(
    path: Path,
    classes: int = 3,
    *,
    size=(96, 128),
    metadata=None,
    is_half_precision=False,
    masks=0,
    extra_columns=0,
    batch=1,
    transposed=False,
    objectness=False,
) -> Path:
    """Center, size and scores of each place.

    In rows with `transposed`, with `objectness` as of classic YOLOv5.
    """
    numbers = 4 + objectness + classes + masks + extra_columns
    random = np.random.default_rng(classes)
    anchors = 3 if objectness else 1
    kind = np.float16 if is_half_precision else np.float32
    nodes, weights, parts = [], [], []
    for index, stride in enumerate(STRIDES * anchors):
        kernel = random.normal(0, 2.5 / stride, (numbers, 3, stride, stride)).astype(kind)
        weights.append(numpy_helper.from_array(kernel, f"w{index}"))
        shape = [stride, stride]
        nodes.append(
            helper.make_node("Conv", ["images", f"w{index}"], [f"c{index}"], strides=shape, kernel_shape=shape)
        )
        nodes.append(helper.make_node("Reshape", [f"c{index}", "flat"], [f"f{index}"]))
        parts.append(f"f{index}")
    weights.append(numpy_helper.from_array(np.array([batch, numbers, -1], np.int64), "flat"))
    scale = np.ones((1, numbers, 1), kind)
    scale[:, :4, 0] = [128, 96, 60, 60]
    weights.append(numpy_helper.from_array(scale, "scale"))
    nodes.append(helper.make_node("Concat", parts, ["all"], axis=2))
    nodes.append(helper.make_node("Sigmoid", ["all"], ["likely"]))
    last = "turned" if transposed else "output0"
    nodes.append(helper.make_node("Mul", ["likely", "scale"], [last if not transposed else "turned"]))
    if transposed:
        nodes.append(helper.make_node("Transpose", ["turned"], ["output0"], perm=[0, 2, 1]))
    outputs = [_value("output0", None, is_half_precision)]
    if masks:
        weights.append(numpy_helper.from_array(np.ones((masks, 3, 4, 4), kind), "wm"))
        nodes.append(helper.make_node("Conv", ["images", "wm"], ["output1"], strides=[4, 4], kernel_shape=[4, 4]))
        outputs.append(_value("output1", None, is_half_precision))
    shape = [batch, 3, *(size or ("height", "width"))]
    return save_network(path, nodes, [_value("images", shape, is_half_precision)], outputs, weights, metadata)


def write_constant_network(path: Path, array, metadata=None, shape=(1, 3, 96, 128), names=("images",)) -> Path:
    """Write a network with a constant output."""
    weights = [numpy_helper.from_array(np.asarray(array), "numbers"), numpy_helper.from_array(np.float32(0), "zero")]
    nodes = [
        helper.make_node("ReduceMean", [names[0]], ["mean"], keepdims=0),
        helper.make_node("Mul", ["mean", "zero"], ["nothing"]),
        helper.make_node("Add", ["numbers", "nothing"], ["output0"]),
    ]
    inputs = [_value(name, list(shape), False) for name in names]
    return save_network(path, nodes, inputs, [_value("output0", None, False)], weights, metadata)


def save_network(path, nodes, inputs, outputs, weights, metadata) -> Path:
    graph = helper.make_graph(nodes, "small", inputs, outputs, weights)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    helper.set_model_props(model, metadata or {})
    onnx.save(model, path)
    return path


def _value(name, shape, is_half_precision):
    kind = TensorProto.FLOAT16 if is_half_precision else TensorProto.FLOAT
    return helper.make_tensor_value_info(name, kind, shape)
