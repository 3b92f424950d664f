"""The example scenario of the page about sweeps."""

from __future__ import annotations

import pytest

from linkwright.sweep.execution import run_once
from linkwright.sweep.plan import plan_runs
from linkwright.sweep.scenario import load_scenario
from tests.docs.pages import read_blocks
from tests.places import REPOSITORY


@pytest.mark.parametrize("page", ["docs/sweeps.md", "docs/zh/sweeps.md"])
def test_sweep_scenario_runs_and_friction_decides_arrival(page, tmp_path):
    (block,) = (block for block in read_blocks(REPOSITORY / page) if block.title)
    path = tmp_path / block.title
    path.write_text(block.text, encoding="utf-8")
    scenario = load_scenario(path)
    runs = plan_runs(scenario)
    assert len(runs) == 10
    slippery, rough = run_once(scenario, runs[0]), run_once(scenario, runs[-1])
    assert not slippery.error
    assert not rough.error
    assert (slippery.results["arrived"], rough.results["arrived"]) == (False, True)
