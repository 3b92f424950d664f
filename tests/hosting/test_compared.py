"""``linkwright view`` with two descriptions: refusals and waiting."""

from __future__ import annotations

import asyncio
import io
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.descriptions.pairs import make_file_pair
from linkwright.hosting.compared import ComparedView
from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.plans import HostOptions
from tests.waiting import eventually

VALID_ROBOT = '<robot name="a"><link name="b"/></robot>'
BROKEN_ROBOT = '<robot name="a">\n  <link name="b">\n</robot>'


@pytest.fixture(autouse=True)
def _working_directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros_log"))
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "good.urdf").write_text(VALID_ROBOT, encoding="utf-8")
    (tmp_path / "broken.urdf").write_text(BROKEN_ROBOT, encoding="utf-8")


@pytest.mark.parametrize(
    ("words", "status", "message"),
    [
        (["good.urdf", "good.urdf", "good.urdf"], 2, "pass one file, two to compare, or one and --against COMMIT"),
        (["good.urdf", "good.urdf", "--against", "HEAD"], 2, "pass one file, two to compare"),
        (["good.urdf", "missing.urdf"], 1, "error[XML101]: no such file"),
        (["missing.urdf", "good.urdf"], 1, "error[XML101]: no such file"),
        (["good.urdf", "prefix=left"], 1, "write prefix:=left"),
        (["good.urdf", "--against", "HEAD"], 1, "error[CLI342]: 'good.urdf' is not in a git repository"),
    ],
)
def test_invalid_comparison_arguments_are_rejected(words, status, message, capsys):
    assert main(["view", *words, "--no-open", "--port", "9"]) == status
    assert message in capsys.readouterr().err


async def test_broken_old_file_is_waited_for_until_fixed(tmp_path):
    out, err = io.StringIO(), io.StringIO()
    pair = make_file_pair(tmp_path / "broken.urdf", tmp_path / "good.urdf", {})
    view = ComparedView(pair, HostOptions(port=0, open_browser=False, network=False), LaunchLog(out, err))
    running = asyncio.create_task(view.run(None))
    await eventually(lambda: "broken.urdf:3:1" in err.getvalue() and "Viewer: " in out.getvalue(), what=err.getvalue)
    (tmp_path / "broken.urdf").write_text(VALID_ROBOT, encoding="utf-8")
    await eventually(lambda: "repaired broken.urdf" in err.getvalue(), what=err.getvalue)
    view.interrupt("the test is over")
    assert await running, "the repaired file has no errors"
