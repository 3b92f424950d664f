"""Findings about realistic mistakes.

The tests cover the position to the column, the wording, and a hint with the fix.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from .cases import Case, read_cases

CASES = {
    f"{path.stem}: {case.title}": case
    for path in sorted(Path(__file__).parent.glob("*.md"))
    for case in read_cases(path)
}


def test_corpus_has_at_least_fifty_mistakes() -> None:
    assert len(CASES) >= 50


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_mistake_gives_expected_findings(case: Case, tmp_path: Path) -> None:
    assert case.check(tmp_path) == case.expected


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_expected_findings_have_location_and_hint(case: Case) -> None:
    first, *notes_and_hint = case.expected.splitlines()
    if not case.arguments:  # a mistake on the command line has no location in a file
        assert ":" in first.split()[0], "the finding has no location"
        assert "[]" not in first, "the finding marks no text"
    assert any(line.startswith("  hint: ") for line in notes_and_hint), "the finding has no hint"
