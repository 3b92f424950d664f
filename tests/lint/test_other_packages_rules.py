"""Rules from other packages."""

from __future__ import annotations

import sys

import pytest

from linkwright.lint import check, registry
from linkwright.lint.configuration import find_settings
from linkwright.lint.explain import find_page
from linkwright.loading import extensions

RULES = '''
from linkwright.lint import Rule


class Nameless(Rule):
    """A robot that the team has no name for.

    ## Why

    Nobody finds it again.
    """

    code = "TEAM001"
    name = "robot-of-no-team"

    def check(self, subject):
        if not subject.root.attributes.get("name", "").startswith("team_"):
            yield self.report("the robot's name does not begin with 'team_'", subject.root, "name")
'''


@pytest.fixture
def install_rules(tmp_path, monkeypatch):
    """Install a package with the given rules."""

    def install(text: str) -> None:
        (tmp_path / "team_rules.py").write_text(text)
        facts = tmp_path / "team_rules-1.0.dist-info"
        facts.mkdir()
        (facts / "METADATA").write_text("Metadata-Version: 2.1\nName: team-rules\nVersion: 1.0\n")
        (facts / "entry_points.txt").write_text("[linkwright.lint_rules]\nteam = team_rules\n")
        monkeypatch.syspath_prepend(tmp_path)
        remove_module()

    def remove_module() -> None:
        sys.modules.pop("team_rules", None)
        for cached in (extensions._read_all_groups, registry._all_rules, registry._index_rules):
            cached.cache_clear()

    yield install
    monkeypatch.undo()
    remove_module()


@pytest.fixture
def robot(tmp_path):
    (tmp_path / "robot").mkdir()
    path = tmp_path / "robot" / "r.urdf"
    path.write_text('<robot name="r"><link name="a"/></robot>')
    return path


def test_plugin_rules_run_beside_built_in_rules(install_rules, robot):
    install_rules(RULES)
    assert [finding.code for finding in check(robot)] == ["TEAM001"]


def test_plugin_rules_are_selected_suppressed_and_explained(install_rules, robot):
    install_rules(RULES)
    (robot.parent / "linkwright.toml").write_text('ignore = ["robot-of-no-team"]')
    assert find_settings(robot)[1] == ()
    assert check(robot) == []
    (robot.parent / "linkwright.toml").write_text('select = ["TEAM"]\nseverity = { TEAM001 = "error" }')
    assert [finding.severity.value for finding in check(robot)] == ["error"]
    assert "Nobody finds it again" in str(find_page("team001"))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("import no_such_module", "No module named 'no_such_module'"),
        (RULES.replace("TEAM001", "LW201"), "malformed code or name: LW201"),
        (RULES.replace("TEAM001", "team1"), "malformed code or name: team1"),
        (RULES.replace("robot-of-no-team", "limit-inverted"), "'TEAM001' or 'limit-inverted' is taken"),
    ],
)
def test_unusable_plugin_rules_are_one_warning(install_rules, robot, text, reason):
    install_rules(text)
    (finding,) = check(robot)
    assert (finding.code, finding.severity.value) == ("LINT301", "warning")
    assert finding.message.startswith("the rules of 'team_rules' cannot be used: ")
    assert reason in finding.message


BROKEN = '''

class Broken(Rule):
    """A rule with a fault."""

    code = "TEAM003"
    name = "broken"

    def check(self, subject):
        yield self.report("before", subject.root)
        {fault}
'''


@pytest.mark.parametrize("fault", ["subject.nothing", "raise KeyError(1)", "yield None"])
def test_failing_plugin_rule_is_reported_and_other_rules_run(install_rules, robot, fault):
    install_rules(RULES + BROKEN.format(fault=fault))
    finding_of_rule, failed = sorted(check(robot), key=lambda finding: finding.code, reverse=True)
    assert (finding_of_rule.code, failed.code, failed.severity.value) == ("TEAM001", "LINT304", "error")
    assert failed.message.startswith("rule TEAM003 of the module 'team_rules' failed: ")
    if fault != "yield None":
        assert failed.span.file.endswith("team_rules.py")
        assert (RULES + BROKEN.format(fault=fault)).splitlines()[failed.span.line - 1].strip() == fault


OF_PACKAGES = """

from linkwright.lint import Scope


class NoReadme(Rule):
    '''A package without a README.'''

    code = "TEAM004"
    name = "no-readme"
    scope = Scope.PACKAGE

    def check(self, subject):
        if "README.md" not in subject.package.files:
            yield self.report("there is no README.md", subject.package.manifest.root)
"""


def test_a_rule_about_packages_runs_only_for_a_description_in_a_package(install_rules, robot):
    install_rules(RULES + OF_PACKAGES)
    assert [finding.code for finding in check(robot)] == ["TEAM001"]
    (robot.parent / "package.xml").write_text("<package format='3'><name>robot</name></package>")
    assert {"TEAM001", "TEAM004"} <= {finding.code for finding in check(robot)}
