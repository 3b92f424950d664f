"""Linkwright rejects the documents that ros/xacro rejects, except for intended differences."""

from __future__ import annotations

import json

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.xacro import expand
from tests.corpora import OWN

from .cases import PACKAGES, Case, set_environment
from .test_errors import CASES

VERDICTS: dict[str, str | None] = json.loads((OWN.folder / "verdicts.json").read_text(encoding="utf-8"))["xacro"]
STRICTER = {
    "stories: an optional include whose own include is missing",  # ros/xacro skips the whole file silently
    "stories: a default with a quote that is never closed",  # ros/xacro takes the rest of the list as the default
}
"""Mistakes that ros/xacro does not report."""
WARNED_OF = {
    "warnings: ros: attribute of a number",
    "warnings: ros: dirname",
    "warnings: ros: a dot after what a method gives",
}
"""Cases that ros/xacro rejects, and Linkwright accepts with a warning about that."""


def test_every_case_has_verdict() -> None:
    assert VERDICTS.keys() == CASES.keys(), "run `make reference`"


@pytest.mark.parametrize("name", CASES)
def test_verdict_matches_ros_xacro(name: str, tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    case: Case = CASES[name]
    case.write(tmp_path)
    monkeypatch.chdir(tmp_path)
    set_environment(monkeypatch)
    warned_of = False
    try:
        expansion = expand("main.xacro", case.arguments, packages=PACKAGES)
        warned_of = any("ros/xacro" in diagnostic.message for diagnostic in expansion.diagnostics)
        refused = False
    except LinkwrightError:
        refused = True
    assert refused == ((VERDICTS[name] is not None and name not in WARNED_OF) or name in STRICTER)
    assert warned_of or name not in WARNED_OF
