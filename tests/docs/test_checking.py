"""The examples of the page about checking."""

from __future__ import annotations

import json

import pytest

from linkwright.cli import main
from linkwright.diagnostics import Diagnostic, SourceText
from linkwright.diagnostics.render import to_data
from linkwright.lint.configuration import read_settings
from tests.docs.pages import DOCS, read_blocks

PAGES = [DOCS / "checking.md", DOCS / "zh" / "checking.md"]


def block_with_title(page, title):
    return next(block.text for block in read_blocks(page) if block.title == title)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.parent.name)
def test_shown_settings_are_valid(page, tmp_path):
    file = tmp_path / "linkwright.toml"
    file.write_text(block_with_title(page, "linkwright.toml"), encoding="utf-8")
    settings, found = read_settings(file)
    assert found == ()
    assert settings.ignore
    assert settings.options


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.parent.name)
def test_shown_suppressions_work_and_are_needed(page, tmp_path, capsys):
    file = tmp_path / "robot.urdf"
    text = block_with_title(page, "robot.urdf")
    file.write_text(text, encoding="utf-8")
    arguments = ["check", str(file), "--strict", "--format", "concise", "--select", "LW001,LW221"]
    assert main(arguments) == 1
    output = capsys.readouterr().out
    assert "LW221" not in output
    assert output.count("LW001") == 1
    assert "'LW6'" in output
    file.write_text(text.replace("ignore", "look at"), encoding="utf-8")
    main(arguments)
    assert capsys.readouterr().out.count("LW221") == 2


def test_shown_json_has_current_fields():
    documented = json.loads(next(block.text for block in read_blocks(PAGES[0]) if block.language == "json"))
    current = to_data(Diagnostic("LW221", "m", SourceText("f", "x").span(0, 1), hint="h"))
    assert list(documented["diagnostics"][0]) == list(current)
