"""Settings from files: their effects, and the errors in them with their locations."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import Severity
from linkwright.lint.configuration import find_configuration, find_settings, read_settings
from linkwright.lint.registry import find_rule
from linkwright.lint.settings import Settings


def findings_of(tmp_path: Path, text: str, name: str = "linkwright.toml") -> list[str]:
    file = tmp_path / name
    file.write_text(text, encoding="utf-8")
    settings, findings = read_settings(file)
    assert isinstance(settings, Settings)
    return [
        f"{finding.span.line}:{finding.span.column} {finding.code} {finding.message} | {finding.hint}"
        for finding in findings
    ]


def test_all_settings_are_read_from_toml(tmp_path):
    (tmp_path / "linkwright.toml").write_text(
        """
        select = ["LW1", "limit-inverted"]
        extend-select = ["LW228"]
        ignore = ["URDF160", "LW103"]

        [severity]
        LW2 = "info"
        limit-inverted = "warning"

        [per-file-ignores]
        "vendor/*" = ["LW2"]

        [options.origin-far]
        farthest = 100
        """
    )
    settings, findings = find_settings(tmp_path / "urdf" / "robot.urdf")
    assert findings == ()
    assert settings.select == ("LW1", "LW201")
    assert settings.selects("LW104")
    assert not settings.selects("LW103")
    assert not settings.selects("LW202")
    assert settings.selects("LW228", default=False)
    assert settings.severity_of("LW201", Severity.ERROR) is Severity.WARNING
    assert settings.severity_of("LW202", Severity.WARNING) is Severity.INFO
    assert settings.severity_of("LW301", Severity.ERROR) is Severity.ERROR
    assert settings.ignores("LW201", str(tmp_path / "vendor" / "arm.urdf"))
    assert not settings.ignores("LW201", str(tmp_path / "urdf" / "arm.urdf"))
    assert settings.options == {"origin-far": {"farthest": 100}}


def test_longer_selector_wins_and_ignore_wins_tie():
    settings = Settings(ignore=("LW2",), extend_select=("LW201",))
    assert settings.selects("LW201")
    assert not settings.selects("LW202")
    assert not Settings(select=("LW201",), ignore=("LW201",)).selects("LW201")
    assert Settings(select=("ALL",)).selects("LW228", default=False)


def test_disabled_rule_runs_if_selected():
    rule = find_rule("angle-rounded")
    assert not Settings().runs(rule)
    assert Settings(extend_select=("LW228",)).runs(rule)
    assert Settings(select=("LW2",)).runs(rule)


def test_nearest_configuration_file_is_used(tmp_path):
    inner_folder = tmp_path / "package" / "urdf"
    inner_folder.mkdir(parents=True)
    (tmp_path / "linkwright.toml").write_text("ignore = ['LW1']")
    assert find_configuration(inner_folder / "robot.urdf") == tmp_path / "linkwright.toml"
    (tmp_path / "package" / "pyproject.toml").write_text("[project]\nname = 'p'\n")
    assert find_configuration(inner_folder / "robot.urdf") == tmp_path / "linkwright.toml"
    (tmp_path / "package" / "pyproject.toml").write_text("[tool.linkwright]\nignore = ['LW2']\n")
    assert find_configuration(inner_folder / "robot.urdf") == tmp_path / "package" / "pyproject.toml"
    assert find_settings(inner_folder / "robot.urdf")[0].ignore == ("LW2",)


def test_missing_configuration_gives_default_settings(tmp_path):
    assert find_settings(tmp_path / "robot.urdf") == (Settings(), ())


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("ignor = []\n", "1:1 LINT102 there is no setting 'ignor' | did you mean 'ignore'?"),
        (
            'ignore = "LW201"\n',
            '1:1 LINT103 \'ignore\' is not a list of strings | write ignore = ["LW204", "limit-inverted"]',
        ),
        (
            'ignore = [\n  "LW201",\n  "limit-invertd",\n]\n',
            "3:4 LINT104 there is no rule 'limit-invertd' | did you mean 'limit-inverted'?",
        ),
        (
            '[severity]\nLW201 = "warn"\n',
            "2:1 LINT103 'LW201' is not a severity: 'warn' | did you mean 'warning'?",
        ),
        (
            '[per-file-ignores]\n"a/*.urdf" = "LW1"\n',
            '2:2 LINT103 \'a/*.urdf\' is not a list of strings | write "a/*.urdf" = ["LW204", "limit-inverted"]',
        ),
        (
            "[options.origin-far]\nfarthst = 3\n",
            "2:1 LINT102 rule 'origin-far' has no option 'farthst' | did you mean 'farthest'?",
        ),
        (
            '[options.origin-far]\nfarthest = "far"\n',
            "2:1 LINT103 'farthest' is not a number | the default is 20.0",
        ),
        (
            "[options.origin-fat]\nfarthest = 3\n",
            "1:10 LINT104 there is no rule 'origin-fat' | did you mean 'origin-far'?",
        ),
        ("[options]\norigin-far = 3\n", "2:1 LINT103 'origin-far' is not a table | write [options.origin-far]"),
        (
            "options.origin-far.farthst = 3\n",
            "1:20 LINT102 rule 'origin-far' has no option 'farthst' | did you mean 'farthest'?",
        ),
        ("severity = 3\n", "1:1 LINT103 'severity' is not a table | write [severity]"),
    ],
)
def test_mistakes_are_reported_with_location(tmp_path, text, expected):
    assert findings_of(tmp_path, text) == [expected]


def test_malformed_toml_is_reported_with_location(tmp_path):
    (finding,) = findings_of(tmp_path, "ignore = []\nselect = LW201\n")
    assert finding.startswith("2:10 LINT101 this is not TOML: ")


def test_mistakes_in_pyproject_are_located_in_its_table(tmp_path):
    text = "[project]\nignore = 3\n\n[tool.linkwright]\nignore = 3\n"
    assert findings_of(tmp_path, text, "pyproject.toml")[0].startswith("5:1 LINT103")


def test_valid_settings_apply_beside_mistake(tmp_path):
    file = tmp_path / "linkwright.toml"
    file.write_text('ignore = ["LW1", "nonsense"]\n')
    settings, findings = read_settings(file)
    assert settings.ignore == ("LW1",)
    assert len(findings) == 1


@pytest.mark.parametrize(
    "text", ["", "x = [", "[a]\n[a]\n", "options.a.b.c = 1", "per-file-ignores.x = 3", "\x00", "select=[1]"]
)
def test_settings_reader_never_raises(tmp_path, text):
    file = tmp_path / "linkwright.toml"
    file.write_text(text)
    read_settings(file)


def test_arguments_are_read_as_sets_for_matching_files(tmp_path):
    (tmp_path / "linkwright.toml").write_text(
        """
        [arguments]
        "urdf/arm.urdf.xacro" = [{ arm = "left" }, { arm = "right", gripper = true, dof = 7 }]
        "*.world.xacro" = { size = 2.5 }
        """
    )
    settings, findings = find_settings(tmp_path / "urdf")
    assert findings == ()
    assert settings.arguments_of(tmp_path / "urdf/arm.urdf.xacro") == (
        {"arm": "left"},
        {"arm": "right", "gripper": "true", "dof": "7"},
    )
    assert settings.arguments_of(tmp_path / "a/b.world.xacro") == ({"size": "2.5"},)
    assert settings.arguments_of(tmp_path / "other.urdf.xacro") == ()


def test_malformed_arguments_are_reported(tmp_path):
    (logged,) = findings_of(tmp_path, '[arguments]\n"a.xacro" = ["prefix"]\n')
    what, hint = logged.split(" | ")
    assert what == "2:2 LINT103 'a.xacro' is neither a set of values nor a list of sets"
    assert hint == 'write "a.xacro" = [{ prefix = "left_" }, { prefix = "right_" }]'
