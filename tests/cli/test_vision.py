"""``linkwright vision detect``: output and drawn images."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest
from PIL import Image

from linkwright.cli.command import main


@pytest.fixture
def image(tmp_path):
    pixels = np.full((120, 160, 3), 150, np.uint8)
    pixels[40:80, 100:130] = (20, 60, 200)
    path = tmp_path / "scene.png"
    Image.fromarray(pixels).save(path)
    return path


def test_detect_prints_detections(image, capsys):
    assert main(["vision", "detect", str(image), "--model", "colors"]) == 0
    assert capsys.readouterr().out == f"{image}: blue 1.00 [100.0 40.0 130.0 80.0]\n"


def test_detect_prints_json(image, capsys):
    assert main(["vision", "detect", str(image), "-m", "colors", "--format", "json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert (row["image"], row["width"], row["height"]) == (str(image), 160, 120)
    assert row["detections"] == [{"class": "blue", "score": 1.0, "box": [100.0, 40.0, 130.0, 80.0]}]


def write_marker_image(folder, dictionary):
    """Write an image of the marker 4, and return its path."""
    pixels = np.full((120, 160), 255, np.uint8)
    pixels[20:80, 30:90] = cv2.aruco.generateImageMarker(cv2.aruco.getPredefinedDictionary(dictionary), 4, 60)
    path = folder / "marker.png"
    Image.fromarray(pixels).save(path)
    return str(path)


def test_aruco_detections_have_corners(tmp_path, capsys):
    path = write_marker_image(tmp_path, cv2.aruco.DICT_4X4_50)
    assert main(["vision", "detect", path, "-m", "aruco", "--format", "json"]) == 0
    ((detection,),) = [row["detections"] for row in json.loads(capsys.readouterr().out)]
    assert detection["class"] == "4"
    assert len(detection["corners"]) == 4


@pytest.mark.parametrize("model", ["aruco", "apriltag"])
def test_dictionary_option_selects_markers(tmp_path, capsys, model):
    path = write_marker_image(tmp_path, cv2.aruco.DICT_6X6_250)
    assert main(["vision", "detect", path, "-m", model]) == 0
    assert capsys.readouterr().out == f"{path}: nothing found\n"
    assert main(["vision", "detect", path, "-m", model, "--dictionary", "6X6_250"]) == 0
    assert capsys.readouterr().out.startswith(f"{path}: 4 1.00 [")


def test_unknown_or_unsupported_dictionary_is_rejected(image, capsys):
    assert main(["vision", "detect", str(image), "-m", "aruco", "--dictionary", "6X6250"]) == 1
    assert "did you mean '6X6_250'" in capsys.readouterr().err
    assert main(["vision", "detect", str(image), "-m", "colors", "--dictionary", "6X6_250"]) == 1
    assert "only 'aruco' and 'apriltag' have this option: leave it out" in capsys.readouterr().err


def test_output_images_get_unique_names(image, tmp_path, capsys):
    folder = tmp_path / "drawn"
    assert main(["vision", "detect", str(image), str(image), "-m", "colors", "--output", str(folder)]) == 0
    assert sorted(path.name for path in folder.iterdir()) == ["scene-2_detections.png", "scene_detections.png"]
    with Image.open(folder / "scene_detections.png") as file:
        assert file.size == (160, 120)
        assert (np.asarray(file)[80, 100:130] != 150).any()


def test_unreadable_image_does_not_stop_others(image, tmp_path, capsys):
    (tmp_path / "text.png").write_text("no image")
    paths = [str(tmp_path / "text.png"), str(tmp_path / "gone.png"), str(image)]
    assert main(["vision", "detect", *paths, "--model", "colors"]) == 1
    printed = capsys.readouterr()
    assert "blue" in printed.out
    assert printed.err.count("VISION110") == 2
    assert "text.png" in printed.err
    assert "gone.png" in printed.err


def test_classes_are_selected_by_name(image, capsys):
    assert main(["vision", "detect", str(image), "-m", "colors", "--classes", "red"]) == 0
    assert capsys.readouterr().out == f"{image}: nothing found\n"
    assert main(["vision", "detect", str(image), "-m", "colors", "--classes", "blu"]) == 1
    printed = capsys.readouterr().err
    assert "VISION111" in printed
    assert "did you mean 'blue'?" in printed


def test_threshold_out_of_range_is_usage_error(image, capsys):
    assert main(["vision", "detect", str(image), "--threshold", "2"]) == 2
    assert "value must be from 0 to 1" in capsys.readouterr().err
