"""Worlds with too many links are rejected."""

import pytest

from linkwright.cli import main
from linkwright.sdf.link_counts import has_more_links

MAX_COUNT = 1000
LINK = '<model name="m"><link name="l"/></model>'


def world_text(elements: str, prologue: str = "") -> str:
    return f'<?xml version="1.0"?>{prologue}<sdf version="1.7"><world name="w">{elements}</world></sdf>'


@pytest.mark.parametrize(
    "elements",
    [LINK * (MAX_COUNT + 1), "<include><uri>model://m</uri></include>" * MAX_COUNT + LINK],
    ids=["links", "includes"],
)
def test_links_and_includes_are_counted(elements):
    assert has_more_links(world_text(elements), MAX_COUNT)
    assert has_more_links(world_text(elements).encode(), MAX_COUNT)


@pytest.mark.parametrize(
    "text",
    [
        world_text(LINK * MAX_COUNT),
        world_text(f"<state>{LINK * (MAX_COUNT + 1)}</state>"),
        world_text(
            f'<plugin name="p" filename="f">{"<link>" * 9}{"<link/>" * (MAX_COUNT * 3)}{"</link>" * 9}</plugin>'
        ),
        world_text(LINK) + world_text(LINK * (MAX_COUNT + 1)),
        world_text(LINK * (MAX_COUNT + 1), '<!DOCTYPE sdf [<!ENTITY a "b">]>'),
        world_text("<link <" + LINK * (MAX_COUNT + 1)),
        "x" * (MAX_COUNT * 20),
    ],
    ids=["as many as there may be", "state", "plugin", "second", "entities", "no XML", "text"],
)
def test_other_text_is_not_counted(text):
    assert not has_more_links(text, MAX_COUNT)
    assert not has_more_links(text.encode(), MAX_COUNT)


def test_unknown_encoding_is_not_counted():
    text = world_text(LINK * (MAX_COUNT + 1)).replace('"1.0"', '"1.0" encoding="nothing"')
    assert not has_more_links(text.encode(), MAX_COUNT)


def test_world_with_too_many_links_is_rejected_with_one_error(tmp_path, capsys):
    path = tmp_path / "crowd.world"
    path.write_text(world_text(LINK * 100_001))
    assert main(["world", "check", str(path)]) == 1
    output = capsys.readouterr().err
    assert output.count("error[") == 1
    assert "is not read: it has more than 100000 links" in output
