"""A voice_commander and its engine."""

from __future__ import annotations

import pytest

from tests.nodes.conftest import clock, graph, harness, log, logged  # noqa: F401  # fixtures
from tests.speech.nodes.fakes import ENGINE_ENTRY, CommanderHarness, ScriptedEngine


@pytest.fixture
async def start_commander(harness):  # noqa: F811
    """Return a function that starts a voice_commander, which ends with the test."""
    harnesses = []

    def start(**parameters):
        harnesses.append(CommanderHarness(harness, **parameters))
        return harnesses[-1]

    yield start
    for robot in harnesses:
        robot.commander.close()
    await harness.graph.settle()


@pytest.fixture
def engine(monkeypatch):
    monkeypatch.setattr("linkwright.speech.engine.extensions", lambda group: {"told": ENGINE_ENTRY})
    ScriptedEngine.used_options.clear()
    ScriptedEngine.finished.clear()
    ScriptedEngine.results_at_end.clear()
    ScriptedEngine.problems.clear()
    return ScriptedEngine
