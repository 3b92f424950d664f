"""The recipe for conda-forge matches pyproject.toml."""

from __future__ import annotations

import re
from typing import Any

import pytest
import yaml
from packaging.requirements import Requirement

from linkwright.cli import main
from tests.places import REPOSITORY
from tests.toml_files import ENGINE, PROJECT, PYPROJECT


@pytest.fixture(scope="module")
def recipe() -> dict[str, Any]:
    found: dict[str, Any] = yaml.safe_load(
        (REPOSITORY / "packaging" / "conda" / "recipe.yaml").read_text(encoding="utf-8")
    )
    return found


def bounds(requirements: list[str]) -> dict[str, str]:
    """Return the versions that requirements allow, by name, and without markers."""
    parsed = [Requirement(requirement) for requirement in requirements]
    return {requirement.name: str(requirement.specifier) for requirement in parsed}


def test_recipe_run_requirements_match_pyproject(recipe):
    interpreter, *needed = recipe["requirements"]["run"]
    dependencies = [*ENGINE["dependencies"], *PROJECT["dependencies"]]
    assert bounds(needed) == bounds([name for name in dependencies if not name.startswith(ENGINE["name"])])
    assert interpreter == "python >=${{ python_min }}"
    assert PROJECT["requires-python"] == f">={recipe['context']['python_min']}"


def test_recipe_host_requirements_match_build_requirements(recipe, monkeypatch):
    pinned, installer, *needed = recipe["requirements"]["host"]
    assert (pinned, installer) == ("python ${{ python_min }}.*", "pip")
    hook = (REPOSITORY / "hatch_build.py").read_text(encoding="utf-8")
    hook_requirements = re.findall(r'"([a-z]+>=[\d.]+)"', hook.partition("*([]")[0])
    assert (
        len(hook_requirements) == 2
    )  # for the stubs and the catalogs; the source distribution contains the built page
    assert bounds(needed) == bounds([*PYPROJECT["build-system"]["requires"], *hook_requirements])


def test_recipe_metadata_matches_pyproject(recipe):
    version = (REPOSITORY / "src" / "linkwright" / "_version.py").read_text(encoding="utf-8")
    assert f'__version__ = "{recipe["context"]["version"]}"' in version
    assert recipe["about"]["summary"] == PROJECT["description"]
    assert recipe["about"]["license"] == PROJECT["license"]
    scripts = [f"{name} = {target}" for name, target in PROJECT["scripts"].items()]
    assert recipe["build"]["python"]["entry_points"] == scripts


def test_recipe_test_commands_succeed(recipe, tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    (script,) = [test["script"] for test in recipe["tests"] if "script" in test]
    for line in script:
        program, *words = line.split()
        assert program == "linkwright"
        assert main(words) == 0, capfd.readouterr().err
