"""Launch files loaded with the functions of ``launch.launch_description_sources``."""

from __future__ import annotations

from pathlib import Path

import pytest
from launch.launch_description_sources import (
    get_launch_description_from_any_launch_file,
    get_launch_description_from_frontend_launch_file,
    get_launch_description_from_python_launch_file,
    load_python_launch_file_as_module,
)

from launch import InvalidLaunchFileError, LaunchDescription

PYTHON = """
from launch import LaunchDescription
from launch.actions import LogInfo

def generate_launch_description():
    return LaunchDescription([LogInfo(msg="of Python")])
"""
MARKUP = '<launch><let name="kind" value="markup"/></launch>'


@pytest.fixture(autouse=True)
def _launch_file_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def count_entities(description: LaunchDescription) -> int:
    return len(description.entities)


def test_python_file_is_loaded_as_module_or_description() -> None:
    Path("a.launch.py").write_text(PYTHON)
    assert count_entities(load_python_launch_file_as_module("a.launch.py").generate_launch_description()) == 1
    assert count_entities(get_launch_description_from_python_launch_file("a.launch.py")) == 1


def test_xml_file_is_loaded_as_description() -> None:
    Path("a.launch.xml").write_text(MARKUP)
    assert count_entities(get_launch_description_from_frontend_launch_file("a.launch.xml")) == 1


def test_custom_parser_is_used() -> None:
    description = LaunchDescription()

    class Parser:
        def load(self, path):
            return path, self

        def parse_description(self, entity):
            assert entity == "a.mine"
            return description

    assert get_launch_description_from_frontend_launch_file("a.mine", parser=Parser()) is description


@pytest.mark.parametrize(("name", "text"), [("a.py", PYTHON), ("a.xml", MARKUP), ("b.txt", PYTHON), ("c.py", MARKUP)])
def test_file_type_is_detected_by_name_or_content(name: str, text: str) -> None:
    Path(name).write_text(text)
    assert count_entities(get_launch_description_from_any_launch_file(name)) == 1


def test_file_of_unknown_type_is_rejected_with_both_reasons() -> None:
    Path("a.py").write_text("<launch")
    with pytest.raises(InvalidLaunchFileError, match="multiple exceptions"):
        get_launch_description_from_any_launch_file("a.py")
