"""The programs that we are measured against: installed from PyPI into ``.build/peers``, imported from there.

They are no dependencies of the project. ``python -m benchmarks.peers`` installs them, which takes some minutes; a peer
that cannot be installed here is left out, and the measurements say so.
"""

from __future__ import annotations

import importlib
import subprocess
import sys
import types
import venv
from importlib import metadata
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[1] / ".build" / "peers"
PEERS = {
    "xacro": "xacro==2.1.1",
    "urdf_parser_py": "urdf-parser-py",
    "yourdfpy": "yourdfpy",
    "urchin": "urchin",
    "pinocchio": "pin",
    "pybullet": "pybullet",
    "zenoh_ros2_sdk": "zenoh-ros2-sdk==0.1.8",
    "viser": "viser==1.1.1",
    "trimesh": "trimesh",
}
"""Module -> what is installed for it."""


def install() -> list[str]:
    """Install the peers that are not there yet; the modules that could not be."""
    if not (FOLDER / "pyvenv.cfg").is_file():
        venv.create(FOLDER, with_pip=True)
    missing = []
    for module, package in PEERS.items():
        if version(module) is not None:
            continue
        words = [str(FOLDER / "bin" / "python"), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        if subprocess.run([*words, package], check=False, stderr=subprocess.DEVNULL).returncode != 0:
            missing.append(module)
    return missing


def site_packages() -> Path:
    """Return the folder of the peers."""
    return FOLDER / "lib" / f"python{sys.version_info.major}.{sys.version_info.minor}" / "site-packages"


def version(module: str) -> str | None:
    """Return the version of a peer, or None if it is not installed."""
    name = PEERS[module].partition("==")[0]
    distributions = list(metadata.distributions(name=name, path=[str(site_packages())]))
    return distributions[0].version if distributions else None


def load(module: str, part: str | None = None) -> types.ModuleType | None:
    """A peer, or one of its modules, imported into this process; None when it is not installed or does not import.

    What both need, such as numpy, is ours.
    """
    if version(module) is None:
        return None
    for folder in (site_packages(), *site_packages().glob("cmeel.prefix/lib/python3*/site-packages")):
        if str(folder) not in sys.path:
            sys.path.append(str(folder))
    try:
        return importlib.import_module(part or module)
    except Exception as error:  # noqa: BLE001 - a peer may fail in any way; the others are still measured
        print(f"{module} does not import here: {type(error).__name__}: {error}", file=sys.stderr)
        return None


def command(name: str) -> str | None:
    """Return the path of a peer's command, or None if it is not installed."""
    path = FOLDER / "bin" / name
    return str(path) if path.is_file() else None


if __name__ == "__main__":
    for absent in install():
        print(f"{PEERS[absent]} cannot be installed here", file=sys.stderr)
    for peer in PEERS:
        print(f"{peer} {version(peer) or 'not installed'}")
