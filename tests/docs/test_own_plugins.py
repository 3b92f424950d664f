"""The example plugin of the page about users' simulation plugins."""

from __future__ import annotations

import runpy
import sys

import pytest

from linkwright.loading import extensions
from linkwright.messages import get_message
from linkwright.simulation.plugins import registry
from tests.docs.pages import DOCS, read_blocks
from tests.toml_files import read_toml

pytestmark = pytest.mark.extra("sim")

PAGES = (DOCS / "own-plugins.md", DOCS / "zh" / "own-plugins.md")


@pytest.fixture(params=PAGES, ids=["en", "zh"])
def installed_plugin(request, tmp_path, monkeypatch):
    """Install the package of the page, and return its folder."""
    for block in read_blocks(request.param):
        if block.title:
            (tmp_path / block.title).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / block.title).write_text(block.text, encoding="utf-8")
    folder = tmp_path / "my_wind"
    facts = folder / "my_wind-1.0.dist-info"
    facts.mkdir()
    points = read_toml((folder / "pyproject.toml").read_text())["project"]["entry-points"]
    lines = ["[linkwright.simulated_plugins]"]
    lines += [f"{name} = {value}" for name, value in points["linkwright.simulated_plugins"].items()]
    (facts / "entry_points.txt").write_text("\n".join([*lines, ""]))
    monkeypatch.syspath_prepend(str(folder))
    monkeypatch.chdir(tmp_path)
    _forget()
    yield folder
    monkeypatch.undo()
    _forget()


def _forget() -> None:
    sys.modules.pop("my_wind", None)
    extensions._read_all_groups.cache_clear()
    registry._load.cache_clear()


def test_both_languages_have_same_example():
    first, second = ({block.title: block.text for block in read_blocks(page) if block.title} for page in PAGES)
    assert first == second


def test_shown_test_passes(installed_plugin):
    runpy.run_path(str(installed_plugin / "test_my_wind.py"))["test_the_wind_moves_the_buoy"]()


def test_wind_follows_topic_and_is_restored_on_reset(installed_plugin):
    from linkwright.testing import SteppedSimulation

    with SteppedSimulation("empty", "buoy.sdf") as test:
        recording = test.record("/wind")
        test.advance(0.1)
        assert recording.last.vector.x == pytest.approx(4.0, abs=0.1)
        test.publish("/set_wind", get_message("geometry_msgs/msg/Vector3")(x=-4.0))
        test.advance(0.1)
        assert recording.last.vector.x == pytest.approx(-4.0, abs=0.1)
        test.reset()
        test.advance(0.1)
        assert recording.last.vector.x == pytest.approx(4.0, abs=0.1)
