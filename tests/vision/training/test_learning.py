"""Networks that learn, where PyTorch is installed.

`make test-train` runs these tests (see CONTRIBUTING.md).
"""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from linkwright.cli import main
from linkwright.diagnostics import LinkwrightError
from linkwright.vision.training.images import read_labeled_images
from linkwright.vision.training.options import Options
from linkwright.vision.training.training_run import train_network
from linkwright.vision.training.yolo_dataset import open_dataset
from tests.vision.training.images_of_shapes import NAMES, write_shapes

# `make test-train` sets the variable, so that a missing PyTorch is an error there, instead of a skip.
IS_TRAINING_TESTED = find_spec("torch") is not None or "LINKWRIGHT_TESTS_TRAINING" in os.environ
pytestmark = pytest.mark.skipif(
    not IS_TRAINING_TESTED, reason="PyTorch is not installed; `make test-train` installs it"
)

if IS_TRAINING_TESTED:
    import onnxruntime
    import torch

    from linkwright.vision.training.learning.export import export_to_onnx
    from linkwright.vision.training.learning.initial_weights import load_weights
    from linkwright.vision.training.learning.losses import assign_cells, compute_loss, pairwise_iou
    from linkwright.vision.training.learning.network import Network, Shape, make_cells
    from linkwright.vision.training.learning.optimizer import orthogonalize
    from linkwright.vision.training.learning.training_loop import TrainingLoop


@pytest.fixture(scope="module")
def shapes(tmp_path_factory):
    return write_shapes(tmp_path_factory.mktemp("data") / "shapes", 8)


def training_options(shapes: Path, output: Path, **changed) -> Options:
    usual = Options(shapes, output, epochs=4, batch=8, width=96, height=96, channels=4, threads=1)
    return replace(usual, **changed)


def train_course(settings: Options) -> TrainingLoop:
    settings.output.mkdir(exist_ok=True)
    dataset = open_dataset(settings.dataset)
    labeled_images = read_labeled_images(dataset.read("train"), settings.width, settings.height)
    return TrainingLoop(dataset.names, settings, labeled_images, labeled_images)


def network_weights(training_loop: TrainingLoop) -> np.ndarray:
    return np.concatenate([parameter.detach().numpy().ravel() for parameter in training_loop.network.parameters()])


def test_network_overfits_eight_images(shapes, tmp_path):
    training_loop = train_course(training_options(shapes, tmp_path, epochs=300, whole_epochs=300, rate=1.5e-3))
    epochs = []
    training_loop.run(epochs.append)
    first, last = (
        np.mean([epoch.losses for epoch in epochs[:5]], 0),
        np.mean([epoch.losses for epoch in epochs[-5:]], 0),
    )
    assert (last < first / 2).all()
    assert training_loop.best_map > 0.5
    assert training_loop.evaluate_averaged().map50 >= 0.9


def test_same_seed_gives_same_weights(shapes, tmp_path):
    courses = [train_course(training_options(shapes, tmp_path, seed=seed)) for seed in (3, 3, 4)]
    for training_loop in courses:
        training_loop.run(lambda _: None)
    assert (network_weights(courses[0]) == network_weights(courses[1])).all()
    assert (network_weights(courses[0]) != network_weights(courses[2])).any()


def test_bfloat16_training_matches_float32_within_rounding(shapes, tmp_path):
    losses = []
    for precision in ("float32", "bfloat16"):
        training_loop, received = (
            train_course(training_options(shapes, tmp_path, epochs=12, whole_epochs=0, precision=precision)),
            [],
        )
        training_loop.run(received.append)
        assert all(parameter.dtype == torch.float32 for parameter in training_loop.network.parameters())
        losses.append([report.losses for report in received])
    exact, rounded = np.array(losses)
    assert (exact != rounded).any()
    assert rounded == pytest.approx(exact, rel=0.2)


def test_resumed_training_matches_uninterrupted_training(shapes, tmp_path):
    uninterrupted = train_course(training_options(shapes, tmp_path / "whole"))
    uninterrupted.run(lambda _: None)
    interrupted = train_course(training_options(shapes, tmp_path / "begun"))

    def stop_after_two(epoch):
        if epoch.number == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted.run(stop_after_two)
    resumed = train_course(training_options(shapes, tmp_path / "begun"))
    resumed.load(tmp_path / "begun" / "last.pt")
    assert resumed.epoch == 2
    resumed.run(lambda _: None)
    assert (network_weights(resumed) == network_weights(uninterrupted)).all()


@pytest.mark.parametrize("content", [b"", b"none", None])
def test_malformed_checkpoint_is_reported(shapes, tmp_path, content):
    if content is not None:
        (tmp_path / "last.pt").write_bytes(content)
    with pytest.raises(LinkwrightError) as caught:
        train_course(training_options(shapes, tmp_path)).load(tmp_path / "last.pt")
    assert caught.value.diagnostics[0].code == "VISION306"


