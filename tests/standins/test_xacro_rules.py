"""The module ``xacro`` returns the engine's results, for every rule of the language."""

from __future__ import annotations

from pathlib import Path

import pytest

import xacro
from tests.xacro.cases import Case, without_banner
from tests.xacro.test_rules import CASES


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_xacro_module_matches_engine(case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case.write(tmp_path)
    share = tmp_path / "share" / "pkg_a"
    share.mkdir(parents=True)
    (share / "package.xml").write_text('<package format="3"><name>pkg_a</name></package>')
    monkeypatch.setenv("LINKWRIGHT_TEST", "env value")
    monkeypatch.delenv("LINKWRIGHT_UNSET", raising=False)
    expected = case.expected.replace("/share/pkg_a", str(share))
    document = xacro.process_file("main.xacro", mappings=case.arguments, verbosity=0)
    assert without_banner(document.toprettyxml(indent="  ")) == expected
    with Path("main.xacro").open(encoding="utf-8", newline="") as file:
        document = xacro.parse(file)
    xacro.init_stacks("main.xacro")
    xacro.process_doc(document, mappings=case.arguments, verbosity=0)
    assert document.toprettyxml(indent="  ").partition("\n")[2].removesuffix("\n") == expected
