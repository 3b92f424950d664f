"""Programs that nodes replace through entry points.

The nodes are from Linkwright and from other packages.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.model.replaced_programs import find_replacing_node, load_replaced_programs
from linkwright.loading import extensions
from linkwright.nodes.node_command import NodeCommand
from linkwright.shell import write_programs

NOWHERE = {"PATH": "/nowhere"}


def parse_sail(words: Sequence[str]) -> NodeCommand | None:
    """Parse a command line of a third-party simulator."""
    return NodeCommand("my_sea", "boat", {"wind": float(words[2])}) if words[1:2] == ["sail"] else None


@pytest.fixture
def installed_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    metadata = tmp_path / "my_sea-1.0.dist-info"
    metadata.mkdir()
    (metadata / "entry_points.txt").write_text(
        f"[linkwright.replaced_programs]\nsea = {__name__}:parse_sail\nsunk = my_sea_that_is_not_there:sail\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    extensions._read_all_groups.cache_clear()
    yield
    extensions._read_all_groups.cache_clear()


@pytest.mark.parametrize("name", [*load_replaced_programs()])
def test_builtin_replacements_can_be_imported(name: str) -> None:
    assert callable(load_replaced_programs()[name].load())


def test_program_of_another_package_is_replaced(installed_package: None) -> None:
    assert find_replacing_node(["/opt/bin/sea", "sail", "3"], NOWHERE) == NodeCommand("my_sea", "boat", {"wind": 3.0})
    assert find_replacing_node(["ruby", "sea", "sail", "3"], NOWHERE) == NodeCommand("my_sea", "boat", {"wind": 3.0})
    assert find_replacing_node(["sea", "--version"], NOWHERE) is None
    assert find_replacing_node(["lake", "sail", "3"], NOWHERE) is None
    assert find_replacing_node([], NOWHERE) is None


def test_installed_program_is_not_replaced(installed_package: None, tmp_path: Path) -> None:
    program = tmp_path / "sea"
    program.touch(mode=0o755)
    assert find_replacing_node(["sea", "sail", "3"], {"PATH": str(tmp_path)}) is None
    assert find_replacing_node([str(program), "sail", "3"], NOWHERE) is None


def test_own_program_of_the_name_is_replaced(tmp_path: Path) -> None:
    write_programs(tmp_path)
    for program in ("gz", str(tmp_path / "gz")):
        replacement = find_replacing_node([program, "sim", "-r", "empty.sdf"], {"PATH": str(tmp_path)})
        assert replacement is not None
        assert (replacement.package, replacement.parameters["world"]) == ("ros_gz_sim", "empty.sdf")
    assert find_replacing_node(["gz", "service", "-l"], {"PATH": str(tmp_path)}) is None


def test_failed_import_names_the_package(installed_package: None) -> None:
    with pytest.raises(LinkwrightError, match="the node that replaces 'sunk' cannot be imported") as caught:
        find_replacing_node(["sunk"], NOWHERE)
    assert caught.value.diagnostics[0].code == "NODE002"
    assert "fix the Python package 'my_sea'" in str(caught.value.diagnostics[0].hint)
