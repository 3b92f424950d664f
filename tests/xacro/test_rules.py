"""The rules of the language, one case each; what comes out was recorded from ros/xacro 2.1.1."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.xacro import expand

from .cases import Case, read_cases, without_banner

CASES = {
    f"{path.stem}: {case.title}": case
    for path in sorted((Path(__file__).parent / "rules").glob("*.md"))
    for case in read_cases(path)
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_rule(case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case.write(tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("LINKWRIGHT_TEST", "env value")
    monkeypatch.delenv("LINKWRIGHT_UNSET", raising=False)
    expansion = expand("main.xacro", case.arguments, packages={"pkg_a": "/share/pkg_a"})
    assert without_banner(str(expansion)) == case.expected
