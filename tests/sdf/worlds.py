"""Worlds and models for tests."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from linkwright.descriptions import WorldDescription, examine_world
from linkwright.sdf.models import Model
from linkwright.sdf.reader import read
from linkwright.sdf.text import parse_as_gazebo
from linkwright.sdf.worlds import Sdf, World


def read_sdf(text: str) -> Sdf:
    """Return the content of a valid text."""
    document, warnings = parse_as_gazebo(text, "w.sdf")
    reading = read(document)
    assert (*warnings, *reading.diagnostics) == ()
    assert reading.sdf is not None
    return reading.sdf


def make_model_text(elements: str, attributes: str = "") -> Model:
    """Return the model ``m`` with these elements."""
    return read_sdf(f'<sdf version="1.9"><model name="m" {attributes}>{elements}</model></sdf>').models[0]


def make_world_text(elements: str) -> World:
    """Return the world ``w`` with these elements; includes are not resolved."""
    return read_sdf(f'<sdf version="1.9"><world name="w">{elements}</world></sdf>').worlds[0]


def write_files(folder: Path, files: Mapping[str, str]) -> None:
    """Write files below a folder, by their paths."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def examine_world_in(folder: Path, elements: str, **environment: str) -> WorldDescription:
    """Examine a world in a folder that includes files of the folder.

    The folder is also the home folder.
    """
    path = folder / "w.world"
    path.write_text(f'<sdf version="1.9"><world name="w">{elements}</world></sdf>', encoding="utf-8")
    return examine_world(path, environment={"HOME": str(folder), **environment})
