"""Real robots, where they are at hand: no rule stumbles over them, and fine robots are left in peace."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from linkwright.diagnostics import Severity
from linkwright.lint import Checked, Finding, Settings, examine
from tests.places import REPOSITORY

CORPUS = REPOSITORY.parent / "shared" / "corpus"
MANIFEST = CORPUS / "manifest.json"
CONTENT = json.loads(MANIFEST.read_text(encoding="utf-8")) if MANIFEST.exists() else {"models": [], "packages": {}}
PACKAGES = {name: CORPUS / folder for name, folder in CONTENT["packages"].items()}

pytestmark = pytest.mark.skipif(not CONTENT["models"], reason="the corpus of real robots is not here")


def look(model, settings: Settings) -> Checked:
    path: Path = CORPUS / "robots" / model["entry"]
    return examine(path, arguments=model["args"], packages=PACKAGES, settings=settings)


@pytest.mark.parametrize("model", CONTENT["models"], ids=lambda model: model["expected"].removeprefix("expected/"))
def test_real_robots(model):
    checked = look(model, Settings(select=("ALL",)))
    findings = [each for each in checked.diagnostics if isinstance(each, Finding)]
    assert all(each.span is not None for each in findings if each.element is not None)
    on_joints_and_structure = [each for each in findings if each.code.startswith(("LW1", "LW2"))]
    assert not [each for each in on_joints_and_structure if each.severity is Severity.ERROR]


def test_default_rules_about_structure_and_joints_find_little_in_them():
    found = {
        (each.code, each.span)
        for model in CONTENT["models"]
        for each in look(model, Settings()).diagnostics
        if each.code.startswith(("LW1", "LW2"))
    }
    assert len(found) < 20
