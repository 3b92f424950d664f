"""Whole robots: no rule stumbles over them, and fine robots are left in peace."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import Severity
from linkwright.lint import Checked, Finding, Settings, examine
from tests.corpora import CORPORA, MODELS, Corpus, Model


def look(model: Model, settings: Settings) -> Checked:
    return examine(model.path, arguments=model.arguments, packages=model.packages, settings=settings)


@pytest.mark.parametrize("model", MODELS, ids=str)
def test_robots(model: Model) -> None:
    checked = look(model, Settings(select=("ALL",)))
    findings = [each for each in checked.diagnostics if isinstance(each, Finding)]
    assert all(each.span is not None for each in findings if each.element is not None)
    on_joints_and_structure = [each for each in findings if each.code.startswith(("LW1", "LW2"))]
    assert not [each for each in on_joints_and_structure if each.severity is Severity.ERROR]


@pytest.mark.parametrize("corpus", CORPORA, ids=lambda corpus: corpus.folder.name)
def test_default_rules_about_structure_and_joints_find_little_in_them(corpus: Corpus) -> None:
    found = {
        (each.code, each.span)
        for model in corpus.models
        for each in look(model, Settings()).diagnostics
        if each.code.startswith(("LW1", "LW2"))
    }
    assert len(found) < 20
