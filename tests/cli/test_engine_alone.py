"""The engine without the rest: what linkwright-core is made of, and what its commands say without linkwright."""

from __future__ import annotations

import sys

import pytest

from linkwright import __version__
from linkwright.cli import main
from tests.places import REPOSITORY
from tests.toml_files import PROJECT, read_toml

CONTRACT = "The engine imports nothing else; linkwright-core is made of its modules (core/engine_build.py)"


def rooms() -> tuple[set[str], set[str]]:
    """The modules of the engine, and those that it may not import."""
    contracts = read_toml((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    (contract,) = (contract for contract in contracts["contracts"] if contract["name"] == CONTRACT)
    return set(contract["source_modules"]), set(contract["forbidden_modules"])


def test_each_room_is_in_the_engine_or_forbidden_to_it() -> None:
    engine, others = rooms()
    package = REPOSITORY / "src" / "linkwright"
    found = {f"linkwright.{folder.parent.name}" for folder in package.glob("*/__init__.py")} - {"linkwright.cli"}
    assert found == {name for name in engine | others if not name.startswith("linkwright.cli.")}


def test_linkwright_needs_the_engine_of_its_own_version() -> None:
    assert f"linkwright-core=={__version__}" in PROJECT["dependencies"]


@pytest.fixture
def alone(monkeypatch):
    """As with linkwright-core alone: a module that is None in this table cannot be imported."""
    for name in ("cli.workbench", "simulation", "viewer.notebook", "bag"):
        for loaded in [module for module in sys.modules if f"{module}.".startswith(f"linkwright.{name}.")]:
            monkeypatch.delitem(sys.modules, loaded)
        monkeypatch.setitem(sys.modules, f"linkwright.{name}", None)
    monkeypatch.setattr("linkwright.loading.extensions._all_groups", dict)


def test_the_help_lists_the_commands_of_the_engine(alone, capsys):
    assert main(["--help"]) == 0
    listed = [line.split()[0] for line in capsys.readouterr().out.splitlines() if line.startswith("  ")]
    assert listed == ["check", "format", "xacro", "diff", "explain", "inertia", "convert", "picture", "--lang"]


def test_other_commands_are_those_of_linkwright(alone, capsys):
    assert main(["view", "robot.urdf"]) == 2
    assert "only linkwright-core is installed, and linkwright has more commands" in capsys.readouterr().err


def test_mjcf_needs_linkwright(alone, capsys, tmp_path):
    (tmp_path / "robot.urdf").write_text("<robot name='r'><link name='base'/></robot>")
    assert main(["convert", str(tmp_path / "robot.urdf"), "--to", "mjcf"]) == 1
    assert "error[CLI323]" in capsys.readouterr().err


def test_names_of_linkwright_are_refused_with_the_reason(alone):
    import linkwright

    assert linkwright.load is not None
    with pytest.raises(ImportError, match="'show' needs linkwright; only linkwright-core is installed"):
        _ = linkwright.show
