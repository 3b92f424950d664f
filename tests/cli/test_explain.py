"""`linkwright explain`: the page of a code, and suggestions for unknown codes."""

from __future__ import annotations

import re

import pytest

from linkwright.cli import main
from linkwright.urdf.vocabulary import names


@pytest.mark.parametrize("word", ["LW201", "lw201", "limit-inverted"])
def test_explain_prints_page_of_rule(capsys, word):
    assert main(["explain", word]) == 0
    text = capsys.readouterr().out
    assert text.startswith("# LW201: limit-inverted\n\nA joint whose lower limit is above its upper limit.\n")
    assert "## Use instead" in text


def test_explain_prints_page_of_diagnostic_code(capsys):
    assert main(["explain", "URDF110"]) == 0
    assert capsys.readouterr().out.startswith("# URDF110: two elements of one kind have the same name\n")


def test_explain_prints_rule_in_chinese(capsys):
    assert main(["--lang", "zh", "explain", "LW325"]) == 0
    text = capsys.readouterr().out
    assert text.startswith(
        "# LW325: inertia-too-small\n\n转动惯量比形状所示小几百倍。\n\n级别：警告。默认开启。\n\n## 为什么\n"
    )
    assert [line for line in text.splitlines() if line.startswith("## ")] == [
        "## 为什么",
        "## 例子",
        "## 改成",
        "## 选项",
    ]
    assert "- `factor`（默认 `200.0`）：" in text


def test_explain_prints_diagnostic_code_in_chinese(capsys):
    assert main(["--lang", "zh", "explain", "URDF110"]) == 0
    assert capsys.readouterr().out.startswith("# URDF110：同类的两个元素同名\n\nLinks, joints and")


def test_unknown_code_suggests_nearest(capsys):
    assert main(["explain", "limit-invertd"]) == 1
    assert "did you mean limit-inverted" in capsys.readouterr().err


@pytest.mark.parametrize("word", ["joint.limit.effort", "limit/effort", "<limit> effort", "effort", "Effort"])
def test_explain_prints_meaning_of_attribute(capsys, word):
    assert main(["explain", word]) == 0
    text = capsys.readouterr().out
    assert text.startswith("# `joint.limit.effort`\n\n- `effort`: ")
    assert "N m" in text


def test_explain_prints_meaning_of_element_in_chinese(capsys):
    assert main(["--lang", "zh", "explain", "joint.safety_controller"]) == 0
    heading, meaning, attributes = capsys.readouterr().out.split("\n\n")
    assert heading == "# `joint.safety_controller`"
    assert meaning == "`<safety_controller>`：安全控制器的增益和软限位"
    assert "- `k_velocity`：" in attributes
    assert "必需" in attributes


def test_explain_lists_all_contexts_of_element(capsys):
    assert main(["explain", "origin"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("# `link.inertial.origin`, `link.visual.origin`, `link.collision.origin`, `joint.origin`\n")
    assert "`rpy`: roll, pitch, yaw about the fixed axes x, y, z (" in text


def test_ambiguous_name_prints_all_meanings(capsys):
    assert main(["explain", "xyz"]) == 0
    assert re.findall("^# `.*`$", capsys.readouterr().out, re.MULTILINE)[-1] == "# `joint.axis.xyz`"


def test_every_element_and_attribute_has_a_meaning(capsys):
    for name in names():
        assert main(["explain", name]) == 0, name


def test_unknown_element_suggests_nearest(capsys):
    assert main(["explain", "inertail"]) == 1
    assert "inertial" in capsys.readouterr().err
