"""Worlds with too many links are refused."""

import pytest

from linkwright.cli import main
from linkwright.sdf.link_counts import has_more_links

MOST = 1000
LINK = '<model name="m"><link name="l"/></model>'


def world(inside: str, before: str = "") -> str:
    return f'<?xml version="1.0"?>{before}<sdf version="1.7"><world name="w">{inside}</world></sdf>'


@pytest.mark.parametrize(
    "inside",
    [LINK * (MOST + 1), "<include><uri>model://m</uri></include>" * MOST + LINK],
    ids=["links", "includes"],
)
def test_links_and_includes_are_counted(inside):
    assert has_more_links(world(inside), MOST)
    assert has_more_links(world(inside).encode(), MOST)


@pytest.mark.parametrize(
    "text",
    [
        world(LINK * MOST),
        world(f"<state>{LINK * (MOST + 1)}</state>"),
        world(f'<plugin name="p" filename="f">{"<link>" * 9}{"<link/>" * (MOST * 3)}{"</link>" * 9}</plugin>'),
        world(LINK) + world(LINK * (MOST + 1)),
        world(LINK * (MOST + 1), '<!DOCTYPE sdf [<!ENTITY a "b">]>'),
        world("<link <" + LINK * (MOST + 1)),
        "x" * (MOST * 20),
    ],
    ids=["as many as there may be", "state", "plugin", "second", "entities", "no XML", "text"],
)
def test_other_text_is_not_counted(text):
    assert not has_more_links(text, MOST)
    assert not has_more_links(text.encode(), MOST)


def test_unknown_encoding_is_not_counted():
    text = world(LINK * (MOST + 1)).replace('"1.0"', '"1.0" encoding="nothing"')
    assert not has_more_links(text.encode(), MOST)


def test_world_with_too_many_links_is_rejected_with_one_error(tmp_path, capsys):
    path = tmp_path / "crowd.world"
    path.write_text(world(LINK * 100_001))
    assert main(["world", "check", str(path)]) == 1
    output = capsys.readouterr().err
    assert output.count("error[") == 1
    assert "is not read: it has more than 100000 links" in output
