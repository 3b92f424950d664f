"""Findings of several rooms or rules with the same cause are reported once."""

from __future__ import annotations

from linkwright.lint import check
from linkwright.lint.settings import Settings

_XACRO = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="l${range(2)[0]}"/>
</robot>
"""


def test_rule_replaces_xacro_warning(tmp_path):
    path = tmp_path / "robot.xacro"
    path.write_text(_XACRO)
    codes = {finding.code for finding in check(path, settings=Settings())}
    assert "LW714" in codes
    assert "XAC507" not in codes


def test_xacro_warning_remains_if_rule_is_disabled(tmp_path):
    path = tmp_path / "robot.xacro"
    path.write_text(_XACRO)
    codes = {finding.code for finding in check(path, settings=Settings(ignore=("LW714",)))}
    assert "XAC507" in codes
    assert "LW714" not in codes


def test_rule_replaces_another_rule(tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text('<robot name="r"><link name="a"><if value="1"/></link></robot>')
    codes = [finding.code for finding in check(path, settings=Settings(select=("LW1", "LW7")))]
    assert codes.count("LW720") == 1
    assert "LW107" not in codes


def test_two_findings_at_one_location_are_both_reported(tmp_path):
    (tmp_path / "package.xml").write_text(
        "<package><name>p</name><export><build_type>ament_python</build_type></export></package>"
    )
    (tmp_path / "setup.py").write_text("from setuptools import setup\nsetup(name='p', data_files=[])\n")
    (tmp_path / "robot.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    findings = check(tmp_path / "robot.urdf", settings=Settings(select=("LW826",)))
    assert [finding.code for finding in findings] == ["LW826", "LW826"]
    assert str(findings[0].hint).startswith("create an empty file 'resource/p', and add ")
    (tmp_path / "resource").mkdir()
    (tmp_path / "resource" / "p").touch()
    assert str(check(tmp_path / "robot.urdf", settings=Settings(select=("LW826",)))[0].hint).startswith("add ")
