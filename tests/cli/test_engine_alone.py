"""The engine without linkwright.

The tests cover the contents of linkwright-core, and the output of its commands.
"""

from __future__ import annotations

import sys

import pytest

from linkwright import __version__
from linkwright.cli import main
from tests.places import REPOSITORY
from tests.toml_files import PROJECT, read_toml

CONTRACT = "The engine imports nothing else; linkwright-core is made of its modules (core/engine_build.py)"


def read_rooms() -> tuple[set[str], set[str]]:
    """Return the modules of the engine, and the modules that it must not import."""
    contracts = read_toml((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    (contract,) = (contract for contract in contracts["contracts"] if contract["name"] == CONTRACT)
    return set(contract["source_modules"]), set(contract["forbidden_modules"])


def test_every_package_is_in_engine_or_excluded() -> None:
    engine, other_rooms = read_rooms()
    package = REPOSITORY / "src" / "linkwright"
    found_rooms = {f"linkwright.{folder.parent.name}" for folder in package.glob("*/__init__.py")} - {"linkwright.cli"}
    assert found_rooms == {name for name in engine | other_rooms if not name.startswith("linkwright.cli.")}


def test_linkwright_requires_same_version_of_linkwright_core() -> None:
    assert f"linkwright-core=={__version__}" in PROJECT["dependencies"]


@pytest.fixture
def alone(monkeypatch):
    """Simulate an installation of linkwright-core alone.

    Modules that are None in this table cannot be imported.
    """
    for name in ("cli.workbench", "simulation", "viewer.notebook", "bag"):
        for loaded in [module for module in sys.modules if f"{module}.".startswith(f"linkwright.{name}.")]:
            monkeypatch.delitem(sys.modules, loaded)
        monkeypatch.setitem(sys.modules, f"linkwright.{name}", None)
    monkeypatch.setattr("linkwright.loading.extensions._read_all_groups", dict)


def test_help_lists_engine_commands(alone, capsys):
    assert main(["--help"]) == 0
    commands = [line.split()[0] for line in capsys.readouterr().out.splitlines() if line.startswith("  ")]
    assert commands == ["check", "format", "xacro", "diff", "explain", "inertia", "convert", "picture", "--lang"]


def test_other_commands_require_linkwright(alone, capsys):
    assert main(["view", "robot.urdf"]) == 2
    assert "only linkwright-core is installed, and linkwright has more commands" in capsys.readouterr().err


def test_mjcf_requires_linkwright(alone, capsys, tmp_path):
    (tmp_path / "robot.urdf").write_text("<robot name='r'><link name='base'/></robot>")
    assert main(["convert", str(tmp_path / "robot.urdf"), "--to", "mjcf"]) == 1
    assert "error[CLI323]" in capsys.readouterr().err


def test_importing_linkwright_names_explains_missing_package(alone):
    import linkwright

    assert linkwright.load is not None
    with pytest.raises(ImportError, match="'show' needs linkwright; only linkwright-core is installed"):
        _ = linkwright.show
