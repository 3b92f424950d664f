"""Command-line flags in the form of gflags."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.nodes.flags import parse_flags

DEFAULTS = {"directory": "", "period": 1.0, "frozen": True, "metrics": False}


@pytest.mark.parametrize(
    ("arguments", "changes"),
    [
        ([], {}),
        (["-directory", "/a b"], {"directory": "/a b"}),
        (["--directory=x=y", "--period", "0.5"], {"directory": "x=y", "period": 0.5}),
        (["-nofrozen", "-metrics"], {"frozen": False, "metrics": True}),
        (["-frozen=false", "-metrics=1"], {"frozen": False, "metrics": True}),
        (["word", "-period", "-2"], {"period": -2.0}),
        (["--", "-directory", "x"], {}),
    ],
)
def test_flags_are_read_in_all_forms(arguments, changes):
    assert parse_flags(arguments, DEFAULTS) == {**DEFAULTS, **changes}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["-directori", "x"], "unknown flag '-directori'"),
        (["-directory"], "the value of '-directory' is missing"),
        (["-period", "soon"], "'soon' is not a valid value for 'period'"),
        (["-frozen=maybe"], "'maybe' is not a valid value for 'frozen'"),
        (["-noperiod"], "unknown flag '-noperiod'"),
    ],
)
def test_invalid_flags_are_refused(arguments, message):
    with pytest.raises(LinkwrightError) as error:
        parse_flags(arguments, DEFAULTS)
    assert error.value.diagnostics[0].message == message
