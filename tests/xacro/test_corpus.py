"""Real robots, where the corpus is beside the repository: the expansions are those of ros/xacro, byte for byte."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from linkwright.xacro import expand

CORPUS = Path(__file__).resolve().parents[3] / "shared" / "corpus"
MANIFEST: dict[str, Any] = (
    json.loads((CORPUS / "manifest.json").read_text(encoding="utf-8"))
    if CORPUS.is_dir()
    else {"models": [], "packages": {}}
)

pytestmark = pytest.mark.skipif(not CORPUS.is_dir(), reason="the corpus is not here")


@pytest.mark.parametrize("model", MANIFEST["models"], ids=lambda model: model["expected"].split("/")[-1])
def test_expands_as_ros_xacro_does(model: dict[str, Any]) -> None:
    packages = {name: str(CORPUS / folder) for name, folder in MANIFEST["packages"].items()}
    expansion = expand(str(CORPUS / "robots" / model["entry"]), model["args"], packages=packages)
    expected = (CORPUS / model["expected"]).read_text(encoding="utf-8")
    assert str(expansion).replace(str(CORPUS / "robots"), "@CORPUS@") == expected
    for element in expansion.document.root.elements():
        assert element.source is not None
        assert element.source.text[element.offset] == "<"
