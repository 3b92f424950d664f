"""The YAML files of maps.

All of nav2's keys are read, and mistakes are reported with their position.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.navigation.maps.map_yaml import MapMode, read_map_yaml

_VALID_YAML = """image: house.pgm
mode: trinary
resolution: 0.05
origin: [-1.5, 2, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


def _write_map_yaml(folder: Path, text: str) -> Path:
    path = folder / "house.yaml"
    path.write_text(text)
    return path


def test_map_yaml_is_read(tmp_path: Path) -> None:
    result = read_map_yaml(_write_map_yaml(tmp_path, _VALID_YAML))
    assert result.image == tmp_path / "house.pgm"
    assert (result.resolution, result.origin, result.negate) == (0.05, (-1.5, 2.0, 0.0), False)
    assert (result.occupied_thresh, result.free_thresh, result.mode) == (0.65, 0.196, MapMode.TRINARY)


@pytest.mark.parametrize(("text", "value"), [("1", True), ("true", True), ("false", False), ("No", False), ("2", True)])
def test_negate_accepts_numbers_and_booleans(tmp_path: Path, text: str, value: bool) -> None:
    assert read_map_yaml(_write_map_yaml(tmp_path, _VALID_YAML.replace("negate: 0", f"negate: {text}"))).negate is value


def test_mode_defaults_to_trinary_and_other_keys_are_ignored(tmp_path: Path) -> None:
    text = _VALID_YAML.replace("mode: trinary", "comment: {who: me}").replace("house.pgm", "/maps/house.png")
    settings = read_map_yaml(_write_map_yaml(tmp_path, text))
    assert settings.mode is MapMode.TRINARY
    assert settings.image == Path("/maps/house.png")


@pytest.mark.parametrize(
    ("old", "new", "line", "column", "message"),
    [
        ("negate: 0\n", "", 1, 1, "'negate' is missing in the map"),
        ("image: house.pgm", "image:", 1, 7, "'image' must be a file name"),
        ("0.05", "five", 3, 13, "'resolution' must be a number"),
        ("0.05", "0", 3, 13, "'resolution' must be more than 0 (meters per pixel)"),
        ("0.05", ".inf", 3, 13, "'resolution' must be a number"),
        ("[-1.5, 2, 0]", "[-1.5, 2]", 4, 9, "'origin' must have 3 values (x, y, yaw), but has 2"),
        ("[-1.5, 2, 0]", "[-1.5, up, 0]", 4, 16, "'origin' must be a number"),
        ("[-1.5, 2, 0]", "0", 4, 9, "'origin' must be a list of x, y and yaw"),
        ("negate: 0", "negate: maybe", 5, 9, "'negate' must be 0 or 1"),
        ("0.65", "65", 6, 18, "'occupied_thresh' must be between 0 and 1"),
        ("mode: trinary", "mode: trinity", 2, 7, "'mode' must be one of trinary, scale, raw"),
    ],
)
def test_mistakes_are_reported_with_location(
    tmp_path: Path, old: str, new: str, line: int, column: int, message: str
) -> None:
    with pytest.raises(LinkwrightError) as error:
        read_map_yaml(_write_map_yaml(tmp_path, _VALID_YAML.replace(old, new)))
    finding = error.value.diagnostics[0]
    assert finding.code == "NAV202"
    assert str(finding.message).startswith(message)
    assert finding.span is not None
    assert (finding.span.line, finding.span.column) == (line, column)


def test_malformed_yaml_is_reported_with_location(tmp_path: Path) -> None:
    with pytest.raises(LinkwrightError, match="not valid YAML") as error:
        read_map_yaml(_write_map_yaml(tmp_path, _VALID_YAML.replace("trinary", "[")))
    assert error.value.diagnostics[0].span is not None


@pytest.mark.parametrize("text", ["", "- a\n- b\n", "just words", "[" * 200])
def test_yaml_that_is_not_a_map_is_rejected(tmp_path: Path, text: str) -> None:
    with pytest.raises(LinkwrightError) as error:
        read_map_yaml(_write_map_yaml(tmp_path, text))
    assert error.value.diagnostics[0].code == "NAV202"


def test_missing_file_error_suggests_files_in_folder(tmp_path: Path) -> None:
    _write_map_yaml(tmp_path, _VALID_YAML)
    with pytest.raises(LinkwrightError) as error:
        read_map_yaml(tmp_path / "hose.yaml")
    finding = error.value.diagnostics[0]
    assert finding.code == "NAV201"
    assert "house.yaml" in str(finding.hint)
