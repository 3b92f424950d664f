"""The first commands of the README, typed by a user with only a checkout."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path
from typing import Any

import pytest

from tests.docs.pages import READMES, read_blocks
from tests.places import REPOSITORY
from tests.waiting import wait_until

PAGE = Path("src", "linkwright", "page", "built")


def read_first_screen(readme: Path) -> list[str]:
    """Return the commands at the start of a README, without comments."""
    return [re.sub(r"\s+#.*", "", line) for line in read_blocks(readme)[0].text.splitlines()]


def test_both_readmes_begin_with_same_commands() -> None:
    english, chinese = map(read_first_screen, READMES)
    assert english == chinese


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """Return a copy of the repository's tracked files, and the page.

    The page takes a minute to build.
    """
    if not (REPOSITORY / PAGE).is_dir() or not (REPOSITORY / ".git").exists():
        pytest.skip("this checkout has no built page")
    folder = tmp_path / "checkout"
    file_names = run_shell(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=REPOSITORY
    ).stdout
    for name in file_names.split("\0")[:-1]:
        if not name.startswith(("benchmarks/", "docs/", "tests/")) and (REPOSITORY / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(REPOSITORY / name, folder / name)
    shutil.copytree(REPOSITORY / PAGE, folder / PAGE)
    return folder


def run_shell(command: list[str], **options: Any) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def write_program(path: Path, text: str) -> Path:
    path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
    path.chmod(0o755)
    return path


@pytest.fixture
def newcomer(tmp_path: Path) -> dict[str, str]:
    """Return an environment with Python and an empty home.

    Its browser only records the address.

    If uv exists, it replaces pip, because it has the wheels of the tests' own environment in its cache.
    """
    programs = tmp_path / "programs"
    programs.mkdir()
    environment = {
        name: value for name, value in os.environ.items() if name.startswith(("PIP_", "UV_", "SSL_", "ROS_"))
    }
    uv = shutil.which(os.environ.get("UV") or "uv") or shutil.which(REPOSITORY / ".build" / "uv" / "bin" / "uv")
    if uv:
        (programs / "uv").symlink_to(Path(uv).absolute())
        environment["UV_CACHE_DIR"] = run_shell([uv, "cache", "dir"]).stdout.strip()
        pip = write_program(programs / "uv-as-pip", 'exec uv pip "$@"')
        write_program(programs / "python3", f'{sys.executable} "$@" --without-pip && ln -s {pip} "$3/bin/pip"')
    else:
        (programs / "python3").symlink_to(sys.executable)
    return {
        **environment,
        "BROWSER": str(write_program(programs / "browser", f'echo "$1" >{tmp_path}/opened')),
        "HOME": str(tmp_path),
        "PATH": os.pathsep.join([str(programs), os.environ["PATH"]]),
    }


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt" or shutil.which("bash") is None, reason="the block is for a Unix shell")
def test_first_readme_commands_run_in_fresh_checkout(checkout: Path, newcomer: dict[str, str]) -> None:
    commands = "\n".join(read_first_screen(READMES[0]))
    with subprocess.Popen(
        ["bash", "-e", "-c", commands],
        cwd=checkout,
        env=newcomer,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    ) as shell:
        assert shell.stdout is not None
        messages = []
        try:
            for line in shell.stdout:
                messages.append(line)
                if match := re.search(r"Viewer: (http://\S+)", line):
                    break
            else:
                pytest.fail("".join(messages))
            with urllib.request.build_opener(urllib.request.ProxyHandler({})).open(match[1]) as response:
                assert response.status == 200
            wait_until((checkout.parent / "opened").is_file, what="the browser with the page")
        finally:
            os.killpg(shell.pid, signal.SIGINT)
            remaining_output = shell.stdout.read()
    assert shell.returncode in (0, 130, -signal.SIGINT), "".join(messages) + remaining_output

    # A missing extra is reported with the command that installs it, and this command works.
    export = "linkwright export robot.glb robots/my_robot_description/urdf/mbot_with_kinect.urdf"
    output = run_shell(["bash", "-c", f"source .venv/bin/activate; {export}"], cwd=checkout, env=newcomer)
    hint = re.search(r"hint: run (.*)", output.stderr)
    assert hint is not None, output.stderr
    assert "[mesh]" in hint[1]
    result = run_shell(
        ["bash", "-e", "-c", f"source .venv/bin/activate; {hint[1]}; {export}"], cwd=checkout, env=newcomer
    )
    assert result.returncode == 0, result.stderr
    assert (checkout / "robot.glb").is_file()
