"""Data sets in the formats of YOLO and COCO."""

from __future__ import annotations

import json

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.vision.training.images import (
    LabeledImages,
    augment,
    compute_repeat_factors,
    draw_repeated_indices,
    read_image,
    read_labeled_images,
)
from linkwright.vision.training.options import CropSettings, Options
from linkwright.vision.training.yolo_dataset import open_dataset
from tests.vision.training.images_of_shapes import NAMES, write_shapes

CROP_SETTINGS = CropSettings((64, 64), (0.42, 1.1))


@pytest.fixture
def shapes(tmp_path):
    return write_shapes(tmp_path / "shapes", 3)


def problem_text(function, *words):
    with pytest.raises(LinkwrightError) as caught:
        function(*words)
    return caught.value.diagnostics[0]


def test_dataset_is_read(shapes):
    dataset = open_dataset(shapes)
    assert dataset.names == NAMES
    images = dataset.read("train")
    assert [image.path.name for image in images] == ["000.png", "001.png", "002.png"]
    assert images[0].classes.tolist() == [0, 1]
    assert not images[0].ignored.any()
    assert (images[0].boxes >= 0).all()
    assert (images[0].boxes <= 1).all()


def test_boxes_match_colored_shapes(shapes):
    for labeled_image in open_dataset(shapes).read("train"):
        left, top, right, bottom = np.rint(labeled_image.boxes[0] * 96).astype(int)
        red = read_image(labeled_image)[..., 0] > 200
        assert (np.flatnonzero(red.any(0))[[0, -1]] == (left, right - 1)).all()
        assert (np.flatnonzero(red.any(1))[[0, -1]] == (top, bottom - 1)).all()


def test_coco_crowd_annotations_are_ignored(shapes):
    (shapes / "annotations").mkdir()
    content = {
        "images": [{"id": 7, "file_name": "001.png", "width": 96, "height": 48}],
        "categories": [{"id": 2, "name": "square"}, {"id": 1, "name": "disc"}],
        "annotations": [
            {"image_id": 7, "category_id": 2, "bbox": [24, 12, 48, 24], "iscrowd": 1},
            {"image_id": 7, "category_id": 1, "bbox": [0, 0, 9, 9], "iscrowd": 0},
        ],
    }
    (shapes / "annotations" / "instances_train.json").write_text(json.dumps(content))
    image = open_dataset(shapes).read("train")[1]
    assert image.ignored.tolist() == [False, False, True]
    assert image.classes[2] == 1
    assert image.boxes[2].tolist() == [0.25, 0.25, 0.75, 0.75]


def test_image_without_labels_has_no_boxes(shapes):
    (shapes / "labels" / "train" / "002.txt").unlink()
    assert open_dataset(shapes).read("train")[2].boxes.shape == (0, 4)


def test_yaml_file_is_accepted_as_dataset_path(shapes):
    assert open_dataset(shapes / "data.yaml").names == NAMES


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("train: images/train\n", "'names' must be a list of names, or a mapping from 0, 1, ... to names"),
        (
            "train: images/train\nnames: {0: a, 2: b}\n",
            "'names' must be a list of names, or a mapping from 0, 1, ... to names",
        ),
        ("names: [a]\n", "neither 'train' nor 'val'"),
        ("- 1\n", "not a mapping of names to values"),
        ("names: [a\n", "is not a dataset"),
    ],
)
def test_malformed_dataset_is_reported(tmp_path, content, message):
    (tmp_path / "data.yaml").write_text(content)
    diagnostic = problem_text(open_dataset, tmp_path)
    assert diagnostic.code == "VISION302"
    assert message in str(diagnostic.message)


def test_missing_and_empty_folders_are_rejected(tmp_path):
    assert "does not exist" in str(problem_text(open_dataset, tmp_path / "none").message)
    assert "it contains no YAML file" in str(problem_text(open_dataset, tmp_path).message)


def test_missing_split_is_reported(shapes):
    diagnostic = problem_text(open_dataset(shapes).read, "test")
    assert diagnostic.code == "VISION303"
    assert "'train' and 'val'" in str(diagnostic.hint)


