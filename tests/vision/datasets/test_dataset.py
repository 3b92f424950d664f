"""Datasets on the disk."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
import yaml
from PIL import Image

from linkwright.diagnostics import LinkwrightError
from linkwright.vision.datasets.dataset import make_dataset
from linkwright.vision.datasets.labels import find_bounding_box
from linkwright.vision.datasets.options import SPLITS, Options
from linkwright.vision.datasets.rendering import DatasetInput, DatasetRenderer, choose_split
from tests.vision.datasets.masks import color_mask
from tests.vision.datasets.places import BALL, GROUND, WALL, world_text, write_yard

OPTIONS = Options(width=160, height=120, seed=3, copies=2, distractors=4)


@pytest.fixture
def source(tmp_path):
    return DatasetInput((str(write_yard(tmp_path)),), (), None, OPTIONS)


def make_small_dataset(source, path, images, **options):
    parameters = {
        "options": source.options,
        "models": source.added_models,
        "classes": source.classes,
        "workers": 1,
        **options,
    }
    return make_dataset(source.worlds, path, images, **parameters)


def test_dataset_requires_only_world_and_folder(tmp_path):
    dataset = make_dataset(write_yard(tmp_path), str(tmp_path / "made"), 2)
    assert (dataset.added, dataset.folder.count) == (2, 2)
    assert {"annotations", "labels"} <= {path.name for path in (tmp_path / "made").iterdir()}


def file_contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def diagnostic_code(caught) -> str:
    return caught.value.diagnostics[0].code


def split_lists(folder: Path):
    return {split: json.loads((folder / f"annotations/instances_{split}.json").read_text()) for split in SPLITS}


BRIGHT_SCENE = """<scene><ambient>0.2 0.2 0.2 1</ambient><background>0 1 1 1</background></scene>
<light name="red" type="directional"><pose>0 0 8 0 0 0</pose><diffuse>1 0 0 1</diffuse><specular>0 0 0 1</specular>
  <direction>0 0.3 -1</direction></light>"""


def test_lights_option_keeps_lights_and_background(tmp_path):
    path = tmp_path / "lit.world"
    path.write_text(world_text(BRIGHT_SCENE, GROUND, BALL.format(name="ball", pose="1 0 0.2 0 0 0")))
    pixels = {}
    for properties in ((), ("lights",)):
        source = DatasetInput(
            (str(path),),
            (),
            None,
            replace(OPTIONS, distractors=0, image_format="png", fixed_properties=("colors", "lens", *properties)),
        )
        renderer = DatasetRenderer(source)
        try:
            images = [
                np.asarray(Image.open(BytesIO(renderer.render_image(index).data)).convert("RGB")) for index in range(4)
            ]
        finally:
            renderer.close()
        pixels[properties] = np.concatenate(images).reshape(-1, 3).astype(int)
    lit = pixels["lights",]
    sky = (lit == [0, 255, 255]).all(axis=1)
    assert sky.any()
    ground = lit[~sky & (lit[:, 0] > 60)]
    assert (ground[:, 0] > 1.3 * ground[:, 1]).mean() > 0.9, "the light is red"
    assert not (pixels[()] == [0, 255, 255]).all(axis=1).any()


def test_all_label_formats_agree(source, tmp_path):
    folder = tmp_path / "set"
    make_small_dataset(source, folder, 20)
    assert yaml.safe_load((folder / "data.yaml").read_text()) == {
        "train": "images/train",
        "val": "images/val",
        "test": "images/test",
        "names": {0: "ball", 1: "crate", 2: "drums"},
    }
    objects = 0
    for split, text in split_lists(folder).items():
        assert [category["name"] for category in text["categories"]] == ["ball", "crate", "drums"]
        assert len({annotation["id"] for annotation in text["annotations"]}) == len(text["annotations"])
        for image in text["images"]:
            with Image.open(folder / "images" / split / image["file_name"]) as opened:
                assert opened.size == (160, 120) == (image["width"], image["height"])
            lines = (folder / "labels" / split / f"{Path(image['file_name']).stem}.txt").read_text().splitlines()
            expected_labels = [
                annotation
                for annotation in text["annotations"]
                if annotation["image_id"] == image["id"] and not annotation["iscrowd"]
            ]
            assert len(lines) == len(expected_labels)
            for line, annotation in zip(lines, expected_labels, strict=True):
                number, *shares = line.split()
                x, y, width, height = np.array(shares, float) * [160, 120, 160, 120]
                assert int(number) + 1 == annotation["category_id"]
                assert [x - width / 2, y - height / 2, width, height] == pytest.approx(annotation["bbox"], abs=1e-3)
                objects += 1
        for annotation in text["annotations"]:
            mask = color_mask(tuple(annotation["segmentation"]["counts"]), *annotation["segmentation"]["size"])
            left, top, right, bottom = find_bounding_box(mask)
            assert annotation["bbox"] == [left, top, right - left, bottom - top]
            assert annotation["area"] == mask.sum()
    card = json.loads((folder / "dataset.json").read_text())
    assert card["splits"] == {"train": 16, "val": 2, "test": 2}
    assert sum(figures["objects"] for figures in card["statistics"].values()) == objects > 10
    assert card["made"][0]["options"]["seed"] == 3
    assert (folder / "contact_sheet.jpg").stat().st_size > 0


def test_same_seed_gives_identical_files(source, tmp_path):
    make_small_dataset(source, tmp_path / "a", 4)
    make_small_dataset(source, tmp_path / "b", 4)
    assert file_contents(tmp_path / "a") == file_contents(tmp_path / "b")
    make_small_dataset(replace(source, options=replace(OPTIONS, seed=4)), tmp_path / "c", 4)
    assert file_contents(tmp_path / "a") != file_contents(tmp_path / "c")


@pytest.mark.parametrize("way", ["OpenGL", "Embree", "MuJoCo"])
def test_image_does_not_depend_on_previous_images(source, monkeypatch, way):
    if way != "OpenGL":  # without OpenGL, as on macOS and Windows
        monkeypatch.setenv("MUJOCO_GL", "disable")
    if way == "MuJoCo":
        monkeypatch.setitem(sys.modules, "embreex", None)
    first, second = DatasetRenderer(source), DatasetRenderer(source)
    try:
        if way != "OpenGL":
            assert f"ray casting with {way}," in str(first.render_method)
        for number in (0, 49, 3, 51):
            first.render_image(number)
        assert first.render_image(52) == second.render_image(52)
        assert first.render_image(1) == second.render_image(1)
    finally:
        first.close()
        second.close()


def test_worker_processes_give_identical_files(source, tmp_path):
    make_small_dataset(source, tmp_path / "a", 52)
    make_small_dataset(source, tmp_path / "b", 52, workers=2)
    assert file_contents(tmp_path / "a") == file_contents(tmp_path / "b")


def test_splits_have_requested_shares():
    options = replace(OPTIONS, splits=(0.5, 0.3, 0.2))
    splits = [choose_split(index, options) for index in range(200)]
    assert [splits.count(split) for split in SPLITS] == [100, 60, 40]
    assert [choose_split(index, options) for index in range(200)] == splits
    assert {choose_split(index, replace(OPTIONS, splits=(1.0, 0.0, 0.0))) for index in range(50)} == {"train"}


def test_append_adds_images(source, tmp_path):
    folder = tmp_path / "set"
    make_small_dataset(source, folder, 3)
    dataset = make_small_dataset(source, folder, 4, append=True)
    assert (dataset.added, dataset.folder.count) == (4, 7)
    numbers = sorted(image["id"] for text in split_lists(folder).values() for image in text["images"])
    assert numbers == list(range(7))
    make_small_dataset(source, tmp_path / "whole", 7)
    assert {
        name: data for name, data in file_contents(tmp_path / "whole").items() if name.startswith(("images", "labels"))
    } == {name: data for name, data in file_contents(folder).items() if name.startswith(("images", "labels"))}


def test_other_files_are_not_overwritten(source, tmp_path):
    folder = tmp_path / "set"
    folder.mkdir()
    (folder / "diary.txt").write_text("dear diary")
    for words in ({}, {"force": True}):
        with pytest.raises(LinkwrightError) as caught:
            make_small_dataset(source, folder, 1, **words)
        assert diagnostic_code(caught) == "VISION205"
    with pytest.raises(LinkwrightError) as caught:
        make_small_dataset(source, folder, 1, append=True)
    assert diagnostic_code(caught) == "VISION206"
    assert file_contents(folder) == {"diary.txt": b"dear diary"}


def test_dataset_is_replaced_only_on_request(source, tmp_path):
    folder = tmp_path / "set"
    make_small_dataset(source, folder, 3)
    with pytest.raises(LinkwrightError) as caught:
        make_small_dataset(source, folder, 1)
    assert diagnostic_code(caught) == "VISION205"
    (folder / "notes.txt").write_text("kept")
    assert make_small_dataset(source, folder, 1, force=True).folder.count == 1
    assert len([name for name in file_contents(folder) if name.startswith("images")]) == 1
    assert (folder / "notes.txt").read_text() == "kept"


def test_append_with_other_classes_is_rejected(source, tmp_path):
    folder = tmp_path / "set"
    make_small_dataset(source, folder, 1)
    (tmp_path / "classes.yaml").write_text("ball: '*ball*'\n")
    with pytest.raises(LinkwrightError) as caught:
        make_small_dataset(replace(source, classes=str(tmp_path / "classes.yaml")), folder, 1, append=True)
    assert diagnostic_code(caught) == "VISION206"


def test_append_to_dataset_of_other_version_is_rejected(source, tmp_path):
    folder = tmp_path / "set"
    make_small_dataset(source, folder, 1)
    card = folder / "dataset.json"
    card.write_text(card.read_text().replace('"form": 2', '"form": 1'))
    with pytest.raises(LinkwrightError) as caught:
        make_small_dataset(source, folder, 1, append=True)
    assert diagnostic_code(caught) == "VISION206"


def test_interrupted_dataset_is_consistent(source, tmp_path):
    folder = tmp_path / "set"

    def stop(count):
        if count == 3:
            raise KeyboardInterrupt

    dataset = make_small_dataset(source, folder, 9, progress=stop)
    assert dataset.was_interrupted
    assert dataset.folder.count == 3
    assert json.loads((folder / "dataset.json").read_text())["images"] == 3
    assert len([name for name in file_contents(folder) if name.startswith("images")]) == 3
    assert make_small_dataset(source, folder, 2, append=True).folder.count == 5


def test_world_without_objects_is_an_error(tmp_path):
    path = tmp_path / "empty.world"
    path.write_text(world_text(GROUND, WALL))
    with pytest.raises(LinkwrightError) as caught:
        DatasetRenderer(DatasetInput((str(path),), (), None, OPTIONS))
    assert diagnostic_code(caught) == "VISION202"


def test_objects_of_one_world_are_added_to_others(source, tmp_path):
    path = tmp_path / "wall.world"
    path.write_text(world_text(GROUND, WALL, BALL.format(name="green_ball", pose="0 0 0.2 0 0 0")))
    renderer = DatasetRenderer(replace(source, worlds=(*source.worlds, str(path))))
    try:
        assert renderer.classes == ("ball", "crate", "drums")
        labels = {label.label for index in range(1, 30, 2) for label in renderer.render_image(index).labels}
        assert labels == {0, 1, 2}
    finally:
        renderer.close()


def test_added_object_without_visuals_is_an_error(source, tmp_path):
    path = tmp_path / "bare.urdf"
    path.write_text('<robot name="bare"><link name="base"/></robot>')
    with pytest.raises(LinkwrightError) as caught:
        DatasetRenderer(replace(source, added_models=(str(path),)))
    assert diagnostic_code(caught) == "VISION203"
