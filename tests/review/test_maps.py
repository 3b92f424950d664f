"""Changes of maps in a review: the YAML file and its image belong together."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.navigation.maps.images import encode_pgm, encode_with_pillow
from tests.review.conftest import breaking, sentences, subject

MAP = """image: house.{suffix}
resolution: 0.05
origin: [-1.0, -2.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.25
"""


def map_image(suffix: str, rows: int = 40, wall: int = 0) -> bytes:
    pixels = np.full((rows, 20), 254, dtype=np.uint8)
    pixels[wall] = 0
    return encode_pgm(pixels) if suffix == "pgm" else encode_with_pillow(pixels, suffix)


def map_files(suffix: str) -> dict[str, str | bytes]:
    return {"maps/house.yaml": MAP.format(suffix=suffix), f"maps/house.{suffix}": map_image(suffix)}


@pytest.mark.parametrize("suffix", ["pgm", "png"])
def test_added_and_removed_map_is_one_change(repository, compare, suffix):
    repository.commit({"README.md": "house\n"})
    repository.commit(map_files(suffix))
    result = compare(repository, "HEAD~1..HEAD")
    (found,) = result.subjects
    assert (found.path, result.other_files) == ("maps/house.yaml", [])
    contents = f"house.{suffix}, 20 x 40 cells (1 x 2 m), resolution 0.05 m, origin -1 -2 0"
    assert sentences(found) == [f"map added: {contents}"]
    removed = compare(repository, "HEAD..HEAD~1")
    assert [found.path for found in removed.subjects] == ["maps/house.yaml"]
    assert breaking(removed) == ["map removed"]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("0.05", "0.1", ["resolution 0.05 m -> 0.1 m"]),
        ("[-1.0, -2.0, 0.0]", "[-1.5, -2.0, 0.0]", ["origin -1 -2 0 -> -1.5 -2 0"]),
        ("0.65", "0.7", ["occupied_thresh 0.65 -> 0.7"]),
        ("0.65", "0.650", []),
    ],
)
def test_changed_settings_of_a_map_are_reported(repository, compare, old, new, expected):
    repository.commit(map_files("pgm"))
    repository.write({"maps/house.yaml": MAP.format(suffix="pgm").replace(old, new)})
    assert [sentence for found in compare(repository).subjects for sentence in sentences(found)] == expected


@pytest.mark.parametrize("suffix", ["pgm", "png"])
def test_changed_image_is_a_change_of_the_map(repository, compare, suffix):
    repository.commit(map_files(suffix))
    repository.write({f"maps/house.{suffix}": map_image(suffix, wall=1)})
    result = compare(repository)
    (sentence,) = sentences(subject(result, "maps/house.yaml"))
    assert sentence.endswith("in columns 0 to 19 and rows 0 to 1 of the image")
    assert result.other_files == []


def test_image_in_another_format_has_the_same_cells(repository, compare):
    pixels = np.tile(np.arange(256, dtype=np.uint8), (20, 1))
    files = {
        suffix: encode_pgm(pixels) if suffix == "pgm" else encode_with_pillow(pixels, suffix)
        for suffix in ("pgm", "png")
    }
    repository.commit({"maps/house.yaml": MAP.format(suffix="pgm"), "maps/house.pgm": files["pgm"]})
    repository.write({"maps/house.yaml": MAP.format(suffix="png"), "maps/house.png": files["png"]})
    assert sentences(subject(compare(repository), "maps/house.yaml")) == ["image house.pgm -> house.png"]


def test_image_that_no_map_names_is_no_map(repository, compare):
    repository.commit({**map_files("png"), "maps/house.pgm": map_image("pgm")})
    repository.write({"maps/house.pgm": None})
    (found,) = compare(repository).subjects
    assert (found.path, sentences(found)) == ("maps/house.pgm", ["image of a map removed"])
    assert not breaking(compare(repository))


def test_size_of_a_map_is_reported_in_cells_and_meters(repository, compare):
    repository.commit(map_files("pgm"))
    repository.write({"maps/house.pgm": map_image("pgm", rows=60)})
    (figure,) = subject(compare(repository), "maps/house.yaml").figures
    assert (figure.old, figure.new) == ("20 x 40 cells (1 x 2 m)", "20 x 60 cells (1 x 3 m)")