def test_checkpoint_of_another_network_is_rejected(shapes, tmp_path):
    train_course(training_options(shapes, tmp_path)).save(tmp_path / "last.pt")
    with pytest.raises(LinkwrightError) as caught:
        train_course(training_options(shapes, tmp_path, channels=8)).load(tmp_path / "last.pt")
    assert "other classes or sizes" in str(caught.value.diagnostics[0].message)


def test_exported_network_matches_trained_network():
    torch.manual_seed(2)
    network = Network(Shape(3, 4)).eval()
    with torch.no_grad():  # round the weights to 16 bits, as in the file
        for parameter in network.parameters():
            parameter.copy_(parameter.half().float())
    image = torch.rand(1, 3, 96, 64)
    with torch.no_grad():
        boxes, logits = network(image)
    content = export_to_onnx(network, ("a", "b", "c"), 64, 96, {"seed": "2"}, 0.2)
    session = onnxruntime.InferenceSession(content, providers=["CPUExecutionProvider"])
    output = session.run(None, {"images": image.numpy()})[0][0].T
    left, right = output[:, :2] - output[:, 2:4] / 2, output[:, :2] + output[:, 2:4] / 2
    assert np.abs(np.concatenate((left, right), 1) - boxes[0].numpy()).max() < 0.05  # in pixels
    assert np.abs(output[:, 4:] - (logits[0] + np.log(4)).sigmoid().numpy()).max() < 1e-4
    metadata = session.get_modelmeta().custom_metadata_map
    assert metadata["names"] == "{0: 'a', 1: 'b', 2: 'c'}"
    assert (metadata["imgsz"], metadata["stride"], metadata["task"]) == ("[96, 64]", "32", "detect")


@pytest.fixture
def exported_network(tmp_path):
    """Export a network of three classes, and return it with its file.

    Its normalizations are changed.
    """
    torch.manual_seed(3)
    network = Network(Shape(3, 4))
    with torch.no_grad():
        network(torch.rand(8, 3, 64, 64))
        for parameter in network.parameters():
            parameter.add_(0.1 * torch.randn_like(parameter)).copy_(parameter.half().float())
    file = tmp_path / "shapes.onnx"
    file.write_bytes(export_to_onnx(network.eval(), ("disc", "square", "bar"), 64, 64, {}))
    return network, file


def run_network(network, image):
    with torch.no_grad():
        boxes, logits = network.eval()(image)
    return boxes[0], logits[0]


def test_loaded_weights_match_exported_network(exported_network):
    other, file = exported_network
    network, image = Network(Shape(3, 4)), torch.rand(1, 3, 64, 64)
    load_weights(network, ("disc", "square", "bar"), file, [torch.rand(8, 3, 64, 64)])
    for output, expected in zip(run_network(network, image), run_network(other, image), strict=True):
        assert torch.allclose(output, expected, rtol=0.02, atol=0.1)  # the file's weights have 16 bits


def test_loaded_network_has_measured_batch_statistics(exported_network):
    _, file = exported_network
    network, images = Network(Shape(3, 4)), torch.rand(16, 3, 64, 64)
    load_weights(network, ("disc", "square", "bar"), file, [images])
    with torch.no_grad():
        _, expected_logits = network.eval()(images)
        _, training_output = network.train()(images)
    assert (training_output - expected_logits).abs().mean() < 0.2 * expected_logits.std()


def test_loaded_class_weights_are_matched_by_name(exported_network):
    other, file = exported_network
    network, image = Network(Shape(2, 4)), torch.rand(1, 3, 64, 64)
    load_weights(network, ("ring", "square"), file, [torch.rand(8, 3, 64, 64)])
    (boxes, logits), (wanted_boxes, expected_logits) = run_network(network, image), run_network(other, image)
    assert torch.allclose(boxes, wanted_boxes, rtol=0.02, atol=0.1)
    assert torch.allclose(logits[:, 1], expected_logits[:, 1], rtol=0.02, atol=0.1)
    assert network.heads[0].scores[-1].bias[0].item() == pytest.approx(-np.log(99))


@pytest.mark.parametrize(
    ("content", "channels", "reason"),
    [
        (None, 4, "does not exist"),
        (b"none", 4, "not an ONNX file"),
        (b"", 4, "not a network of"),
        ("exported", 8, "its first layer has 4 channels, but this network has 8"),
    ],
)
def test_incompatible_weights_are_rejected(exported_network, tmp_path, content, channels, reason):
    file = exported_network[1] if content == "exported" else tmp_path / "other.onnx"
    if isinstance(content, bytes):
        file.write_bytes(content)
    with pytest.raises(LinkwrightError) as caught:
        load_weights(Network(Shape(3, channels)), ("disc", "square", "bar"), file, [])
    assert caught.value.diagnostics[0].code == "VISION308"
    assert reason in str(caught.value.diagnostics[0].message)


