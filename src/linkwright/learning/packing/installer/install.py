"""Install Linkwright from this folder, offline and without administrator rights.

Usage: python install.py [FOLDER]

FOLDER is the installation folder, by default ~/linkwright. The scripts install.sh, install.command and install.bat run
this file with a suitable Python. The file belongs to a pack of ``linkwright learn pack``, and imports only modules of
the standard library.
"""

from __future__ import annotations

import json
import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

PACK = Path(__file__).resolve().parent
_SYSTEMS = {"Windows": "windows", "Darwin": "macos-{machine}", "Linux": "linux-{machine}"}
_MACHINES = {"amd64": "x86_64", "x86_64": "x86_64", "arm64": "arm64", "aarch64": "aarch64"}
_IS_WINDOWS = os.name == "nt"


class InstallationError(Exception):
    """Raised if the installation is not possible.

    The arguments are the reason in English and in Chinese.
    """


def install(target_folder: Path) -> None:
    """Install Linkwright into a folder.

    Raises:
        InstallationError: the installation is not possible.
    """
    settings = json.loads((PACK / "pack.json").read_text(encoding="utf-8"))
    target = _find_target(settings)
    _print_in_both_languages(f"Linkwright {settings['version']}: {target} -> {target_folder}")
    python = _make_environment(target_folder)
    _print_in_both_languages(
        "Installing the packages; this takes one to five minutes.", "正在安装软件包，需要一到五分钟。"
    )
    (pip,) = (PACK / "wheels").glob("pip-*.whl")
    arguments = ["install", "--isolated", "--disable-pip-version-check", "--no-cache-dir", "--quiet", "--no-index"]
    arguments += ["--find-links", str(PACK / "wheels"), "--require-hashes"]
    _run([str(python), str(pip / "pip"), *arguments, "-r", str(PACK / "requirements" / f"{target}.txt")])
    program = python.with_name("linkwright.exe" if _IS_WINDOWS else "linkwright")
    for model in settings["models"]:
        _run([str(program), "models", "get", model, "--from", str(PACK / "models")])
    _copy_new(PACK / "worlds" / "fuel", Path.home() / ".gz" / "fuel")
    _copy_new(PACK / "worlds" / "gazebo", Path.home() / ".gazebo" / "models")
    _copy_new(PACK / "docs", target_folder / "docs")
    _verify(program, python, settings["version"])
    _print_next_steps(target_folder, settings["missing"].get(target, {}))


def _find_target(settings: dict[str, Any]) -> str:
    """Return the name of the target for this system and Python, if the folder has it."""
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    machine = _MACHINES.get(platform.machine().lower(), platform.machine().lower())
    system = _SYSTEMS.get(platform.system(), platform.system()).format(machine=machine)
    if sys.maxsize < 2**32:
        raise InstallationError(
            f"{sys.executable} is a 32-bit Python. Install a 64-bit one.",
            f"{sys.executable} 是 32 位 Python。请安装 64 位版本。",
        )
    if _IS_WINDOWS and machine != "x86_64":
        raise InstallationError(
            "This folder has packages for Windows on Intel and AMD processors. Install Python for x86-64.",
            "本目录只有 Intel 和 AMD 处理器的 Windows 软件包。请安装 x86-64 版本的 Python。",
        )
    target = f"{system}-py{version}"
    if not (PACK / "requirements" / f"{target}.txt").is_file():
        systems, pythons = ", ".join(settings["systems"]), ", ".join(settings["pythons"])
        raise InstallationError(
            f"This folder has no packages for {system} with Python {version}. It has: {systems}; Python {pythons}.",
            f"本目录没有 {system} 加 Python {version} 的软件包。现有：{systems}；Python {pythons}。",
        )
    return target


def _make_environment(folder: Path) -> Path:
    """Create a virtual environment, or reuse the existing one, and return its Python."""
    if folder.exists() and not (folder / "pyvenv.cfg").is_file() and (not folder.is_dir() or any(folder.iterdir())):
        raise InstallationError(
            f"{folder} exists and is not an environment of Python. Name another folder: install FOLDER",
            f"{folder} 已存在，而且不是 Python 环境。请指定另一个目录：install 目录",
        )
    _run([sys.executable, "-m", "venv", "--without-pip", str(folder)])
    return folder / ("Scripts/python.exe" if _IS_WINDOWS else "bin/python")


def _run(arguments: list[str]) -> str:
    """Run a program and return its standard output. Its standard error is shown to the user."""
    variables = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "PIP_"))}
    try:
        done = subprocess.run(  # noqa: S603 - only Linkwright's own arguments
            arguments, env=variables, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, encoding="utf-8",
            errors="replace", check=False,
        )  # fmt: skip
    except OSError as error:
        raise InstallationError(f"{arguments[0]}: {error}", f"无法运行 {arguments[0]}") from None
    if done.returncode:
        lines = done.stdout.strip().splitlines()[-12:]
        raise InstallationError(
            "\n".join([f"This step failed: {' '.join(arguments[:4])} ...", *lines]), "这一步失败了。"
        )
    return done.stdout


def _copy_new(source: Path, target: Path) -> None:
    """Copy the files of a folder, which need not exist, unless the target already has them."""
    for path in sorted(source.rglob("*")) if source.is_dir() else ():
        copy = target / path.relative_to(source)
        if path.is_file() and not copy.exists():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, copy)


def _verify(program: Path, python: Path, version: str) -> None:
    """Verify the installation by its version and a check of the shipped robot."""
    _print_in_both_languages("Trying it.", "正在试运行。")
    printed = _run([str(program), "--version"]).strip()
    if printed != f"linkwright {version}":
        raise InstallationError(
            f"{program} --version prints {printed!r}, not version {version}", f"版本不是 {version}：{printed}"
        )
    code = "import linkwright, pathlib; print(pathlib.Path(linkwright.__path__[0], 'robots', 'my_robot_description'))"
    robot = Path(_run([str(python), "-c", code]).strip(), "urdf", "mbot_with_laser.urdf")
    _run([str(program), "check", str(robot)])


def _print_next_steps(folder: Path, missing: dict[str, list[str]]) -> None:
    if missing:
        _print_in_both_languages(
            "\nOn this system with this Python there is no package for:",
            "这个系统加这个 Python 版本没有以下部分的软件包：",
        )
        for english, chinese in zip(missing["en"], missing["zh"], strict=True):
            _print_in_both_languages(f"  - {english}", f"    {chinese}")
    activate = f"{folder}\\Scripts\\activate.bat" if _IS_WINDOWS else f". '{folder}/bin/activate'"
    _print_in_both_languages(
        "\nLinkwright is installed. In a new terminal:", "Linkwright 已安装。打开一个新终端，输入："
    )
    _print_in_both_languages(f"\n    {activate}", "    linkwright learn\n")
    if (folder / "docs" / "index.html").is_file():
        _print_in_both_languages(f"Documentation / 文档: {folder / 'docs' / 'index.html'}")
    _print_in_both_languages(f"To remove it, delete the folder {folder}.", f"要卸载，删除目录 {folder} 即可。")


def _print_in_both_languages(*lines: str) -> None:
    print(*lines, sep="\n", flush=True)


def main(arguments: list[str]) -> int:
    """Install Linkwright, and return the exit status."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(encoding="utf-8", errors="replace")
    try:
        install(Path(arguments[0]).expanduser().absolute() if arguments else Path.home() / "linkwright")
    except InstallationError as error:
        print(*error.args, sep="\n", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"{error.filename}: {error.strerror}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
