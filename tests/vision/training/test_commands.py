"""`linkwright vision train` and `evaluate` without PyTorch."""

from __future__ import annotations

import json
import sys

import pytest

from linkwright.cli import main
from linkwright.diagnostics import install_hint
from tests.vision.training.images_of_shapes import write_shapes


@pytest.fixture
def colors(tmp_path):
    """Return a dataset of red discs and blue squares, which the detector `colors` finds."""
    return write_shapes(tmp_path / "colors", 6, names=("red", "blue"))


def test_training_without_pytorch_names_extra_to_install(colors, tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "torch", None)
    assert main(["vision", "train", str(colors), "-o", str(tmp_path / "out")]) == 1
    output = capsys.readouterr().err
    assert "VISION301" in output
    assert str(install_hint("train")) in output
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("size", ["480", "480x", "480x100", "0x0", "-32x32", "32x99999968"])
def test_invalid_size_is_a_usage_error(size, capsys):
    assert main(["vision", "train", "somewhere", f"--size={size}"]) == 2
    assert "both multiples of 32" in capsys.readouterr().err


def test_evaluate_command_prints_metrics(colors, capsys):
    assert main(["vision", "evaluate", "colors", str(colors), "--confusion"]) == 0
    output = capsys.readouterr().out
    assert output.startswith("6 images: mAP50 1.000, ")
    assert "| red | 6 | 1.000 |" in output
    assert "| blue |  | 6 |" in output


def test_evaluate_command_prints_json(colors, capsys):
    assert main(["vision", "evaluate", "colors", str(colors), "--split", "train", "--format", "json"]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert figures["images"] == 6
    assert figures["map50"] == pytest.approx(1)
    assert [row["name"] for row in figures["classes"]] == ["red", "blue"]


def test_folder_without_dataset_is_one_error(tmp_path, capsys):
    assert main(["vision", "evaluate", "colors", str(tmp_path)]) == 1
    output = capsys.readouterr()
    assert "VISION302" in output.err
    assert output.out == ""


def test_missing_detector_is_one_error(colors, capsys):
    assert main(["vision", "evaluate", "none.onnx", str(colors)]) == 1
    assert "VISION102" in capsys.readouterr().err
