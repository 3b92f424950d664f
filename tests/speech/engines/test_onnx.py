"""The engine onnx with small networks that distinguish loud and quiet sound."""

from __future__ import annotations

import json
import sys

import numpy as np
import onnx
import pytest
from onnx import TensorProto, helper

from linkwright.diagnostics import LinkwrightError, install_hint
from linkwright.speech.engine import EngineOptions
from linkwright.speech.engines.onnx_engine import OnnxEngine
from linkwright.speech.sound.samples import RATE

NAMES = ["background", "go_forward", "stop"]


def write_network(path, names=NAMES, shape=(1, RATE), kind=TensorProto.FLOAT, classes=3):
    """Write a network with two scores: 0, and the mean square of the sound times 1000, less 20."""
    weights = helper.make_tensor("weights", TensorProto.FLOAT, [1, 3], [0.0, 1.0, 2.0])
    offsets = helper.make_tensor("offsets", TensorProto.FLOAT, [3], [0.0, 0.0, -20.0])
    factor = helper.make_tensor("factor", TensorProto.FLOAT, [1], [500.0])
    axes = helper.make_tensor("axes", TensorProto.INT64, [1], [1])
    nodes = [
        helper.make_node("Mul", ["sound", "sound"], ["squares"]),
        helper.make_node("ReduceMean", ["squares", "axes"], ["mean"], keepdims=1),
        helper.make_node("Mul", ["mean", "factor"], ["power"]),
        helper.make_node("MatMul", ["power", "weights"], ["scaled"]),
        helper.make_node("Add", ["scaled", "offsets"], ["scores"]),
    ]
    graph = helper.make_graph(
        nodes,
        "spotter",
        [helper.make_tensor_value_info("sound", kind, shape)],
        [helper.make_tensor_value_info("scores", TensorProto.FLOAT, [1, classes])],
        [weights, offsets, factor, axes],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 18)], ir_version=9)
    if names is not None:
        helper.set_model_props(model, {"names": names if isinstance(names, str) else json.dumps(names)})
    onnx.save(model, path)
    return path


def make_sound(level, seconds=0.5):
    """Return a sound like a word between silences, with a little noise."""
    count = round(seconds * RATE)
    times = np.arange(count) / RATE
    tones = sum(np.sin(2 * np.pi * (pitch + 300 * times) * times) for pitch in (300, 900, 2_100))
    signal = np.concatenate((np.zeros(RATE), level * tones / 3, np.zeros(RATE)))
    return (signal + np.random.default_rng(5).normal(0, 5, len(signal))).astype(np.int16)


def recognize(engine, samples):
    return [result for start in range(0, len(samples), 1_600) for result in engine.hear(samples[start : start + 1_600])]


def engine_rejection(path):
    with pytest.raises(LinkwrightError) as error:
        OnnxEngine(EngineOptions(("stop",), "en", path))
    (diagnostic,) = error.value.diagnostics
    return diagnostic


@pytest.mark.parametrize("names", [NAMES, {"0": "background", "2": "stop", "1": "go forward"}, ", ".join(NAMES)])
def test_utterance_class_is_returned_as_phrase(names, tmp_path):
    engine = OnnxEngine(EngineOptions(("Go forward", "stop"), "en", write_network(tmp_path / "net.onnx", names)))
    (first,) = recognize(engine, make_sound(12_000))
    assert (first.text, first.final) == ("Go forward", True)
    assert first.confidence > 0.9
    assert 0.7 < first.start < 1.1
    assert 1.3 < first.end < 1.8
    (second,) = recognize(engine, make_sound(30_000, 0.8))
    assert second.text == "stop"
    assert second.start > 3.0


def test_uncertain_or_unlisted_class_gives_empty_text(tmp_path):
    engine = OnnxEngine(EngineOptions(("stop",), "en", write_network(tmp_path / "net.onnx")))
    assert [result.text for result in recognize(engine, make_sound(12_000))] == [""]  # the class is not a phrase
    assert [result.text for result in recognize(engine, make_sound(1_500))] == [""]  # no class has enough confidence
    assert recognize(engine, np.zeros(3 * RATE, np.int16)) == []


def test_finish_ends_utterance(tmp_path):
    engine = OnnxEngine(EngineOptions(("stop",), "en", write_network(tmp_path / "net.onnx")))
    assert recognize(engine, make_sound(30_000, 0.8)[: round(1.8 * RATE)]) == []
    assert [result.text for result in engine.finish()] == ["stop"]
    assert list(engine.finish()) == []


@pytest.mark.parametrize(
    "changes",
    [
        {"names": None},
        {"names": ["one"]},
        {"names": {"first": "a"}},
        {"shape": (1, 1, RATE)},
        {"shape": (1, "n")},
        {"kind": TensorProto.DOUBLE},
    ],
)
def test_unsuitable_network_is_rejected(changes, tmp_path):
    assert engine_rejection(write_network(tmp_path / "net.onnx", **changes)).code == "VOICE104"


def test_malformed_or_missing_network_is_rejected(tmp_path):
    (tmp_path / "net.onnx").write_bytes(b"nothing")
    assert engine_rejection(tmp_path / "net.onnx").code == "VOICE104"
    assert engine_rejection(tmp_path / "nowhere.onnx").code == "VOICE104"
    assert "model" in str(engine_rejection(None).hint)


def test_missing_onnxruntime_is_reported(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "onnxruntime", None)
    diagnostic = engine_rejection(write_network(tmp_path / "net.onnx"))
    assert diagnostic.code == "VOICE102"
    assert diagnostic.hint == install_hint("vision")
