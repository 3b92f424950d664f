"""A description with missing values of arguments."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.hosting.argument_form import create_argument_form
from linkwright.hosting.xacro_calls import DescriptionError, Descriptions, XacroCall
from linkwright.packages import PackageFinder

_PACKAGE = (
    "<package format='3'><name>box_description</name><version>1.0.0</version><description>d</description>"
    "<maintainer email='a@b.c'>a</maintainer><license>MIT</license></package>"
)
_ROBOT = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="box">
  <xacro:property name="size" value="${dict(small=0.2, large=0.6)['$(arg model)']}"/>
  <link name="body"><visual><geometry><box size="${size} ${size} ${size}"/></geometry></visual></link>
</robot>
"""
_LAUNCH = """import xacro
from ament_index_python.packages import get_package_share_directory
path = get_package_share_directory('box_description') + '/urdf/box.xacro'
xacro.process_file(path, mappings={{'model': '{model}'}})
"""


@pytest.fixture
def box_file(tmp_path: Path) -> Path:
    """Write a description with an argument, and launch files that set three values."""
    package = tmp_path / "box_description"
    for folder in ("urdf", "launch"):
        (package / folder).mkdir(parents=True)
    (package / "package.xml").write_text(_PACKAGE)
    for model in ("small", "large", "none"):
        (package / "launch" / f"{model}.launch.py").write_text(_LAUNCH.format(model=model))
    path = package / "urdf" / "box.xacro"
    path.write_text(_ROBOT)
    return path


def read_form(path: Path, **arguments: str):
    finder = PackageFinder(start=[path.parent], environment={})
    call = XacroCall(path, tuple(arguments.items()))
    with pytest.raises(DescriptionError) as caught:
        Descriptions(finder).read(call)
    return create_argument_form(call, finder, caught.value.diagnostics)


def test_argument_form_offers_values_of_launch_files(box_file: Path) -> None:
    form = read_form(box_file)
    assert form is not None
    assert (form.file, form.names) == ("box.xacro", ["model"])
    assert sorted((choice.label, choice.values["model"]) for choice in form.choices) == [
        ("model:=large", "large"),
        ("model:=small", "small"),
    ]
    assert form.values == form.choices[0].values


def test_argument_form_is_shown_again_after_invalid_value(box_file: Path) -> None:
    form = read_form(box_file, model="huge")
    assert form is not None
    assert {choice.values["model"] for choice in form.choices} == {"small", "large"}


def test_argument_without_known_value_is_requested_empty(tmp_path: Path) -> None:
    path = tmp_path / "a.xacro"
    path.write_text(_ROBOT)
    form = read_form(path)
    assert form is not None
    assert (form.names, form.values, form.choices) == (["model"], {}, [])


def test_malformed_file_shows_no_argument_form(box_file: Path) -> None:
    box_file.write_text(_ROBOT.replace("</robot>", ""))
    assert read_form(box_file) is None
