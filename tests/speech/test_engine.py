"""Speech engines by name."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.loading import extensions
from linkwright.speech.engine import EngineOptions, SpeechEngine, make_engine


class Deaf(SpeechEngine):
    def __init__(self, options: EngineOptions) -> None:
        self.options = options

    def hear(self, samples):
        return []

    def finish(self):
        return []


@pytest.fixture(autouse=True)
def installed(monkeypatch):
    entry = extensions.EntryPoint("deaf", f"{__name__}:Deaf", "tests")
    monkeypatch.setattr("linkwright.speech.engine.extensions", lambda group: {"deaf": entry})


def test_engine_is_created_with_options():
    options = EngineOptions(("forward", "stop"), "en")
    engine = make_engine("deaf", options)
    assert isinstance(engine, SpeechEngine)
    assert engine.options is options


def test_unknown_engine_is_rejected_with_suggestion():
    with pytest.raises(LinkwrightError) as error:
        make_engine("daef", EngineOptions(("stop",)))
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "VOICE101"
    assert "'daef'" in str(diagnostic.message)
    assert "'deaf'" in str(diagnostic.hint)
