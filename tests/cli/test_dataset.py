"""``linkwright dataset``."""

from __future__ import annotations

import json

import pytest

from linkwright.cli import main
from linkwright.process.interruption import INTERRUPTED
from linkwright.vision.datasets.folder import DatasetFolder
from tests.full_disk import full_disk, needs_limits
from tests.vision.datasets.places import write_yard

SMALL = ["--size", "64x48", "--workers", "1", "--copies", "1", "--distractors", "0"]


@pytest.fixture
def words(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return ["dataset", str(write_yard(tmp_path)), "-o", "set", *SMALL]


def test_dataset_is_written_and_counted(words, tmp_path, capsys):
    assert main([*words, "-n", "3", "--format", "yolo", "--image-format", "png", "--keep", "colors,lens"]) == 0
    printed = capsys.readouterr()
    assert [line.split()[0] for line in printed.out.splitlines()] == ["class", "ball", "crate", "drums", "3"]
    assert "3 images in set" in printed.out
    assert "Classes: ball, crate, drums" in printed.err
    assert len(list((tmp_path / "set/images").rglob("*.png"))) == 3
    assert not (tmp_path / "set/annotations").exists()
    (run,) = json.loads((tmp_path / "set/dataset.json").read_text())["made"]
    assert run["options"]["fixed_properties"] == ["colors", "lens"]


def test_classes_without_objects_are_reported(words, tmp_path, capsys):
    (tmp_path / "classes.yaml").write_text("ball: '*ball*'\nunicorn:\n")
    assert main([*words, "-n", "1", "--classes", "classes.yaml"]) == 0
    assert "These worlds have no object of the classes unicorn" in capsys.readouterr().err


def test_interrupt_keeps_completed_images(words, tmp_path, capsys, monkeypatch):
    add = DatasetFolder.add

    def interrupted(folder, sample):
        if sample.index == 2:
            raise KeyboardInterrupt
        add(folder, sample)

    monkeypatch.setattr(DatasetFolder, "add", interrupted)
    assert main([*words, "-n", "5"]) == INTERRUPTED
    assert "2 of 5 images were rendered" in capsys.readouterr().err
    assert json.loads((tmp_path / "set/dataset.json").read_text())["images"] == 2


@needs_limits
def test_full_disk_leaves_no_partial_files(words, tmp_path, capsys):
    with full_disk(50):
        assert main([*words, "-n", "2"]) == 1
    printed = capsys.readouterr().err
    assert "VISION207" in printed
    assert "File too large" in printed
    assert [path for path in (tmp_path / "set").rglob("*") if path.is_file()] == []


@pytest.mark.parametrize(
    "wrong",
    [["--size", "640"], ["--size", "8x8"], ["--size", "640x99999"], ["--format", "voc"], ["--keep", "poses"],
     ["--splits", "1,2"], ["--splits", "0,0,0"], ["--splits", "a,b,c"], ["--min-visible", "2"], ["--images", "0"],
     ["--seed", "-1"], ["--append", "--force"]],
)  # fmt: skip
def test_invalid_options_are_rejected(words, wrong, capsys):
    assert main([*words, *wrong]) == 2
    assert wrong[0] in capsys.readouterr().err


def test_missing_world_is_reported(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["dataset", "nowhere", "-o", "set"]) == 1
    assert "SIM150" in capsys.readouterr().err
    assert not (tmp_path / "set").exists()
