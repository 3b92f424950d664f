"""The reports of errors: code, message, location, calls and hint."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from linkwright.diagnostics import LinkwrightError
from linkwright.xacro import expand

from .cases import PACKAGES, Case, format_diagnostic, read_cases, set_environment

CASES = {
    f"{path.stem}: {case.title}": case
    for path in sorted((Path(__file__).parent / "errors").glob("*.md"))
    for case in read_cases(path)
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_error_report_matches_case(case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if "is not valid YAML: did not find" in case.expected and not yaml.__with_libyaml__:
        pytest.skip("the expected text is libyaml's, and PyYAML was built without it")
    case.write(tmp_path)
    monkeypatch.chdir(tmp_path)
    set_environment(monkeypatch)
    try:
        diagnostics = expand("main.xacro", case.arguments, packages=PACKAGES).diagnostics
    except LinkwrightError as error:
        diagnostics = error.diagnostics
    assert "\n".join(format_diagnostic(diagnostic, tmp_path) for diagnostic in diagnostics) == case.expected
