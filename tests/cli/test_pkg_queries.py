"""``linkwright pkg list``, ``prefix``, ``executables`` and ``xml``."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.packages import PackageFinder

MANIFEST = (
    "<package><name>arm</name><version>1.2.0</version><license>MIT</license><depend>xacro</depend>"
    "<depend>urdf</depend></package>\n"
)


@pytest.fixture(autouse=True)
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "ws" / "src" / "arm"
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(MANIFEST)
    monkeypatch.chdir(folder)
    return folder


def run_command(capsys: pytest.CaptureFixture[str], *words: str, status: int = 0) -> str:
    assert main(["pkg", *words]) == status
    captured = capsys.readouterr()
    return captured.err if status else captured.out


def test_pkg_list_contains_workspace_and_built_in_packages(capsys: pytest.CaptureFixture[str]) -> None:
    names = run_command(capsys, "list").splitlines()
    assert names == sorted(names)
    assert {"arm", "robot_state_publisher"} <= set(names)


def test_pkg_prefix_prints_package_location(capsys: pytest.CaptureFixture[str], package: Path) -> None:
    assert run_command(capsys, "prefix", "--share", "arm") == f"{package}\n"
    share = Path(run_command(capsys, "prefix", "arm").strip(), "share", "arm")
    assert share.resolve() == package
    assert (share / "package.xml").read_text(encoding="utf-8") == MANIFEST
    assert PackageFinder(start=[share]).share("arm") == package  # a launch file there belongs to the sources
    assert "arm" in run_command(capsys, "prefix", "armm", status=1)


def test_pkg_executables_lists_one_package_or_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert "demo_nodes_cpp talker" in run_command(capsys, "executables", "demo_nodes_cpp").splitlines()
    assert "demo_nodes_cpp talker" in run_command(capsys, "executables").splitlines()
    assert (
        "demo_nodes_cpp talker" not in run_command(capsys, "executables", "--full-path", "demo_nodes_cpp").splitlines()
    )


def test_pkg_xml_prints_manifest_or_tag(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command(capsys, "xml", "arm") == MANIFEST
    assert run_command(capsys, "xml", "arm", "-t", "depend") == "xacro\nurdf\n"
    error = run_command(capsys, "xml", "arm", "-t", "licens", status=1)
    assert "package.xml of 'arm' has no element <licens>" in error
    assert "did you mean 'license'?" in error
    assert "choose from depend" in run_command(capsys, "xml", "arm", "-t", "zzzzzz", status=1)
