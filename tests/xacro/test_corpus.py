"""Whole robots: the expansions are identical to the expansions by ros/xacro."""

from __future__ import annotations

import pytest

from linkwright.xacro import expand
from tests.corpora import MODELS, Model


@pytest.mark.parametrize("model", MODELS, ids=str)
def test_expansion_matches_ros_xacro(model: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(model.corpus.robots)
    expansion = expand(model.path, model.arguments, packages=model.packages)
    assert model.marked(str(expansion)) == model.expected
    for element in expansion.document.root.elements():
        assert element.source is not None
        assert element.source.text[element.offset] == "<"
