"""Packages with the line ends of Windows give the same results.

Git checks them out with these line ends there.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from linkwright.cli import main
from tests.places import GAZEBO_PACKAGE, PACKAGE

TEXTS = {".cfg", ".config", ".launch", ".py", ".rviz", ".sdf", ".txt", ".urdf", ".world", ".xacro", ".xml", ".yaml"}


@pytest.fixture(params=[b"\n", b"\r\n"], ids=["LF", "CRLF"])
def packages(request, tmp_path, monkeypatch) -> Path:
    """Return a folder with packages whose texts have these line ends."""
    for package in (PACKAGE, GAZEBO_PACKAGE):
        shutil.copytree(package, tmp_path / package.name, ignore=shutil.ignore_patterns("__pycache__"))
    for file in tmp_path.rglob("*"):
        if file.suffix in TEXTS:
            file.write_bytes(file.read_bytes().replace(b"\r\n", b"\n").replace(b"\n", request.param))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_packages_with_crlf_have_no_findings(packages, capfd):
    assert main(["check", PACKAGE.name, GAZEBO_PACKAGE.name]) == 0
    output = capfd.readouterr()
    assert output.out + output.err == "0 errors, 0 warnings\n"


def test_xacro_output_is_the_same_with_crlf(packages, capfd):
    assert main(["xacro", f"{PACKAGE.name}/urdf/mbot_gazebo.xacro", "laser:=true"]) == 0
    written = capfd.readouterr().out
    assert main(["xacro", str(PACKAGE / "urdf" / "mbot_gazebo.xacro"), "laser:=true"]) == 0
    # The text before the root element contains the name of the file.
    assert written.partition("<robot")[2] == capfd.readouterr().out.partition("<robot")[2]
    assert written.count("\n") > 100


def test_launch_file_with_crlf_lists_arguments(packages, capfd):
    assert main(["launch", f"{PACKAGE.name}/launch/display.launch.py", "--show-args"]) == 0
    assert "'gui':" in capfd.readouterr().out


def test_wrong_frame_in_crlf_file_is_reported(packages, capfd):
    file = packages / PACKAGE.name / "rviz" / "urdf.rviz"
    file.write_bytes(file.read_bytes().replace(b"Fixed Frame: base_link", b"Fixed Frame: base_lnk"))
    main(["check", PACKAGE.name])
    output = capfd.readouterr()
    assert "no robot in this package has a link 'base_lnk'" in output.out + output.err
