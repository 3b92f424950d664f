"""Worlds with too many links."""

import pytest

import linkwright.simulation.server.worlds
from linkwright.diagnostics import LinkwrightError
from linkwright.simulation.scene.compiling import MAX_LINKS
from linkwright.simulation.server.worlds import load_world

LINK = '<model name="m"><link name="l"/></model>'


def world_text(elements: str, prologue: str = "") -> str:
    return f'<?xml version="1.0"?>{prologue}<sdf version="1.7"><world name="w">{elements}</world></sdf>'


@pytest.mark.parametrize(
    "elements",
    [LINK * (MAX_LINKS + 1), "<include><uri>model://m</uri></include>" * MAX_LINKS + LINK],
    ids=["links", "includes"],
)
def test_world_with_too_many_links_is_rejected_before_parsing(tmp_path, monkeypatch, elements):
    monkeypatch.delattr(linkwright.simulation.server.worlds, "examine_world")
    path = tmp_path / "crowd.world"
    path.write_text(world_text(elements))
    for text in (None, world_text(elements)):
        with pytest.raises(LinkwrightError) as error:
            load_world(str(path), text)
        (finding,) = error.value.diagnostics
        assert finding.code == "SIM105"
