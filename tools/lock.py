"""Keep ``uv.lock`` without download addresses, and install from it with its hashes.

uv writes the address of the package index into every line of its lock file. This repository names no index: the
committed file keeps names, versions, markers and hashes, and whichever index uv is set up with is asked.

Usage:
    python tools/lock.py update [--upgrade]   resolve again and write uv.lock (needs uv)
    python tools/lock.py constraints          print the locked versions with hashes, for ``uv pip install -c``
    python tools/lock.py check                exit 1 when uv.lock holds an address
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LOCK = ROOT / "uv.lock"
_COPIED_FILES = (
    "pyproject.toml",
    "README.md",
    "LICENSE",
    "core/LICENSE",
    "core/README.md",
    "core/engine_build.py",
    "core/pyproject.toml",
    "hatch_build.py",
    "tools/build_page.py",
    "tools/package_readme.py",
    "src/linkwright/_version.py",
)


def remove_addresses(text: str) -> str:
    """Return the text of the lock file without addresses.

    The table ``package.metadata`` is also removed. Without it, uv uses the file as a list of preferred versions, and
    resolves them with its configured index instead of failing because of missing addresses.
    """
    text = re.sub(r'source = \{ registry = "[^"]+" \}', 'source = { registry = "index" }', text)
    text = re.sub(r'url = "[^"]*/([^"/]+)"', r'path = "\1"', text)
    return re.sub(r"\n\[package\.metadata[^\]]*\]\n(?:.+\n)*", "", text)


def format_constraints(text: str) -> str:
    """Return a line ``name==version ; marker --hash=...`` for each locked package."""
    lines = []
    for block in text.split("[[package]]\n")[1:]:
        if '\nsource = { registry = "index" }\n' not in block:
            continue
        name = _get_value(block, "name")
        version = _get_value(block, "version")
        markers = re.search(r"resolution-markers = \[\n((?:.+\n)*?)\]", block)
        condition = ""
        if markers:
            parts = re.findall(r'"([^"]+)"', markers[1])
            condition = " ; " + " or ".join(f"({part})" for part in parts)
        hashes = " ".join(f"--hash={digest}" for digest in re.findall(r'hash = "([^"]+)"', block))
        lines.append(f"{name}=={version}{condition} {hashes}")
    return "\n".join(lines) + "\n"


def _get_value(block: str, key: str) -> str:
    match = re.search(rf'^{key} = "([^"]+)"', block, re.MULTILINE)
    if not match:
        raise SystemExit(f"uv.lock: a package without {key}")
    return match[1]


def update(extra: list[str]) -> None:
    """Resolve in a copy, so that the working tree never holds an address."""
    uv = shutil.which(os.environ.get("UV") or "uv")
    if not uv:
        raise SystemExit("uv is not on the PATH; run `make lock`")
    with tempfile.TemporaryDirectory() as folder:
        for name in _COPIED_FILES:
            target = Path(folder) / name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, target)
        if LOCK.exists():
            shutil.copy(LOCK, Path(folder) / "uv.lock")
        subprocess.run([Path(uv).absolute(), "lock", *extra], cwd=folder, check=True)
        text = (Path(folder) / "uv.lock").read_text(encoding="utf-8")
    LOCK.write_text(remove_addresses(text), encoding="utf-8")


def main() -> int:
    """Run the action that the first argument names."""
    action, *extra = sys.argv[1:] or [""]
    if action == "update":
        update(extra)
    elif action == "constraints":
        sys.stdout.write(format_constraints(LOCK.read_text(encoding="utf-8")))
    elif action == "check":
        if "://" in LOCK.read_text(encoding="utf-8"):
            print("uv.lock holds addresses: run `make lock`", file=sys.stderr)
            return 1
    else:
        print(__doc__, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