def test_split_without_images_is_reported(shapes):
    for path in (shapes / "images" / "train").iterdir():
        path.unlink()
    assert problem_text(open_dataset(shapes).read, "train").code == "VISION303"


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("0 0.5 0.5 0.1", "five numbers"),
        ("0 0.5 0.5 0.1 b", "five numbers"),
        ("2 0.5 0.5 0.1 0.1", "the class 2 is not one of the 2"),
        ("0.5 0.5 0.5 0.1 0.1", "the class 0.5 is not one of the 2"),
        ("0 50 0.5 0.1 0.1", "fractions of the image"),
        ("0 nan 0.5 0.1 0.1", "fractions of the image"),
    ],
)
def test_invalid_label_is_reported_with_location(shapes, line, message):
    text = shapes / "labels" / "train" / "001.txt"
    text.write_text(f"0 0.5 0.5 0.1 0.1\n{line}\n")
    diagnostic = problem_text(open_dataset(shapes).read, "train")
    assert diagnostic.code == "VISION304"
    assert message in str(diagnostic.message)
    assert diagnostic.span is not None
    assert diagnostic.span.line == 2


def test_unreadable_image_is_reported(shapes):
    dataset = open_dataset(shapes)
    (shapes / "images" / "train" / "001.png").write_bytes(b"none")
    diagnostic = problem_text(read_labeled_images, dataset.read("train"), 96, 96)
    assert (diagnostic.code, "001.png" in str(diagnostic.message)) == ("VISION305", True)


def test_images_are_letterboxed_with_gray(shapes):
    images = open_dataset(shapes).read("train")
    labeled_images = read_labeled_images(images, 160, 96)
    assert labeled_images.images.shape == (3, 96, 160, 3)
    assert (labeled_images.images[:, :, :32] == 114).all()
    assert np.allclose(labeled_images.objects[0][:, 1:], images[0].boxes * 96 + (32, 0, 32, 0), atol=1e-4)


def test_augmentation_keeps_boxes_around_objects(shapes):
    labeled_images = read_labeled_images(open_dataset(shapes).read("train"), 96, 96)
    object_count = 0
    for seed in range(40):
        image, objects = augment(labeled_images, seed % 3, CROP_SETTINGS, np.random.default_rng(seed))
        assert image.shape == (64, 64, 3)
        for kind, left, top, right, bottom in objects:
            assert 0 <= left < right <= 64
            assert 0 <= top < bottom <= 64
            if kind == 0 and min(right - left, bottom - top) > 8:
                center_color = image[int((top + bottom) / 2), int((left + right) / 2)].astype(int)
                object_count += 1
                assert center_color[0] > center_color[2]  # discs are red
    assert object_count > 10


def test_augmentation_is_deterministic_for_seed(shapes):
    labeled_images = read_labeled_images(open_dataset(shapes).read("train"), 96, 96)
    first, second = (augment(labeled_images, 0, CROP_SETTINGS, np.random.default_rng(5)) for _ in range(2))
    assert (first[0] == second[0]).all()
    assert (first[1] == second[1]).all()


def test_last_epochs_use_whole_images(shapes):
    options = Options(shapes, shapes, epochs=5, whole_epochs=2, width=96, height=96)
    assert [options.choose_crop(epoch).size for epoch in range(5)] == [(64, 64)] * 3 + [(96, 96)] * 2
    assert options.choose_crop(4).scales[0] > options.choose_crop(0).scales[0]
    labeled_images = read_labeled_images(open_dataset(shapes).read("train"), 96, 96)
    whole_image_settings = CropSettings((96, 96), (1.0, 1.0))
    (_, objects) = augment(labeled_images, 0, whole_image_settings, np.random.default_rng(5))
    first_objects = labeled_images.objects[0]
    sides = (objects[:, 3:] - objects[:, 1:3]) / (first_objects[:, 3:] - first_objects[:, 1:3])
    assert (objects[:, 0] == first_objects[:, 0]).all()
    assert np.median(sides) == pytest.approx(1, abs=0.12)  # the objects are complete, and keep their sizes


def test_images_of_rare_classes_are_sampled_more_often():
    def image(*classes):
        return np.array([[class_number, 0, 0, 9, 9] for class_number in classes], np.float32).reshape(-1, 5)

    objects = (*[image(0)] * 16, *[image(1, 0)] * 8, image(2), image(-4, 0), image())
    labeled_images = LabeledImages(np.zeros((len(objects), 1, 1, 3), np.uint8), objects)
    times = compute_repeat_factors(labeled_images, 4)
    assert times[:24] == pytest.approx(1)  # classes 0 and 1 are at the median of 8, or more frequent
    assert times[24] == pytest.approx(np.sqrt(8))
    assert times[25:] == pytest.approx(1)  # images with only ignored objects, or without objects
    chosen = [draw_repeated_indices(times, np.random.default_rng(seed)) for seed in range(200)]
    counts = np.mean([np.bincount(indices, minlength=len(objects)) for indices in chosen], 0)
    assert counts[:24] == pytest.approx(1)
    assert counts[24] == pytest.approx(np.sqrt(8), abs=0.15)
