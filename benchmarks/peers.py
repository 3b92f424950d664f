"""The peers: programs of PyPI that Linkwright is compared with.

They are installed into ``.build/peers`` and imported from there. Peers are not dependencies of the project. ``python -m
benchmarks.peers`` installs them, which takes some minutes; a peer that cannot be installed is left out, which the
measurements report.
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
REQUIREMENTS = {
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
"""The requirement that provides each module."""


def install() -> list[str]:
    """Install missing peers, and return the modules that could not be installed."""
    if not (FOLDER / "pyvenv.cfg").is_file():
        venv.create(FOLDER, with_pip=True)
    missing = []
    for module, package in REQUIREMENTS.items():
        if get_version(module) is not None:
            continue
        words = [str(FOLDER / "bin" / "python"), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        if subprocess.run([*words, package], check=False, stderr=subprocess.DEVNULL).returncode != 0:
            missing.append(module)
    return missing


def get_site_packages() -> Path:
    """Return the folder of the peers."""
    return FOLDER / "lib" / f"python{sys.version_info.major}.{sys.version_info.minor}" / "site-packages"


def get_version(module: str) -> str | None:
    """Return the version of a peer, or None if it is not installed."""
    name = REQUIREMENTS[module].partition("==")[0]
    distributions = list(metadata.distributions(name=name, path=[str(get_site_packages())]))
    return distributions[0].version if distributions else None


def load_module(module: str, part: str | None = None) -> types.ModuleType | None:
    """Import and return a peer or one of its modules.

    Returns None if it is not installed or cannot be imported. What both need, such as numpy, is ours.
    """
    if get_version(module) is None:
        return None
    for folder in (get_site_packages(), *get_site_packages().glob("cmeel.prefix/lib/python3*/site-packages")):
        if str(folder) not in sys.path:
            sys.path.append(str(folder))
    try:
        return importlib.import_module(part or module)
    except Exception as error:  # noqa: BLE001 - a peer may fail in any way; the others are still measured
        print(f"{module} does not import here: {type(error).__name__}: {error}", file=sys.stderr)
        return None


def find_command(name: str) -> str | None:
    """Return the path of a peer's command, or None if it is not installed."""
    path = FOLDER / "bin" / name
    return str(path) if path.is_file() else None


if __name__ == "__main__":
    for absent in install():
        print(f"{REQUIREMENTS[absent]} cannot be installed here", file=sys.stderr)
    for peer in REQUIREMENTS:
        print(f"{peer} {get_version(peer) or 'not installed'}")
