"""A voice_commander and its engine."""

from __future__ import annotations

import pytest

from tests.nodes.conftest import clock, graph, log, logged, stage  # noqa: F401  # fixtures
from tests.speech.nodes.fakes import ENTRY, Talk, ToldEngine


@pytest.fixture
async def talk(stage):  # noqa: F811
    """Starts a voice_commander; it ends with the test."""
    started = []

    def start(**parameters):
        started.append(Talk(stage, **parameters))
        return started[-1]

    yield start
    for robot in started:
        robot.running.close()
    await stage.graph.settle()


@pytest.fixture
def engine(monkeypatch):
    monkeypatch.setattr("linkwright.speech.engine.extensions", lambda group: {"told": ENTRY})
    ToldEngine.used_options.clear()
    ToldEngine.finished.clear()
    ToldEngine.says_at_end.clear()
    ToldEngine.trouble.clear()
    return ToldEngine
