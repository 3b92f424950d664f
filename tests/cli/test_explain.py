"""`linkwright explain`: the page of a code, and near ones for a code that is none."""

from __future__ import annotations

import pytest

from linkwright.cli import main


@pytest.mark.parametrize("word", ["LW201", "lw201", "limit-inverted"])
def test_the_page_of_a_rule(capsys, word):
    assert main(["explain", word]) == 0
    text = capsys.readouterr().out
    assert text.startswith("# LW201: limit-inverted\n\nA joint whose lower limit is above its upper limit.\n")
    assert "## Use instead" in text


def test_the_page_of_another_diagnostic(capsys):
    assert main(["explain", "URDF110"]) == 0
    assert capsys.readouterr().out.startswith("# URDF110: two things of one kind have the same name\n")


def test_near_codes_for_one_that_is_none(capsys):
    assert main(["explain", "limit-invertd"]) == 1
    assert "did you mean limit-inverted" in capsys.readouterr().err
