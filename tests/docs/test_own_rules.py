"""The example rule of the page about users' rules."""

from __future__ import annotations

import runpy
import sys

import pytest

from linkwright.lint import check, registry
from linkwright.lint.explain import find_page
from linkwright.loading import extensions
from tests.docs.pages import DOCS, read_blocks
from tests.toml_files import read_toml

PAGES = (DOCS / "own-rules.md", DOCS / "zh" / "own-rules.md")


@pytest.fixture(params=PAGES, ids=["en", "zh"])
def installed_rule(request, tmp_path, monkeypatch):
    """Install the package of the page, and return its folder."""
    for block in read_blocks(request.param):
        if block.title:
            (tmp_path / block.title).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / block.title).write_text(block.text, encoding="utf-8")
    folder = tmp_path / "team_rules"
    facts = folder / "team_rules-1.0.dist-info"
    facts.mkdir()
    (facts / "METADATA").write_text("Metadata-Version: 2.1\nName: team-rules\nVersion: 1.0\n")
    points = read_toml((folder / "pyproject.toml").read_text())["project"]["entry-points"]["linkwright.lint_rules"]
    lines = ["[linkwright.lint_rules]", *(f"{name} = {value}" for name, value in points.items()), ""]
    (facts / "entry_points.txt").write_text("\n".join(lines))
    monkeypatch.syspath_prepend(str(folder))
    _forget()
    yield folder
    monkeypatch.undo()
    _forget()


def _forget() -> None:
    sys.modules.pop("team_rules", None)
    for function in (extensions._read_all_groups, registry._all_rules, registry._index_rules):
        function.cache_clear()


def test_shown_tests_pass(installed_rule, tmp_path):
    module = runpy.run_path(str(installed_rule / "test_team_rules.py"))
    tests = [value for name, value in module.items() if name.startswith("test_")]
    assert len(tests) == 2
    for number, test in enumerate(tests):
        (tmp_path / str(number)).mkdir()
        test(tmp_path / str(number))


def test_shown_finding_is_reported_only_in_package(installed_rule, tmp_path):
    assert [
        finding for finding in check('<robot name="crane"><link name="hook"/></robot>') if finding.code == "TEAM001"
    ] == []
    package = tmp_path / "crane_description"
    package.mkdir()
    (package / "package.xml").write_text("<package format='3'><name>crane_description</name></package>")
    (package / "crane.urdf").write_text('<robot name="crane"><link name="hook"/></robot>')
    (diagnostic,) = [finding for finding in check(package / "crane.urdf") if finding.code == "TEAM001"]
    text = next(block.text for block in read_blocks(PAGES[0]) if "TEAM001]" in block.text)
    assert diagnostic.message in text
    assert diagnostic.hint in text


def test_docstring_is_rule_page(installed_rule):
    assert "Two descriptions with the same link names" in str(find_page("link-without-prefix"))
