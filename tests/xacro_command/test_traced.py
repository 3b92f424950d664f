"""Traced attributes have locations, and tracing raises only Linkwright's errors."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.xacro import arguments_of, expand, explain
from linkwright.xacro.session import Inputs
from linkwright.xacro.tracing.property_log import log_properties
from tests.xacro.cases import Case, read_cases
from tests.xacro.test_rules import CASES
from tests.xacro_command.conftest import Write

ERRORS = {
    f"{path.stem}: {case.title}": case
    for path in sorted((Path(__file__).parents[1] / "xacro" / "errors").glob("*.md"))
    for case in read_cases(path)
}
PACKAGES = {"pkg_a": "/share/pkg_a"}


@pytest.fixture
def make_inputs(write: Write, tmp_path, monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_TEST", "env value")
    monkeypatch.delenv("LINKWRIGHT_UNSET", raising=False)

    def inputs_of(case: Case) -> Inputs:
        case.write(tmp_path)
        monkeypatch.chdir(tmp_path)
        return Inputs("main.xacro", case.arguments, PACKAGES)

    return inputs_of


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_traced_attributes_have_locations(case: Case, make_inputs) -> None:
    make_inputs(case)
    expansion = expand("main.xacro", case.arguments, packages=PACKAGES)
    provenance = expansion.provenance(expansion.document.root)
    for part in provenance.walk():
        assert part.span is not None
        for attribute in part.attributes:
            assert attribute.span is not None
            assert attribute.value == part.element.attributes[attribute.name]
            if "$" not in attribute.written and "&" not in attribute.written:
                assert attribute.written.split() == attribute.value.split()


@pytest.mark.parametrize("case", [*CASES.values(), *ERRORS.values()], ids=[*CASES, *ERRORS])
def test_tracing_raises_only_linkwright_errors(case: Case, make_inputs) -> None:
    case_inputs = make_inputs(case)
    for trace in (
        lambda: arguments_of("main.xacro", case.arguments, packages=PACKAGES),
        lambda: explain("main.xacro", "no such name", case.arguments, packages=PACKAGES),
        lambda: log_properties(case_inputs, str, everywhere=True),
    ):
        with suppress(LinkwrightError):
            trace()
