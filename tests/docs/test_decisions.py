"""Decision records: unique numbers, and a row in the table for each."""

from __future__ import annotations

import re

from tests.docs.pages import DOCS

DECISIONS = DOCS / "decisions"


def test_table_lists_decision_records_in_order() -> None:
    table = (DECISIONS / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \[(\d{4})\]\((.+?)\)", table, re.MULTILINE)
    assert [file for _, file in rows] == sorted(path.name for path in DECISIONS.glob("0*.md"))
    assert all(file.startswith(f"{number}-") for number, file in rows)


def test_decision_numbers_are_unique_and_consecutive() -> None:
    records = sorted(DECISIONS.glob("0*.md"))
    assert [int(path.name[:4]) for path in records] == list(range(1, len(records) + 1))
    assert all(path.read_text(encoding="utf-8").startswith(f"# {path.name[:4]}: ") for path in records)
