"""The first impression: badges, image, the README on a package index, and `make demo`."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys

import pytest
from PIL import Image

from linkwright.cli.command import SUMMARY_HELP, create_parser
from linkwright.cli.language import translate_help
from linkwright.diagnostics.translation import set_language
from tests.docs.pages import DOCS, READMES
from tests.places import REPOSITORY
from tests.repository_tools import load_tool
from tests.toml_files import PROJECT

PICTURE = REPOSITORY / "docs" / "images" / "mbot.webp"


@pytest.mark.parametrize("page", READMES, ids=lambda page: page.name)
def test_badges_match_project_metadata(page):
    labels = re.findall(r"^\[!\[([^\]]+)\]", page.read_text(encoding="utf-8"), re.MULTILINE)
    oldest = PROJECT["requires-python"].removeprefix(">=")
    status = next(line.split(" - ")[1] for line in PROJECT["classifiers"] if line.startswith("Development Status"))
    assert labels == [
        f"Python {oldest} and newer",
        f"License: {PROJECT['license']}",
        f"Status: {status.lower()}",
    ]


@pytest.mark.parametrize(
    ("page", "language"),
    [(READMES[0], "en"), (READMES[1], "zh"), (DOCS / "index.md", "en"), (DOCS / "zh" / "index.md", "zh")],
)
def test_summary_matches_project_description(page, language):
    set_language(language)
    try:
        assert f"\n**{translate_help(SUMMARY_HELP)}**\n" in page.read_text(encoding="utf-8")
    finally:
        set_language(None)
    assert PROJECT["description"] == SUMMARY_HELP


def test_animation_lasts_ten_seconds_and_is_small():
    assert PICTURE.stat().st_size < 2_000_000
    with Image.open(PICTURE) as image:
        durations = []
        for number in range(image.n_frames):
            image.seek(number)
            image.load()
            durations.append(image.info["duration"])
    assert len(durations) > 20
    assert 8_000 <= sum(durations) <= 12_000


def test_package_readme_has_no_relative_links():
    text = load_tool("package_readme").make_package_readme()
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    assert [target for target in re.findall(r"\]\(([^)]*)\)", prose) if not target.startswith("https://")] == []
    assert "build mbot from an empty folder: its description," in " ".join(prose.replace("*", "").split())


def test_package_readme_installs_from_index():
    commands = re.findall(r"\b(?:pip|pipx|uv tool) install [^\n`]+", load_tool("package_readme").make_package_readme())
    assert sorted(set(commands)) == [
        "pip install 'linkwright[all]'",
        "pip install linkwright",
        "pipx install linkwright",
        "uv tool install linkwright",
    ]


def write_script(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
    path.chmod(0o755)
    return path


def make_demo(folder, *variables):
    """Run `make demo` in a separate folder and, as in a terminal, in a separate process group."""
    if shutil.which("make") is None or os.name == "nt":
        pytest.skip("make is not installed")
    shutil.copy(REPOSITORY / "Makefile", folder)
    (folder / "frontend").mkdir()
    make_variables = ("MAKEFLAGS", "MAKELEVEL", "MFLAGS", "VERSION")  # of the make that runs the tests
    return subprocess.run(
        ["make", "demo", *variables],
        check=False,
        cwd=folder,
        env={name: value for name, value in os.environ.items() if name not in make_variables},
        capture_output=True,
        text=True,
        start_new_session=True,
    )


def pretend_installed(folder, linkwright):
    """Return the variables and options with which make considers the program installed."""
    write_script(folder / "bin" / "linkwright", linkwright)
    return [f"BIN={folder / 'bin'}", "VENV=.", "-o", "./.ready", f"PYTHON={sys.executable}"]


def test_make_reports_unsupported_python_in_one_line(tmp_path):
    old = write_script(tmp_path / "old", 'echo "is 3.8"')
    result = make_demo(tmp_path, f"PYTHON={old}")
    assert result.returncode == 2
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    assert f"Linkwright needs Python 3.10 or newer, and {old} is 3.8" in line


def test_make_demo_interrupt_prints_no_make_error(tmp_path):
    """Ctrl-C reaches make, its shell and the program."""
    program = "trap 'echo ended; exit 130' INT\nkill -INT 0\nwhile :; do sleep 0.1; done"
    result = make_demo(tmp_path, *pretend_installed(tmp_path, program))
    assert "ended" in result.stdout
    assert result.stderr == ""


def test_make_demo_runs_playground_with_laser_and_camera(tmp_path):
    result = make_demo(tmp_path, *pretend_installed(tmp_path, "echo $@"), "ARGS=--no-open")
    command, *words = result.stdout.split()
    assert command == "sim"
    arguments = create_parser("sim").parse_args(words)
    assert (arguments.world, arguments.values) == ("playground", ["laser:=true", "camera:=true"])
    assert (REPOSITORY / arguments.robot).is_file()
    assert arguments.no_open


def test_make_demo_reports_failure(tmp_path):
    assert make_demo(tmp_path, *pretend_installed(tmp_path, "exit 1")).returncode == 2
