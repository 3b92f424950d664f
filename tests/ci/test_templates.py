"""The files for CI services have the form that the services ask for."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.ci.runner import TEMPLATES

ACTIONS = sorted(TEMPLATES.rglob("action.yml"))
_STEP_KEYS = {"name", "id", "if", "uses", "with", "run", "shell", "env"}


def load(path: Path) -> dict[str, Any]:
    return dict(yaml.safe_load(path.read_text(encoding="utf-8")))


@pytest.mark.parametrize("path", ACTIONS, ids=lambda path: path.parent.name)
def test_action_files_have_valid_structure(path: Path) -> None:
    action = load(path)
    assert (
        {"name", "description", "inputs", "runs"}
        <= action.keys()
        <= {"name", "description", "inputs", "outputs", "runs"}
    )
    assert action["runs"]["using"] == "composite"
    for declared in action["inputs"].values():
        assert declared.keys() == {"description", "default"}
        assert isinstance(declared["default"], str)
    for step in action["runs"]["steps"]:
        assert step.keys() <= _STEP_KEYS
        assert ("run" in step) != ("uses" in step)
        assert ("run" in step) == ("shell" in step)
    used_inputs = set(re.findall(r"inputs\.([\w-]+)", path.read_text(encoding="utf-8")))
    assert used_inputs == action["inputs"].keys()


@pytest.mark.parametrize("path", sorted(TEMPLATES.rglob("*.yml")), ids=lambda path: path.parent.name)
def test_scripts_contain_no_expressions(path: Path) -> None:
    """No expression is inserted into a script.

    It would be inserted before a shell reads the script, including any branch name.
    """
    definition = load(path)
    steps = definition["runs"]["steps"] if "runs" in definition else definition.values()
    for step in steps:
        assert "${{" not in str(step.get("run", step.get("script", "")))


@pytest.mark.parametrize("path", sorted(TEMPLATES.rglob("*.yml")), ids=lambda path: path.parent.name)
def test_python_runs_isolated_from_working_folder(path: Path) -> None:
    for line in re.findall(r".*python3?\"? .*", path.read_text(encoding="utf-8")):
        assert line.lstrip().startswith("#") or re.search(r'python3?"? -I ', line), line
