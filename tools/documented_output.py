"""Bring the messages on the troubleshooting pages up to date with what the program prints.

Usage: python tools/documented_output.py [--check]

A section of these pages that can be tried has fenced blocks with titles (the files), one ``bash`` block (the command)
and one ``text`` block, which this program fills with what the command writes to standard error in a folder of these
files, in the language of the page. The launcher's own log lines are left out, because they differ in each run.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

DOCS = Path(__file__).resolve().parent.parent / "docs"
PAGES = (DOCS / "troubleshooting.md", DOCS / "zh" / "troubleshooting.md")

_SECTION = re.compile(r"(?=^## )", re.MULTILINE)
_FILE_BLOCK = re.compile(r'^```\w+ title="([^"]+)"\n(.*?)^```$', re.MULTILINE | re.DOTALL)
_COMMAND_BLOCK = re.compile(r"^```bash\nlinkwright (.*?)\n```$", re.MULTILINE)
_LAUNCH_LOG_LINE = re.compile(r"^\[INFO\] \[launch\]: .*\n", re.MULTILINE)
_OUTPUT_BLOCK = re.compile(r"(?<=^```text\n).*?(?=^```$)", re.MULTILINE | re.DOTALL)
_READERS_FOLDER = "/home/you/robots"
# The output must depend neither on the current folder nor on a sourced workspace.
_REMOVED_VARIABLES = ("AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH", "ROS_PACKAGE_PATH")


def refresh_page(page: str, language: str = "en") -> str:
    """Return the text of a page with current outputs."""
    return "".join(_refresh_section(section, language) for section in _SECTION.split(page))


def get_language(page: Path) -> str:
    """Return the language of a page, which is the name of its folder."""
    return "zh" if page.parent.name == "zh" else "en"


def run_command(words: Sequence[str], files: Sequence[tuple[str, str]], language: str = "en") -> str:
    """Return the standard error of ``linkwright`` with these arguments.

    It runs in a folder with these files (path, text).
    """
    environment = {name: value for name, value in os.environ.items() if name not in _REMOVED_VARIABLES}
    environment |= {"LINKWRIGHT_LANG": language, "LINKWRIGHT_DDS": "0"}
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files:
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        result = subprocess.run(
            [sys.executable, "-m", "linkwright", *words],
            cwd=folder,
            env=environment,
            capture_output=True,
            encoding="utf-8",
            timeout=60,
            check=False,
        )
    if result.returncode != 1:
        raise RuntimeError(f"linkwright {shlex.join(words)} exited with {result.returncode}, not 1:\n{result.stderr}")
    return _LAUNCH_LOG_LINE.sub("", result.stderr).replace(folder, _READERS_FOLDER)


def _refresh_section(section: str, language: str) -> str:
    command = _COMMAND_BLOCK.search(section)
    if command is None or _OUTPUT_BLOCK.search(section) is None:
        return section
    output = run_command(shlex.split(command[1]), _FILE_BLOCK.findall(section), language)
    return _OUTPUT_BLOCK.sub(lambda _: output, section, count=1)


def main(arguments: Sequence[str]) -> int:
    """Write the pages, or with ``--check`` report whether they are current."""
    stale = False
    for page in PAGES:
        old_text = page.read_text(encoding="utf-8")
        new_text = refresh_page(old_text, get_language(page))
        if old_text != new_text and "--check" in arguments:
            print(f"{page} is stale: run python tools/documented_output.py", file=sys.stderr)
            stale = True
        elif old_text != new_text:
            page.write_text(new_text, encoding="utf-8", newline="\n")
    return int(stale)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
