"""Whole robots: no rule fails, and correct robots have no findings."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import Severity
from linkwright.lint import Checked, Finding, Settings, examine
from tests.corpora import CORPORA, MODELS, Corpus, Model


def check_model(model: Model, settings: Settings) -> Checked:
    return examine(model.path, arguments=model.arguments, packages=model.packages, settings=settings)


@pytest.mark.parametrize("model", MODELS, ids=str)
def test_corpus_robots_have_no_joint_or_structure_errors(model: Model) -> None:
    checked = check_model(model, Settings(select=("ALL",)))
    findings = [diagnostic for diagnostic in checked.diagnostics if isinstance(diagnostic, Finding)]
    assert all(finding.span is not None for finding in findings if finding.element is not None)
    on_joints_and_structure = [finding for finding in findings if finding.code.startswith(("LW1", "LW2"))]
    assert not [finding for finding in on_joints_and_structure if finding.severity is Severity.ERROR]


@pytest.mark.parametrize("corpus", CORPORA, ids=lambda corpus: corpus.folder.name)
def test_corpus_robots_have_few_joint_and_structure_findings(corpus: Corpus) -> None:
    codes = {
        (diagnostic.code, diagnostic.span)
        for model in corpus.models
        for diagnostic in check_model(model, Settings()).diagnostics
        if diagnostic.code.startswith(("LW1", "LW2"))
    }
    assert len(codes) < 20
