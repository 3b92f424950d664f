"""The cases of the pages in this folder.

The tests compare the location, message, notes, hint and fix of each finding.
"""

from __future__ import annotations

import re

import pytest

from tests.lint.cases import Case, load_cases

CASES = load_cases()
_EXTRA_PATTERN = re.compile("the extra `([a-z]+)`")
"""The part of a case's title that names a required extra."""


def _case_marks(case: Case) -> list[pytest.MarkDecorator]:
    return [pytest.mark.extra(name) for name in _EXTRA_PATTERN.findall(case.name)]


@pytest.mark.parametrize("case", [pytest.param(case, id=case.name, marks=_case_marks(case)) for case in CASES])
def test_case_has_expected_findings(case: Case, tmp_path, monkeypatch):
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    folder = tmp_path / "case"  # not tmp_path, because the packages of other tests beside it would be found
    folder.mkdir()
    monkeypatch.chdir(folder)
    assert case.run(folder) == case.expected
    if case.fixed is not None:
        assert case.fixed_text(folder) == case.fixed
