"""Making the stand-ins importable under the names of the modules they stand in for."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

_FOLDER = Path(__file__).parent / "path"

LAUNCH_MODULES = ("launch", "launch_ros", "ament_index_python", "xacro")
"""What launch files import. These are always ours when Linkwright runs a launch file, beside a sourced ROS too:
the real ones would describe the launch to a launcher that is not running."""


def activate() -> None:
    """Let launch files be imported; may be called again.

    The folder of the stand-ins is the last on ``sys.path``: a module that is installed comes before ours of the same
    name, with the exception of `LAUNCH_MODULES`.
    """
    folder = str(_FOLDER)
    if folder not in sys.path:
        sys.path.append(folder)
    missing = [name for name in LAUNCH_MODULES if not _is_ours(name)]
    if not missing:
        return
    for name in [name for name in sys.modules if name.partition(".")[0] in missing]:
        del sys.modules[name]
    sys.path.insert(0, folder)
    try:
        for name in missing:
            importlib.import_module(name)
    finally:
        sys.path.remove(folder)


def _is_ours(name: str) -> bool:
    file = getattr(sys.modules.get(name), "__file__", None)
    return file is not None and Path(file).is_relative_to(_FOLDER)
