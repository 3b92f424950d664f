"""Load and save maps as a YAML file with an image, as in nav2_map_server."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import floor, log10
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, display_path, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.maps.images import encode_pgm, encode_with_pillow, read_image
from linkwright.navigation.maps.map_yaml import MapMode, read_map_yaml
from linkwright.navigation.maps.pixels import UNKNOWN_DARKNESS, cells_of_image, pixels_of_cells

OCCUPIED_THRESH = 0.65
FREE_THRESH = 0.25
"""The default thresholds of nav2's map saver."""
_IMAGE_FORMATS = ("bmp", "pgm", "png")
_FORMATS_WITHOUT_OPACITY = ("pgm", "jpg", "jpeg", "bmp")


def _ignore_warning(_line: str) -> None:
    """Ignore a warning."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MapSaveSettings:
    """The settings for saving a map.

    Attributes:
        name: the path of the files, without an extension.
        occupied_thresh: cells with at least this probability are occupied, 0 to 1.
        free_thresh: cells with at most this probability are free.
        image_format: the extension of the image; "" for the default of the mode.
        mode: the meaning of the pixels.
    """

    name: str
    occupied_thresh: float = OCCUPIED_THRESH
    free_thresh: float = FREE_THRESH
    image_format: str = ""
    mode: MapMode = MapMode.TRINARY


def load_map(path: str | Path) -> Grid:
    """Load a map from its YAML file and image, as a grid in the frame of the map.

    Raises:
        LinkwrightError: NAV201 or NAV202, see `read_map_yaml`; NAV203 or NAV204, see `read_image`.
    """
    map_yaml = read_map_yaml(path)
    cells = cells_of_image(read_image(map_yaml.image), map_yaml)
    x, y, yaw = map_yaml.origin
    return Grid(cells=cells, resolution=map_yaml.resolution, x=x, y=y, yaw=yaw)


def save_map(
    grid: Grid, settings: MapSaveSettings, warn: Callable[[str], object] = _ignore_warning
) -> tuple[Path, Path]:
    """Save a grid as a map.

    Args:
        grid: the grid; its cells are percent or unknown.
        settings: the name of the files and the settings.
        warn: called with each warning for the user.

    Returns:
        The paths of the image and the YAML file.

    Raises:
        LinkwrightError: NAV205, the thresholds are invalid; NAV206, a file cannot be written; NAV204, Pillow is needed
            and not installed.
    """
    _check_thresholds(settings)
    extension = (settings.image_format or ("png" if settings.mode is MapMode.SCALE else "pgm")).lower()
    if extension not in _IMAGE_FORMATS:
        hint = did_you_mean(extension, _IMAGE_FORMATS)
        warn(
            f"Requested image format '{extension}' is not one of the recommended formats: 'bmp', 'pgm', 'png'"
            + (f"; {hint}" if hint else "")
        )
    if settings.mode is MapMode.SCALE and extension in _FORMATS_WITHOUT_OPACITY:
        warn(
            f"Map mode 'scale' requires transparency, but format '{extension}' does not support it. "
            "Consider switching image format to 'png'."
        )
    if settings.mode is MapMode.TRINARY and settings.free_thresh > UNKNOWN_DARKNESS and bool((grid.cells < 0).any()):
        warn(
            f"Unknown cells are read back as free with a free threshold of {settings.free_thresh:g}, in nav2 as here. "
            "With 0.196 they stay unknown."
        )
    pixels = pixels_of_cells(grid.cells, settings.mode, settings.occupied_thresh, settings.free_thresh)
    if extension in _FORMATS_WITHOUT_OPACITY and pixels.ndim == 3:
        pixels = pixels[..., 0]
    try:
        data = encode_pgm(pixels) if extension == "pgm" else encode_with_pillow(pixels, extension)
    except ValueError as error:
        warn(f"Format '{extension}' is not usable. Using 'png' instead: {error}")
        extension, data = "png", encode_with_pillow(pixels, "png")
    image_path, yaml_path = Path(f"{settings.name}.{extension}"), Path(f"{settings.name}.yaml")
    _write_file(image_path, data)
    _write_file(yaml_path, _format_yaml(grid, settings, image_path.name).encode())
    return image_path, yaml_path


def _check_thresholds(settings: MapSaveSettings) -> None:
    problem = None
    if settings.occupied_thresh > 1.0:
        problem = phrase("Threshold_occupied must be 1.0 or less")
    elif settings.free_thresh < 0.0:
        problem = phrase("Free threshold must be 0.0 or greater")
    elif settings.occupied_thresh <= settings.free_thresh:
        problem = phrase("Threshold_free must be smaller than threshold_occupied")
    if problem is not None:
        raise LinkwrightError(Diagnostic("NAV205", problem))


def _write_file(path: Path, data: bytes) -> None:
    try:
        write_whole_file(path, data)
    except OSError as error:
        reason = foreign(error.strerror or error)
        message = phrase("cannot write '{path}': {reason}", path=display_path(path), reason=reason)
        raise LinkwrightError(Diagnostic("NAV206", message)) from None


def _format_yaml(grid: Grid, settings: MapSaveSettings, image: str) -> str:
    origin = ", ".join(_format_number(number) for number in (grid.x, grid.y, grid.yaw))
    return (
        f"image: {image}\nmode: {settings.mode.value}\nresolution: "
        f"{_format_number(grid.resolution)}\norigin: [{origin}]\n"
        f"negate: 0\noccupied_thresh: {_format_number(settings.occupied_thresh)}\nfree_thresh: "
        f"{_format_number(settings.free_thresh)}"
    )


def _format_number(value: float) -> str:
    """Format a number with nav2's three significant digits, or more to keep millimeters."""
    digits = 3 if value == 0.0 else max(3, floor(log10(abs(value))) + 4)
    return f"{value:.{digits}g}"
