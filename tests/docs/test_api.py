"""The examples of the API page."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from linkwright.bag.writing import BagWriter
from linkwright.messages import String, serialize
from tests.docs.pages import read_blocks
from tests.places import REPOSITORY

PAGE = REPOSITORY / "docs" / "api.md"


def test_api_examples_run_in_order(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    with BagWriter(tmp_path / "drive.mcap", single_file=True) as writer:
        writer.add_topic("/chatter", "std_msgs/msg/String")
        writer.write("/chatter", 1, serialize(String(data="hello")))
    names: dict[str, object] = {}
    ran = 0
    for block in read_blocks(PAGE):
        if block.title:
            (tmp_path / block.title).write_text(block.text, encoding="utf-8")
        elif block.language == "python":
            exec(compile(block.text, str(PAGE), "exec"), names)
            ran += 1
    assert ran >= 6
    output = capsys.readouterr().out
    assert "/chatter std_msgs/msg/String 1" in output
    assert (tmp_path / "balls" / "annotations").is_dir()
    assert "arm.xacro:3:3" in output
    assert "length 0.4" in output
    assert "base_link revolute (0.0, 0.0, 0.2)" in output
    assert "root Link: base_link has 1 child(ren)" in output
    assert re.search(r"^5\.0+$|^5\.0000\d*$|^4\.99999\d*$", output, re.MULTILINE), "the mass of 5 liters of water"
    assert "position:\n- 0.3\n" in output
    assert "RIHS01_\nhello\n" in output
    assert "7200 3600.0 s" in output
    assert "120 True" in output
    assert "error[URDF" in output
    assert len(names["many"]) == 1000  # type: ignore[arg-type]
