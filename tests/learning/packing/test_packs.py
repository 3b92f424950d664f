"""Packs: their contents, continuation, checks and installation."""

from __future__ import annotations

import ensurepip
import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from linkwright.cli import main
from tests.full_disk import full_disk, needs_limits
from tests.learning.packing.conftest import FakeIndex, create_index
from tests.learning.packing.fake_index import package_entry, write_source, write_wheel

ALL_TARGETS = ("--systems", "windows,linux-x86_64", "--python", "3.12,3.13")
LINUX_TARGET = ("--systems", "linux-x86_64", "--python", "3.13")
pytestmark = pytest.mark.extra("learn")


@pytest.fixture(scope="module")
def complete_pack(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A pack for all targets, made once, because pip is started for each of them."""
    parent = tmp_path_factory.mktemp("complete")
    with pytest.MonkeyPatch.context() as patch:
        assert create_index(parent, patch).pack(parent / "pack", *ALL_TARGETS) == 0
    return parent / "pack"


@pytest.fixture
def pack(complete_pack: Path, index: FakeIndex, tmp_path: Path) -> Path:
    """A copy of the complete pack, with an index that has the same packages."""
    return shutil.copytree(complete_pack, tmp_path / "pack", symlinks=True)


def wheel_names(folder: Path) -> set[str]:
    return {path.name for path in (folder / "wheels").iterdir()}


def test_pack_contains_each_wheel_once(pack: Path) -> None:
    assert wheel_names(pack) == {
        "linkwright-1.0-py3-none-any.whl",
        "linkwright_core-1.0-py3-none-any.whl",
        "native-1.0-cp310-abi3-manylinux_2_17_x86_64.manylinux2014_x86_64.whl",
        "native-1.0-cp312-cp312-win_amd64.whl",
        "native-1.0-cp313-cp313-win_amd64.whl",
        "pip-9.0-py3-none-any.whl",
        "pure-1.0-py3-none-any.whl",
        "source-1.0-py3-none-any.whl",
        "windows_only-1.0-py3-none-any.whl",
    }


def test_pack_has_requirements_of_each_target(pack: Path) -> None:
    lists = {path.stem: path.read_text() for path in (pack / "requirements").iterdir()}
    assert set(lists) == {
        "windows-py3.12",
        "windows-py3.13",
        "linux-x86_64-py3.12",
        "linux-x86_64-py3.13",
    }
    assert "windows-only==1.0 --hash=sha256:" in lists["windows-py3.12"]
    assert "windows-only" not in lists["linux-x86_64-py3.12"]
    assert lists["windows-py3.12"].startswith("linkwright-core==1.0 --hash=")
    assert "\nlinkwright[learn]==1.0 --hash=" in lists["windows-py3.12"]


def test_pack_has_installer_for_each_system(pack: Path) -> None:
    assert {"install.sh", "install.command", "install.bat", "install.py", "README.txt", "no-python.txt"} <= {
        path.name for path in pack.iterdir()
    }
    for name in ("install.sh", "install.bat", "no-python.txt", "README.txt"):
        assert "@" not in (pack / name).read_text(encoding="utf-8").replace("@echo", "").replace('"$@"', "")
    assert (pack / "install.sh").read_bytes() == (pack / "install.command").read_bytes()
    batch = (pack / "install.bat").read_bytes()
    assert batch.isascii()
    assert batch.count(b"\r\n") == batch.count(b"\n")


def test_checksums_match_sha256sum(pack: Path) -> None:
    if shutil.which("sha256sum") is None:
        pytest.skip("sha256sum is not installed")
    subprocess.run(["sha256sum", "--check", "--quiet", "SHA256SUMS"], cwd=pack, check=True)


def test_interrupted_pack_is_continued(pack: Path, index: FakeIndex, capsys: pytest.CaptureFixture[str]) -> None:
    (pack / "SHA256SUMS").unlink()
    (pack / "wheels" / "pure-1.0-py3-none-any.whl").write_bytes(b"half of it")
    assert main(["learn", "pack", "--check", str(pack)]) == 1
    assert "is not complete" in capsys.readouterr().err
    assert index.pack(pack, *ALL_TARGETS) == 0
    errors = capsys.readouterr().err
    assert "Windows, Python 3.12: 1 of 5 wheels to download, 0 MB" in errors
    assert "Linux x86-64, Python 3.13: 0 of 4 wheels to download, 0 MB" in errors


def test_smaller_pack_removes_unneeded_wheels(pack: Path, index: FakeIndex) -> None:
    assert index.pack(pack, *LINUX_TARGET) == 0
    assert not any("win" in name for name in wheel_names(pack))
    assert [path.name for path in (pack / "requirements").iterdir()] == ["linux-x86_64-py3.13.txt"]


def test_wheel_for_oldest_system_is_chosen(index: FakeIndex, tmp_path: Path) -> None:
    assert index.pack(tmp_path / "pack", "--systems", "macos-arm64", "--python", "3.13") == 0
    assert "native-1.0-cp313-cp313-macosx_11_0_arm64.whl" in wheel_names(tmp_path / "pack")
    assert "native-1.0-cp313-cp313-macosx_14_0_arm64.whl" not in wheel_names(tmp_path / "pack")


def test_wheel_for_newer_system_is_rejected(
    index: FakeIndex, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert index.pack(tmp_path / "pack", "--systems", "linux-aarch64", "--python", "3.13") == 1
    assert (
        "error[LEARN306]: Linux ARM64, Python 3.13: no wheel for 'native>=1; extra == \"learn\"', which "
        "linkwright-1.0-py3-none-any.whl needs" in capsys.readouterr().err
    )


def test_damaged_and_missing_wheels_are_reported(pack: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["learn", "pack", "--check", str(pack)]) == 0
    file = pack / "wheels" / "pure-1.0-py3-none-any.whl"
    file.write_bytes(file.read_bytes()[:-1] + b"x")
    (pack / "wheels" / "pip-9.0-py3-none-any.whl").unlink()
    capsys.readouterr()
    assert main(["learn", "pack", "--check", str(pack)]) == 1
    errors = capsys.readouterr().err
    assert "error[LEARN305]: 'wheels/pure-1.0-py3-none-any.whl' is damaged or was changed" in errors
    assert "error[LEARN305]: 'wheels/pip-9.0-py3-none-any.whl' cannot be read: No such file" in errors


def test_package_missing_from_requirements_is_reported(pack: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = pack / "requirements" / "windows-py3.13.txt"
    before = path.read_text()
    path.write_text("".join(line for line in before.splitlines(keepends=True) if not line.startswith("pure")))
    sums = (pack / "SHA256SUMS").read_text().splitlines()
    lines = [line for line in sums if not line.endswith("windows-py3.13.txt")]
    (pack / "SHA256SUMS").write_text("\n".join(lines) + "\n")
    assert main(["learn", "pack", "--check", str(pack)]) == 1
    errors = capsys.readouterr().err
    assert "Windows, Python 3.13: no wheel for 'pure', which windows_only-1.0-py3-none-any.whl needs" in errors


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--systems", "window"], "error[LEARN301]: a pack cannot be made for the system 'window'"),
        (["--python", "3.9"], "error[LEARN301]: a pack cannot be made for Python '3.9'"),
        (["--extras", "lern"], "error[LEARN301]: a pack cannot contain the extra 'lern'"),
        (["--models", "voks-en"], "error[MODEL101]: there is no model 'voks-en'"),
        (["--docs", "."], "error[LEARN309]: '.' has no index.html"),
    ],
)
def test_unknown_options_are_errors(
    index: FakeIndex, tmp_path: Path, words: list[str], message: str, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert index.pack(tmp_path / "pack", *words) == 1
    errors = capsys.readouterr().err
    assert message in errors
    assert "hint" in errors


def test_folder_with_other_files_is_refused(
    index: FakeIndex, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "file").write_text("mine")
    assert index.pack(tmp_path / "mine", *LINUX_TARGET) == 1
    assert "error[LEARN307]" in capsys.readouterr().err
    assert [path.name for path in (tmp_path / "mine").iterdir()] == ["file"]
    assert main(["learn", "pack", "--check", str(tmp_path / "mine")]) == 1
    assert "is not a pack: No such file or directory" in capsys.readouterr().err


def test_wheel_missing_from_index_is_one_error(
    index: FakeIndex, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (index.folder / "pure-1.0-py3-none-any.whl").unlink()
    assert index.pack(tmp_path / "pack", *LINUX_TARGET) == 1
    errors = capsys.readouterr().err
    assert "error[LEARN303]: pip cannot download or build " in errors
    assert "Could not find a version that satisfies the requirement pure==1.0" in errors
    assert "repeat the command to continue" in errors


def test_wheel_with_wrong_hash_is_rejected(
    index: FakeIndex, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_wheel(index.folder, "pure", requires=["evil"])
    assert index.pack(tmp_path / "pack", *LINUX_TARGET) == 1
    assert "error[LEARN303]: pip cannot download or build " in capsys.readouterr().err


def test_source_that_needs_compiler_is_rejected(
    index: FakeIndex, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = write_source(index.folder, "source", tag="cp313-cp313-linux_x86_64")
    index.table["source 1.0"].update(package_entry(source))
    assert index.pack(tmp_path / "pack", *LINUX_TARGET) == 1
    assert "the wheel that was built from 'source-1.0.tar.gz' works only on this system" in capsys.readouterr().err


def test_pack_requires_both_linkwright_wheels(
    index: FakeIndex, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    index.own.pop()
    assert index.pack(tmp_path / "pack", *LINUX_TARGET) == 1
    assert "error[LEARN302]: a pack needs a wheel of linkwright and one of linkwright-core" in capsys.readouterr().err


def test_wheel_that_depends_on_local_files_is_rejected(
    index: FakeIndex, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_wheel(index.own[1].parent, "linkwright", requires=["linkwright-core @ file:///home/me/core"])
    assert index.pack(tmp_path / "pack", *LINUX_TARGET) == 1
    assert "depends on files of the computer that built it" in capsys.readouterr().err


@needs_limits
def test_full_disk_is_one_error(index: FakeIndex, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with full_disk(50):
        status = index.pack(tmp_path / "pack", *LINUX_TARGET)
    errors = capsys.readouterr().err
    assert status == 1
    assert "error[LEARN304]: cannot write '" in errors
    assert "free disk space" in errors


def test_documentation_is_copied_into_pack(index: FakeIndex, tmp_path: Path) -> None:
    (tmp_path / "site" / "zh").mkdir(parents=True)
    for name in ("index.html", "zh/index.html"):
        (tmp_path / "site" / name).write_text("page")
    assert index.pack(tmp_path / "pack", *LINUX_TARGET, "--docs", str(tmp_path / "site")) == 0
    assert (tmp_path / "pack" / "docs" / "zh" / "index.html").read_text() == "page"


@pytest.fixture
def installable(index: FakeIndex, tmp_path: Path) -> Path:
    """Create a pack for this system with the pip of this Python."""
    bundled = sorted((Path(ensurepip.__file__).parent / "_bundled").glob("pip-*.whl"))
    if not bundled or sys.platform != "linux" or sys.version_info >= (3, 15):
        pytest.skip("this Python has no pip")
    path = Path(shutil.copy(bundled[0], index.folder))
    version = path.name.split("-")[1]
    del index.table["pip 9.0"]  # type: ignore[attr-defined]
    index.table[f"pip {version}"] = package_entry(path)  # type: ignore[index]
    assert index.pack(tmp_path / "pack", "--systems", "linux-x86_64", "--python", _own_python_version()) == 0
    return tmp_path / "pack"


def _own_python_version() -> str:
    return f"{sys.version_info[0]}.{sys.version_info[1]}"


def install_pack(pack: Path, home: Path, *words: str, **variables: str) -> subprocess.CompletedProcess[str]:
    home.mkdir(exist_ok=True)
    environment = {"HOME": str(home), "PATH": "/usr/bin:/bin", "PYTHON": sys.executable, **variables}
    command = ["sh", str(pack / "install.sh"), *words]
    return subprocess.run(command, env=environment, capture_output=True, text=True, encoding="utf-8", check=False)


def test_installer_installs_and_runs_linkwright(installable: Path, tmp_path: Path) -> None:
    home = tmp_path / "home of a learner"
    result = install_pack(installable, home)
    assert (result.returncode, result.stderr) == (0, "")
    assert f". '{home}/linkwright/bin/activate'" in result.stdout
    assert "Linkwright 已安装" in result.stdout
    second_run = install_pack(installable, home)
    assert (second_run.returncode, second_run.stderr) == (0, "")


def test_installer_rejects_damaged_wheel(installable: Path, tmp_path: Path) -> None:
    write_wheel(installable / "wheels", "pure", requires=["other"])
    result = install_pack(installable, tmp_path / "home")
    assert result.returncode == 1
    assert "THESE PACKAGES DO NOT MATCH THE HASHES" in result.stderr
    assert "这一步失败了" in result.stderr


def test_installer_refuses_folder_that_is_not_an_environment(installable: Path, tmp_path: Path) -> None:
    (tmp_path / "home" / "linkwright").mkdir(parents=True)
    (tmp_path / "home" / "linkwright" / "homework.urdf").write_text("mine")
    result = install_pack(installable, tmp_path / "home")
    assert result.returncode == 1
    assert "exists and is not an environment of Python" in result.stderr
    assert "不是 Python 环境" in result.stderr


def test_installer_names_targets_of_pack(pack: Path, tmp_path: Path) -> None:
    shutil.rmtree(pack / "requirements")
    result = install_pack(pack, tmp_path / "home")
    assert result.returncode == 1
    assert "It has: windows, linux-x86_64; Python 3.12, 3.13." in result.stderr


def test_installer_gives_advice_without_python(pack: Path, tmp_path: Path) -> None:
    for name in ("install.sh",):
        script = (pack / name).read_text().replace("/usr/local/bin/", "/nowhere/")
        (pack / name).write_text(script)
    tools = tmp_path / "tools"
    tools.mkdir()
    for name in ("dirname", "uname", "cat", "sh"):
        (tools / name).symlink_to(shutil.which(name) or "")
    result = install_pack(pack, tmp_path / "home", PATH=str(tools), PYTHON="")
    assert result.returncode == 1
    assert "There is no Python that fits" in result.stderr
    assert "没有合适的 Python" in result.stderr


def test_installer_unpacks_python_archive_if_python_is_missing(pack: Path, tmp_path: Path) -> None:
    if sys.platform != "linux":
        pytest.skip("the archive is for Linux")
    (tmp_path / "python" / "bin").mkdir(parents=True)
    program = tmp_path / "python" / "bin" / "python3"
    program.write_text('#!/bin/sh\n[ "$1" = -c ] || echo "started $1"\n')
    program.chmod(0o755)
    (pack / "python").mkdir()
    machine = subprocess.run(["uname", "-m"], capture_output=True, text=True, check=True).stdout.strip()
    archive = pack / "python" / f"cpython-3.13.9+20261101-{machine}-unknown-linux-gnu-install_only.tar.gz"
    subprocess.run(["tar", "-czf", archive, "-C", tmp_path, "python"], check=True)
    tools = tmp_path / "tools"
    tools.mkdir()
    for name in ("dirname", "uname", "cat", "sh", "mkdir", "tar", "gzip"):
        (tools / name).symlink_to(shutil.which(name) or "")
    script = (pack / "install.sh").read_text().replace("/usr/local/bin/", "/nowhere/")
    (pack / "install.sh").write_text(script)
    result = install_pack(pack, tmp_path / "home", PATH=str(tools), PYTHON="")
    assert result.stdout == f"started {pack}/install.py\n"


def test_pack_json_has_version_systems_and_missing_parts(pack: Path) -> None:
    settings = json.loads((pack / "pack.json").read_text(encoding="utf-8"))
    assert settings["version"] == "1.0"
    assert settings["systems"] == ["windows", "linux-x86_64"]
    assert settings["missing"] == {}
