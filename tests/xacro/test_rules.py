"""The rules of the language, compared with the output of ros/xacro.

`tools/reference_outputs.py` writes this output.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.xacro import expand

from .cases import PACKAGES, Case, read_cases, set_environment, without_banner

CASES = {
    f"{path.stem}: {case.title}": case
    for path in sorted((Path(__file__).parent / "rules").glob("*.md"))
    for case in read_cases(path)
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_expansion_matches_case(case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case.write(tmp_path)
    monkeypatch.chdir(tmp_path)
    set_environment(monkeypatch)
    expansion = expand("main.xacro", case.arguments, packages=PACKAGES)
    assert without_banner(str(expansion)) == case.expected
