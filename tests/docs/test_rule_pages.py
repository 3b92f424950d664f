"""The generated pages of the rules are current; every rule has a Chinese title."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.lint.registry import all_rules
from tests.repository_tools import load_tool


def test_rule_pages_are_current() -> None:
    for path, text in load_tool("rule_reference").generate().items():
        assert path.read_text(encoding="utf-8") == text, "run tools/rule_reference.py"


def test_rules_have_chinese_titles() -> None:
    titles = load_tool("rule_reference").read_chinese_titles()
    assert set(titles) == {rule.code for rule in all_rules()}
    assert all(titles.values())


def test_rules_are_on_exactly_one_page() -> None:
    tool = load_tool("rule_reference")
    all_pages = "".join(tool.generate().values())
    for rule in all_rules():
        assert all_pages.count(f"{{#{rule.code.lower()}}}") == 1
        assert all(f"`{option.name}` (default" in all_pages for option in rule.options)


def test_stale_rule_page_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tool = load_tool("rule_reference")
    monkeypatch.setattr(tool, "DOCS", tmp_path)
    monkeypatch.setattr(tool, "ROOT", tmp_path)
    monkeypatch.setattr("sys.argv", ["rule_reference.py", "--check"])
    assert tool.main() == 1
    monkeypatch.setattr("sys.argv", ["rule_reference.py"])
    assert tool.main() == 0
    monkeypatch.setattr("sys.argv", ["rule_reference.py", "--check"])
    assert tool.main() == 0
