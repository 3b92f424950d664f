from __future__ import annotations

import importlib
import re
import sys
from pathlib import Path

import pytest

from linkwright import standins
from linkwright.standins.activation import LAUNCH_MODULES

FOLDER = Path(standins.__file__).parent / "path"
MODULES = sorted(
    ".".join(path.relative_to(FOLDER).with_suffix("").parts).removesuffix(".__init__") for path in FOLDER.rglob("*.py")
)


@pytest.mark.parametrize("name", MODULES)
def test_every_module_can_be_imported_and_has_what_it_lists(name: str) -> None:
    module = importlib.import_module(name)
    for each in module.__all__:
        assert getattr(module, each) is not None


def test_the_stand_ins_hold_no_logic() -> None:
    for path in FOLDER.rglob("*.py"):
        assert not re.search(r"^\s*(def|class|if|for|while|try)\b", path.read_text(), re.MULTILINE), path


def test_all_of_a_module_is_also_where_ros_has_it() -> None:
    from launch.actions import DeclareLaunchArgument
    from launch.actions.declare_launch_argument import DeclareLaunchArgument as Deep

    assert Deep is DeclareLaunchArgument


def test_a_module_that_is_there_already_gives_way_for_a_launch(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
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
def test_a_function_with_the_name_of_its_module_stays_the_function(module: str, name: str) -> None:
    importlib.import_module(f"{module}.{name}")
    assert callable(getattr(importlib.import_module(module), name))