def test_training_starts_from_weights_file_and_card_names_it(shapes, tmp_path, capsys):
    words = ["vision", "train", str(shapes), "--size", "96x96", "--channels", "4", "--threads", "1", "--epochs", "1"]
    assert main([*words, "-o", str(tmp_path / "first"), "--name", "first"]) == 0
    first_weights = tmp_path / "first" / "first.onnx"
    assert main([*words, "-o", str(tmp_path / "second"), "--weights", str(first_weights), "--rate", "1e-9"]) == 0
    capsys.readouterr()
    sessions = [
        onnxruntime.InferenceSession(file, providers=["CPUExecutionProvider"])
        for file in (first_weights, tmp_path / "second" / "detector.onnx")
    ]
    image = np.random.default_rng(0).random((1, 3, 96, 96), np.float32)
    first, second = (session.run(None, {"images": image})[0][0, :4] for session in sessions)
    assert np.abs(first - second).max() < 1.0  # in pixels
    assert "| started from | first.onnx, sha256 " in (tmp_path / "second" / "detector.md").read_text(encoding="utf-8")


def test_generalized_iou_orders_disjoint_boxes():
    first = torch.tensor([[0.0, 0.0, 10.0, 10.0]] * 3)
    second = torch.tensor([[0.0, 0.0, 10.0, 10.0], [20.0, 0.0, 30.0, 10.0], [90.0, 0.0, 100.0, 10.0]])
    plain_iou, generalized_iou = pairwise_iou(first, second)
    assert plain_iou.tolist() == pytest.approx([1, 0, 0])
    assert generalized_iou.tolist() == pytest.approx([1, -1 / 3, -0.8])


def test_cells_are_assigned_to_objects_and_ignored_regions():
    cell_centers, _ = make_cells(64, 64)
    boxes = torch.cat((cell_centers - 12, cell_centers + 12), 1)[None]
    logits = torch.zeros(1, len(cell_centers), 2)
    objects = torch.tensor([[[1.0, 8, 8, 32, 32], [-2.0, 40, 40, 60, 60], [-1.0, -1, -1, -1, -1]]])
    expected = assign_cells(boxes, logits, cell_centers, objects)
    inside = (cell_centers >= 8).all(1) & (cell_centers <= 32).all(1)
    assert expected.is_assigned[0].sum() == 10
    assert not (expected.is_assigned[0] & ~inside).any()
    assert (expected.scores[0][..., 0] == 0).all()
    assert expected.scores[0][..., 1].max() > 0.9
    hidden = (cell_centers >= 40).all(1) & (cell_centers <= 60).all(1)
    assert (expected.is_ignored[0] == hidden).all()


def test_batch_without_objects_has_loss():
    network = Network(Shape(2, 4))
    boxes, logits = network(torch.rand(2, 3, 64, 64))
    total, parts = compute_loss(boxes, logits, make_cells(64, 64)[0], torch.full((2, 1, 5), -1.0))
    total.backward()
    assert parts[0] == 0
    assert torch.isfinite(total)


def test_train_command_trains_evaluates_and_writes_card(shapes, tmp_path, capsys, monkeypatch):
    words = ["vision", "train", str(shapes), "-o", str(tmp_path), "--name", "detector", "--epochs", "2"]
    words += ["--size", "96x96", "--channels", "4", "--threads", "1", "--held-out", str(shapes)]
    monkeypatch.setattr(sys, "argv", ["linkwright", *words])
    assert main(words) == 0
    output = capsys.readouterr()
    assert output.err.count("epoch ") == 2
    assert output.out.count("mAP50 ") >= 2
    card = (tmp_path / "detector.md").read_text(encoding="utf-8")
    assert f"vision train {shapes}" in card
    assert "## Held out: shapes (val)" in card
    assert main(["vision", "evaluate", str(tmp_path / "detector.onnx"), str(shapes), "--confusion"]) == 0
    assert "8 images: mAP50" in capsys.readouterr().out
    assert main([*words, "--resume", "--epochs", "3"]) == 0
    assert capsys.readouterr().err.startswith("epoch 3 of 3")


def test_training_until_ctrl_c_is_kept(shapes, tmp_path):
    def stop_after_two(epoch):
        if epoch.number == 2:
            raise KeyboardInterrupt

    result = train_network(training_options(shapes, tmp_path), stop_after_two)
    assert result.was_interrupted
    assert result.network.is_file()
    assert "2 of 4" in result.card.read_text(encoding="utf-8")
    assert tuple(entry.name for entry in result.reports[0].evaluation.classes) == NAMES


@pytest.mark.parametrize("shape", [(8, 16, 3, 3), (48, 16, 1, 1)])
def test_orthogonalized_gradient_has_equal_singular_values(shape):
    torch.manual_seed(0)
    gradient = torch.randn(shape) * torch.logspace(-3, 0, shape[0])[:, None, None, None]
    spread = torch.linalg.svdvals(gradient.flatten(1))
    singular_values = torch.linalg.svdvals(orthogonalize(gradient).flatten(1))
    assert spread.max() > 10 * spread.min()
    assert singular_values.min() > 0.4
    assert singular_values.max() < 1.3
