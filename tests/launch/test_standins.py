"""The stand-ins of `launch` and `launch_ros`: their names and imports."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import pytest

from linkwright import standins
from linkwright.standins.activation import LAUNCH_MODULES


def test_names_are_importable_from_ros_submodules() -> None:
    from launch.actions import DeclareLaunchArgument
    from launch.actions.declare_launch_argument import DeclareLaunchArgument as Deep

    assert Deep is DeclareLaunchArgument


def test_imported_real_launch_is_replaced(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    saved = {name: module for name, module in sys.modules.items() if name.partition(".")[0] in LAUNCH_MODULES}
    real = tmp_path / "launch"
    real.mkdir()
    (real / "__init__.py").write_text("REAL = True\n")
    try:
        for name in saved:
            del sys.modules[name]
        monkeypatch.syspath_prepend(str(tmp_path))
        assert importlib.import_module("launch").REAL
        standins.activate()
        assert not hasattr(importlib.import_module("launch"), "REAL")
    finally:
        for name in [name for name in sys.modules if name.partition(".")[0] in LAUNCH_MODULES]:
            del sys.modules[name]
        sys.modules.update(saved)


@pytest.mark.parametrize(
    ("module", "name"),
    [
        ("launch_ros.utilities", "normalize_parameters"),
        ("launch_ros.utilities", "to_parameters_list"),
        ("launch.frontend", "parse_substitution"),
        ("rosidl_runtime_py", "get_interfaces"),
    ],
)
def test_function_named_like_its_module_stays_callable(module: str, name: str) -> None:
    importlib.import_module(f"{module}.{name}")
    assert callable(getattr(importlib.import_module(module), name))
