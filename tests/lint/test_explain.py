"""Every code has an explanation: the docstring of a rule, or a section of a page."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import linkwright
from linkwright.lint.explain import find_page, find_similar_codes, known_codes, make_rule_page, read_room_pages
from linkwright.lint.registry import all_rules

ROOMS = Path(linkwright.__file__).parent
CODE_PATTERN = re.compile(
    r'"((?:XML|XAC|URDF|SDF|PKG|KIN|GRAPH|NODE|RVIZ|VIEW|LAUNCH|CLI|LINT|INR|MSG|DOC|DDS|BAG|SHELL|DRIVE|SIM|SWEEP|CTL|NAV|VOICE|VISION|MODEL|EDIT|LANG|LEARN|REV|PIC|ARM)[0-9]{3})"'
)


def find_reported_codes() -> set[str]:
    return {
        code
        for file in ROOMS.rglob("*.py")
        if "translation" not in file.parts
        for code in CODE_PATTERN.findall(file.read_text(encoding="utf-8"))
    }


def test_every_reported_code_has_page():
    assert find_reported_codes() - set(known_codes()) == set()


def test_every_page_belongs_to_reported_code():
    assert set(read_room_pages()) - find_reported_codes() == set()


def test_every_file_of_pages_begins_with_title():
    """Without a title, the documentation does not list the first code of the file."""
    for file in (ROOMS / "lint" / "pages").glob("*.md"):
        assert file.read_text(encoding="utf-8").startswith("# "), file.name


@pytest.mark.parametrize("rule", all_rules(), ids=lambda rule: rule.code)
def test_rule_page_has_title_why_example_and_use_instead(rule):
    page = make_rule_page(rule)
    assert page.title
    assert "\n" not in page.title
    headings = re.findall(r"^## (.+)$", page.text, re.MULTILINE)
    assert headings[:3] == ["Why", "Example", "Use instead"]
    assert all(f"`{option.name}`" in page.text for option in rule.options)


def test_page_is_found_by_code_and_name_in_any_case():
    assert find_page("lw201") == find_page("limit-inverted") == find_page("LW201")
    assert find_page("urdf110").title == "two elements of one kind have the same name"
    assert find_page("LW999") is None


def test_similar_codes_are_suggested():
    assert "limit-inverted" in find_similar_codes("limit-invertd")
    assert "URDF110" in find_similar_codes("URDF111")
