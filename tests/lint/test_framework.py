"""The registry, the engine, and the common properties of all rules."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from linkwright.diagnostics import Severity
from linkwright.lint import Settings, check, examine
from linkwright.lint.registry import all_rules, find_rule, rules_of
from linkwright.lint.rule import Scope
from tests.imports import loaded_by, rooms_of
from tests.lint.cases import FOLDER, load_cases

ROBOTS = sorted((Path(__file__).parents[2] / "robots" / "my_robot_description" / "urdf").glob("*.*"))
ALL_RULES = Settings(select=("ALL",))


def test_rule_codes_and_names_are_unique_and_sorted():
    rules = all_rules()
    assert len(rules) >= 90
    assert [rule.code for rule in rules] == sorted({rule.code for rule in rules})
    assert len({rule.name for rule in rules}) == len(rules)


def test_package_rules_are_in_separate_modules():
    """A check of a file imports the modules of other rules only by their names."""
    modules = {type(rule).__module__.rpartition(".")[2]: rule.scope is Scope.PACKAGE for rule in all_rules()}
    assert {name for name, is_of_packages in modules.items() if is_of_packages} == {
        name for name in modules if name.startswith(("launch_", "package_"))
    }
    of_files = rules_of((Scope.DESCRIPTION,))
    assert of_files == tuple(rule for rule in all_rules() if rule.scope is Scope.DESCRIPTION)


def test_import_of_check_loads_no_unneeded_modules():
    loaded = loaded_by("from linkwright.lint import check")
    assert not {"argparse", "ast", "asyncio", "dataclasses", "inspect", "numpy", "tomllib", "typing", "yaml"} & loaded
    below = {"descriptions", "diagnostics", "files", "geometry", "loading", "packages", "schema", "urdf", "xmltree"}
    assert rooms_of(loaded) == {"lint", *below}
    assert not any(name.startswith("linkwright.lint.rules") for name in loaded)


def test_rule_is_found_by_code_and_name():
    assert find_rule("LW801") is find_rule(find_rule("LW801").name)
    assert find_rule("URDF102") is None
    assert find_rule("LW201") is find_rule("lw201") is find_rule("limit-inverted")
    assert find_rule("LW999") is None


@pytest.mark.parametrize("rule", all_rules(), ids=lambda rule: rule.code)
def test_every_rule_has_positive_and_negative_case(rule):
    group = re.compile(rf"^(?:\S+:)?(?:\d+:\d+|-) {rule.code} ", re.MULTILINE)
    cases = [case for case in load_cases() if rule.code.startswith(case.selectors)]
    assert any(group.search(case.expected) for case in cases), f"no page in {FOLDER} shows {rule.code}"
    assert any(not group.search(case.expected) for case in cases)


@pytest.mark.parametrize("case", [pytest.param(case, id=case.name) for case in load_cases()])
def test_no_rule_raises_on_any_case(case, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in case.files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    examine(tmp_path / next(iter(case.files)), settings=ALL_RULES)


@pytest.mark.parametrize("path", ROBOTS, ids=lambda path: path.name)
def test_tutorial_robots_have_no_findings(path):
    assert check(path, settings=Settings()) == []


@pytest.mark.parametrize(
    "text",
    [
        "<robot/>",
        '<robot name="r"/>',
        "<robot><link/><joint/></robot>",
        '<robot name="r"><link name="a"><inertial/><visual/><collision/></link><joint ><limit/></joint></robot>',
        '<robot name="r"><joint name="j" type="revolute"><mimic joint="j"/><axis xyz="a"/><limit/></joint></robot>',
        '<robot name="r"><gazebo/><ros2_control><joint/></ros2_control><transmission><joint/></transmission></robot>',
        "<sdf/>",
        '<robot name="r"><link name="a"><visual><geometry/><material/></visual></link><material/></robot>',
    ],
)
def test_no_rule_raises_on_odd_descriptions(tmp_path, text):
    path = tmp_path / "robot.urdf"
    path.write_text(text)
    examine(path, settings=ALL_RULES)


def test_findings_are_in_order_of_text(tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text(
        '<robot name="r">\n  <link name="a"/>\n  <link name="b"/>\n  <joint name="j" type="revolute">\n'
        '    <axis xyz="0 0 2"/>\n    <parent link="a"/>\n    <child link="c"/>\n'
        '    <limit lower="1" upper="-1" effort="1" velocity="1"/>\n  </joint>\n</robot>\n'
    )
    findings = check(path, settings=Settings(select=("LW2",)))
    assert [finding.code for finding in findings] == ["LW221", "URDF150", "LW201"]


def test_unreadable_description_is_reported_and_not_raised(tmp_path):
    (only_finding,) = check(tmp_path / "none.urdf")
    assert only_finding.code == "XML101"
    path = tmp_path / "robot.urdf.xacro"
    path.write_text('<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="${nothing}"/></robot>')
    assert [finding.code for finding in check(path)] == ["XAC201"]


def test_structure_rules_have_description_scope():
    assert {rule.scope for rule in all_rules() if rule.code.startswith("LW1")} == {Scope.DESCRIPTION}


def test_reader_error_is_reported_unless_ignored(tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text('<robot name="r"/>\n')
    for settings in (Settings(), Settings(select=()), Settings(select=("LW2",))):
        assert [finding.code for finding in check(path, settings=settings)] == ["URDF106"]
    assert check(path, settings=Settings(ignore=("URDF",))) == []
    assert check(path, settings=Settings(per_file_ignores=(("robot.*", ("URDF106",)),))) == []
    (result,) = check(path, settings=Settings(severity={"URDF1": Severity.INFO}))
    assert result.severity is Severity.INFO
    path.write_text('<!-- linkwright: ignore-file URDF106 -->\n<robot name="r"/>\n')
    assert check(path, settings=Settings()) == []


@pytest.mark.parametrize(
    ("name", "text", "code"),
    [
        ("robot.urdf", "<robot", "XML2"),
        (
            "robot.urdf.xacro",
            '<robot name="r" xmlns:xacro="x"><xacro:include filename="none.xacro"/></robot>',
            "XML101",
        ),
        ("robot.urdf.xacro", '<robot name="r" xmlns:xacro="x"><link name="${none}"/></robot>', "XAC201"),
        ("robot.urdf.xacro", '<robot name="r" xmlns:xacro="x"><link name="$(find none_such)"/></robot>', "PKG"),
        ("robot.sdf", "<sdf version='1.9'><model name='m'/></sdf>", "SDF"),
    ],
)
def test_errors_of_all_rooms_can_be_ignored_and_change_severity(tmp_path, name, text, code):
    path = tmp_path / name
    path.write_text(text)
    findings = [finding for finding in check(path) if finding.code.startswith(code)]
    assert findings
    assert findings[0].severity is Severity.ERROR
    assert not [finding for finding in check(path, settings=Settings(ignore=(code,))) if finding.code.startswith(code)]
    changed = check(path, settings=Settings(severity={code: Severity.WARNING}))
    assert {finding.severity for finding in changed if finding.code.startswith(code)} == {Severity.WARNING}


def test_text_is_checked_like_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "linkwright.toml").write_text('ignore = ["URDF110"]\n')
    assert [finding.code for finding in check('<sdf version="1.6"><world name="w"/><world name="w"/></sdf>')]
    robot = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:wheel/></robot>'
    (finding,) = check(robot)
    assert (finding.code, str(finding.span)) == ("XAC401", "<robot_description>:1:61")
    assert not check('<robot name="r"><link name="a"/><link name="a"/></robot>')
