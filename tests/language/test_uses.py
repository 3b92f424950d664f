"""Uses of names in launch files and SRDF.

They are found in their file, and in the launch files that include it.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.language.uses import find_uses
from tests.language.formats import PARTS_XML, Place, make_packages


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return make_packages(tmp_path)


def uses(place: Place, **options) -> list[str]:
    """Return the uses, each as the file, the offset and the text."""
    uses = find_uses(place.document, place.format, place.offset, **options)
    return [f"{use.file.name}:{use.start}:{place.document.other(use.file)[use.start : use.end]}" for use in uses]


def test_argument_uses_are_found_in_its_file(folder):
    text = '<launch><arg name="gu|i"/><log message="gui $(var gui)"/><node name="gui"/></launch>'
    place = Place(folder / "launch" / "lamp.launch.xml", text)
    assert uses(place) == ["lamp.launch.xml:19:gui", "lamp.launch.xml:49:gui"]
    assert uses(place, in_file=True) == uses(place)
    place = Place(folder / "launch" / "a.launch.py", "DeclareLaunchArgument('a')\nb = LaunchConfiguration('|a')\n")
    assert uses(place) == ["a.launch.py:23:a", "a.launch.py:52:a"]


def test_argument_uses_are_found_in_including_files(folder):
    include = "$(find-pkg-share lamp_bringup)/launch/parts.launch.xml"
    text = f'<launch><include file="{include}"><arg name="rate" value="1"/></include></launch>'
    (folder / "launch" / "whole.launch.xml").write_text(text)
    (folder / "launch" / "other.launch.yaml").write_text(
        f"launch:\n- include:\n    file: {include}\n    arg:\n    - name: rate\n      value: 2\n"
    )
    place = Place(folder / "launch" / "parts.launch.xml", PARTS_XML.replace("rate", "ra|te"))
    assert [use.partition(":")[0] for use in uses(place)] == [
        "parts.launch.xml",
        "other.launch.yaml",
        "whole.launch.xml",
    ]


def test_srdf_group_uses_are_found(folder):
    text = '<robot name="lamp"><group name="a"/><group_state name="a" group="a|"/></robot>'
    assert len(uses(Place(folder / "config" / "lamp.srdf", text))) == 2
