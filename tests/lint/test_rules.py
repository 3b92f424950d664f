"""The cases of the pages beside this file: every finding with its place, message, notes, hint and fix."""

from __future__ import annotations

import pytest

from tests.lint.cases import Case, load_cases

CASES = load_cases()


@pytest.mark.parametrize("case", [pytest.param(case, id=case.name) for case in CASES])
def test_case(case: Case, tmp_path, monkeypatch):
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    monkeypatch.chdir(tmp_path)
    assert case.run(tmp_path) == case.said
    if case.fixed is not None:
        assert case.mend(tmp_path) == case.fixed
