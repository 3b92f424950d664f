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
    """What a text says, which must be right."""
    document, warnings = parse_as_gazebo(text, "w.sdf")
    reading = read(document)
    assert (*warnings, *reading.diagnostics) == ()
    assert reading.sdf is not None
    return reading.sdf


def model(inside: str, attributes: str = "") -> Model:
    """The model ``m`` with something in it."""
    return read_sdf(f'<sdf version="1.9"><model name="m" {attributes}>{inside}</model></sdf>').models[0]


def world(inside: str) -> World:
    """The world ``w`` with something in it, includes not resolved."""
    return read_sdf(f'<sdf version="1.9"><world name="w">{inside}</world></sdf>').worlds[0]


def write(folder: Path, files: Mapping[str, str]) -> None:
    """Files below a folder, by their paths."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def examined(folder: Path, inside: str, **environment: str) -> WorldDescription:
    """A world in a folder that includes what the folder holds; home is the folder too."""
    path = folder / "w.world"
    path.write_text(f'<sdf version="1.9"><world name="w">{inside}</world></sdf>', encoding="utf-8")
    return examine_world(path, environment={"HOME": str(folder), **environment})
