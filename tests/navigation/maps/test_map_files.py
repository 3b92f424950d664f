"""Maps as images: the meaning of pixels in each mode, and round trips."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from linkwright.diagnostics import LinkwrightError
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.maps.images import MapImage, read_image
from linkwright.navigation.maps.map_files import MapSaveSettings, load_map, save_map
from linkwright.navigation.maps.map_yaml import MapMode, MapYaml
from linkwright.navigation.maps.pixels import cells_of_image, pixels_of_cells

_CELLS = arrays(np.int8, st.tuples(st.integers(1, 6), st.integers(1, 6)), elements=st.integers(-1, 100))


def _make_map_yaml(mode: MapMode, *, negate: bool = False, occupied: float = 0.65, free: float = 0.196) -> MapYaml:
    return MapYaml(
        image=Path("x"),
        resolution=0.05,
        origin=(0.0, 0.0, 0.0),
        negate=negate,
        occupied_thresh=occupied,
        free_thresh=free,
        mode=mode,
    )


def _make_row(*values: float) -> MapImage:
    return MapImage(np.array([values]) / 255.0)


@pytest.mark.parametrize(
    ("mode", "negate", "pixels", "cells"),
    [
        (MapMode.TRINARY, False, (0, 89, 90, 205, 206, 254, 255), (100, 100, -1, -1, 0, 0, 0)),
        (MapMode.TRINARY, True, (0, 49, 50, 165, 166, 255), (0, 0, -1, -1, 100, 100)),
        (MapMode.SCALE, False, (0, 90, 127, 205, 254), (100, 99, 67, 0, 0)),
        (MapMode.RAW, False, (0, 1, 100, 101, 255), (0, 1, 100, -1, -1)),
        (MapMode.RAW, True, (0, 1, 100, 101, 255), (0, 1, 100, -1, -1)),
    ],
)
def test_pixel_values_match_nav2_in_each_mode(
    mode: MapMode, negate: bool, pixels: tuple[float, ...], cells: tuple[int, ...]
) -> None:
    assert cells_of_image(_make_row(*pixels), _make_map_yaml(mode, negate=negate)).tolist() == [list(cells)]


def test_alpha_is_averaged_in_trinary_and_unknown_in_scale_mode() -> None:
    image = MapImage(np.array([[0.0, 0.0, 1.0]]), np.array([[1.0, 0.0, 0.0]]))
    # The mean of the channels is (0 + 0 + 0 + 1) / 4, so the darkness is 0.75.
    assert cells_of_image(image, _make_map_yaml(MapMode.TRINARY)).tolist() == [[100, 100, -1]]
    assert cells_of_image(image, _make_map_yaml(MapMode.TRINARY, occupied=0.8)).tolist() == [[-1, 100, -1]]
    assert cells_of_image(image, _make_map_yaml(MapMode.SCALE)).tolist() == [[100, -1, -1]]


def test_equal_thresholds_give_no_intermediate_values() -> None:
    text = _make_map_yaml(MapMode.SCALE, occupied=0.5, free=0.5)
    assert cells_of_image(MapImage(np.array([[0.0, 0.5, 1.0]])), text).tolist() == [[100, 0, 0]]


def test_written_pixels_match_nav2() -> None:
    cells = np.array([[0, 25, 26, 64, 65, 100, -1]], np.int8)
    assert pixels_of_cells(cells, MapMode.TRINARY, 0.65, 0.25).tolist() == [[254, 254, 205, 205, 0, 0, 205]]
    assert pixels_of_cells(cells, MapMode.RAW, 0.65, 0.25).tolist() == [[0, 25, 26, 64, 65, 100, 255]]
    assert pixels_of_cells(cells, MapMode.SCALE, 0.65, 0.25)[0, [0, 5, 6]].tolist() == [[255, 255], [0, 255], [128, 0]]


@given(_CELLS, st.sampled_from(["pgm", "png", "bmp"]))
def test_raw_map_round_trip(tmp_path_factory: pytest.TempPathFactory, cells: NDArray[np.int8], kind: str) -> None:
    folder = tmp_path_factory.mktemp("maps")
    grid = Grid(cells=cells, resolution=0.025, x=-12.345, y=3.0, yaw=0.5)
    image, text = save_map(grid, MapSaveSettings(name=str(folder / "a"), image_format=kind, mode=MapMode.RAW))
    assert (image.name, text.name) == (f"a.{kind}", "a.yaml")
    loaded = load_map(text)
    assert loaded.cells.tolist() == cells.tolist()
    assert (loaded.resolution, loaded.x, loaded.y, loaded.yaw) == (0.025, -12.345, 3.0, 0.5)


@given(_CELLS)
def test_trinary_map_round_trip(tmp_path_factory: pytest.TempPathFactory, cells: NDArray[np.int8]) -> None:
    name = str(tmp_path_factory.mktemp("maps") / "a")
    _, text = save_map(Grid(cells=cells, resolution=0.05), MapSaveSettings(name=name, free_thresh=0.196))
    rounded = np.where(cells >= 65, 100, np.where((cells >= 0) & (cells <= 20), 0, -1))
    assert load_map(text).cells.tolist() == rounded.tolist()


@given(_CELLS)
def test_scale_map_round_trip_keeps_unknown_cells(
    tmp_path_factory: pytest.TempPathFactory, cells: NDArray[np.int8]
) -> None:
    name = str(tmp_path_factory.mktemp("maps") / "a")
    image, text = save_map(Grid(cells=cells, resolution=0.05), MapSaveSettings(name=name, mode=MapMode.SCALE))
    assert image.suffix == ".png"
    loaded = load_map(text).cells
    assert ((loaded == -1) == (cells == -1)).all()
    assert (loaded[cells >= 66] == 100).all()


def test_written_map_files_match_nav2_byte_for_byte(tmp_path: Path) -> None:
    save_map(
        Grid(cells=np.zeros((1, 2), np.int8), resolution=0.05, x=-10.0), MapSaveSettings(name=str(tmp_path / "map"))
    )
    assert (tmp_path / "map.pgm").read_bytes() == b"P5\n2 1\n255\n\xfe\xfe"
    assert (tmp_path / "map.yaml").read_text() == (
        "image: map.pgm\nmode: trinary\nresolution: 0.05\norigin: [-10, 0, 0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.25"
    )


def test_saving_warns_about_lossy_thresholds_and_unknown_formats(tmp_path: Path) -> None:
    messages: list[str] = []
    grid = Grid(cells=np.array([[0, -1]], np.int8), resolution=0.05)
    save_map(grid, MapSaveSettings(name=str(tmp_path / "a")), messages.append)
    assert len(messages) == 1
    assert "Unknown cells are read back as free with a free threshold of 0.25" in messages[0]
    assert load_map(tmp_path / "a.yaml").cells.tolist() == [[0, 0]]
    messages.clear()
    save_map(grid, MapSaveSettings(name=str(tmp_path / "b"), free_thresh=0.196), messages.append)
    assert messages == []
    save_map(grid, MapSaveSettings(name=str(tmp_path / "c"), image_format="xyz", mode=MapMode.RAW), messages.append)
    assert "'xyz' is not one of the recommended formats" in messages[0]
    assert "Using 'png' instead" in messages[1]
    assert (tmp_path / "c.png").is_file()


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"P5\n2 2\n255\n\x00\x01\x02", "it has only 3 of 4 pixels"),
        (b"P5\n99999 99999\n255\n", "the size or the maximum value in its header is not valid: 99999 x 99999, 255"),
        (b"P2\n2 1\n255\n1 x", "its pixels are not numbers"),
        (b"no image", "cannot be read"),
        (b"", "cannot be read"),
    ],
)
def test_malformed_images_are_reported(tmp_path: Path, data: bytes, reason: str) -> None:
    path = tmp_path / "a.pgm"
    path.write_bytes(data)
    with pytest.raises(LinkwrightError, match=reason) as error:
        read_image(path)
    assert error.value.diagnostics[0].code == "NAV203"


@pytest.mark.parametrize(
    "data",
    [
        b"P5\n# by a painter\n3 1\n255\n\x00\x7f\xff",
        b"P2 3 1 255 0 127 255",
        b"P5 3 1 65535\n\x00\x00\x7f\x7f\xff\xff",
    ],
)
def test_all_pgm_variants_are_read(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "a.pgm"
    path.write_bytes(data)
    assert np.round(read_image(path).shade * 255.0).tolist() == [[0, 127, 255]]


@pytest.mark.parametrize(
    ("occupied", "free", "message"),
    [(1.5, 0.2, "1.0 or less"), (0.5, -0.1, "0.0 or greater"), (0.2, 0.3, "smaller than threshold_occupied")],
)
def test_invalid_thresholds_are_rejected(tmp_path: Path, occupied: float, free: float, message: str) -> None:
    save_settings = MapSaveSettings(name=str(tmp_path / "a"), occupied_thresh=occupied, free_thresh=free)
    with pytest.raises(LinkwrightError, match=message):
        save_map(Grid(cells=np.zeros((1, 1), np.int8), resolution=0.05), save_settings)


def test_missing_folder_is_reported(tmp_path: Path) -> None:
    save_settings = MapSaveSettings(name=str(tmp_path / "no" / "a"))
    with pytest.raises(LinkwrightError) as error:
        save_map(Grid(cells=np.zeros((1, 1), np.int8), resolution=0.05), save_settings)
    assert error.value.diagnostics[0].code == "NAV206"
