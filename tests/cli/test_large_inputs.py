"""The work and output of `check` grow linearly with its input.

The tests count calls and characters.
"""

from __future__ import annotations

import io
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.diagnostics import Diagnostic, Severity, phrase, print_diagnostics
from linkwright.diagnostics.render import MAX_PRINTED
from linkwright.urdf import tree_text
from linkwright.urdf.listing import MAX_INDENTED_LEVELS
from linkwright.urdf.model import Joint, Link, Robot
from linkwright.xmltree import positions
from tests.places import REPOSITORY


def chain_robot(count: int) -> str:
    parts = "".join(
        f'<link name="l{i}"/><joint name="j{i}" type="fixed"><parent link="l{i - 1}"/><child link="l{i}"/></joint>\n'
        for i in range(1, count)
    )
    return f'<link name="l0"/>{parts}'


def star_robot(count: int) -> str:
    parts = "".join(
        f'<link name="l{i}"/><joint name="j{i}" type="fixed"><parent link="l0"/><child link="l{i}"/></joint>\n'
        for i in range(1, count)
    )
    return f'<link name="l0"/>{parts}'


def robot_with_attributes(count: int) -> str:
    return f'<link name="l0" {" ".join(f"""a{i}="1" """ for i in range(count))}/>'


def robot_with_unknown_elements(count: int) -> str:
    return f'<link name="l0">{"".join(f"<foo{i}/>" for i in range(count))}</link>'


def robot_with_wrong_numbers(count: int) -> str:
    box = '<visual><geometry><box size="1 x"/></geometry></visual>\n'
    return f'<link name="l0">{box * count}</link>'


def robot_with_properties(count: int) -> str:
    parts = "".join(f'<xacro:property name="p{i}" value="{i}"/>\n' for i in range(count))
    return f'{parts}<link name="a${{p{count - 1}}}"/>'


def robot_with_macros(count: int) -> str:
    return "".join(
        f'<xacro:macro name="m{i}" params="x"><link name="${{x}}"/></xacro:macro><xacro:m{i} x="l{i}"/>\n'
        for i in range(count)
    )


def robot_with_texts(count: int) -> str:
    return '<link name="a"/>' + "text<!-- c -->" * count


ROBOT_MAKERS = [
    chain_robot,
    star_robot,
    robot_with_attributes,
    robot_with_unknown_elements,
    robot_with_wrong_numbers,
    robot_with_properties,
    robot_with_macros,
    robot_with_texts,
]


def measure_work(
    make: Callable[[int], str], count: int, folder: Path, capsys: pytest.CaptureFixture[str]
) -> tuple[int, int]:
    """Return the function calls and the printed characters of `check`.

    The input has a given size.
    """
    path = folder / f"{count}" / "r.xacro"
    path.parent.mkdir()
    path.write_text(f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{make(count)}</robot>')
    calls = 0

    def count_call(_frame: object, event: str, _argument: object) -> None:
        nonlocal calls
        calls += event in ("call", "c_call")

    capsys.readouterr()
    sys.setprofile(count_call)
    try:
        main(["check", str(path)])
    finally:
        sys.setprofile(None)
    printed = capsys.readouterr()
    return calls, len(printed.out) + len(printed.err)


@pytest.mark.parametrize("make", ROBOT_MAKERS, ids=lambda make: make.__name__)
def test_check_work_is_linear_in_input_size(
    make: Callable[[int], str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    measure_work(make, 20, tmp_path, capsys)  # imports modules and fills caches
    few, many = (measure_work(make, count, tmp_path, capsys) for count in (300, 1200))
    assert many[0] < few[0] * 6
    assert many[1] < few[1] * 6 + 2000


def test_tree_indentation_of_long_chain_is_limited() -> None:
    count = 20_000
    names = [f"l{number}" for number in range(count)]
    joints = {
        f"j{number}": Joint(f"j{number}", "fixed", names[number - 1], names[number]) for number in range(1, count)
    }
    robot = Robot("r", "l0", {name: Link(name) for name in names}, joints, {})
    lines = tree_text(robot).splitlines()
    assert len(lines) == count + 2
    assert lines[MAX_INDENTED_LEVELS + 2] == f"{'    ' * MAX_INDENTED_LEVELS}child(1):  l{MAX_INDENTED_LEVELS}"
    assert lines[-1] == f"{'    ' * MAX_INDENTED_LEVELS}child(1):  l{count - 1}"


def test_many_findings_print_errors_and_count() -> None:
    diagnostics = [Diagnostic("LW101", phrase("warning"), severity=Severity.WARNING) for _ in range(2_000)]
    diagnostics += [Diagnostic("LW102", phrase("mistake"))] * 3
    stream = io.StringIO()
    print_diagnostics(diagnostics, stream)
    lines = stream.getvalue().splitlines()
    assert len(lines) == MAX_PRINTED + 1
    assert sum("mistake" in line for line in lines) == 3
    assert lines[-1] == "... and 1,503 more findings"


def test_tag_attributes_are_parsed_once() -> None:
    names = [f"a{number}" for number in range(20_000)]
    text = "<x " + " ".join(f'{name}="1"' for name in names) + "/>"
    first = positions.attribute_value_range(text, 0, names[0])
    ranges = positions._read_last[2]
    assert positions.attribute_name_range(text, 0, names[-1]) == (len(text) - 12, len(text) - 6)
    assert first == (7, 8)
    assert positions._read_last[2] is ranges
    assert positions.attribute_value_range(text, 0, "none") is None


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no named pipes")
def test_named_pipe_beside_file_is_not_opened(tmp_path: Path) -> None:
    path = tmp_path / "r.xacro"
    path.write_text('<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="a"/></robot>')
    (tmp_path / "package.xml").write_text("<package format='3'><name>p</name></package>")
    for name in ("pipe.xacro", "pipe.urdf"):
        os.mkfifo(tmp_path / name)
    for target in (path, tmp_path):
        result = subprocess.run(
            [sys.executable, "-m", "linkwright", "check", str(target)],
            env={**os.environ, "PYTHONPATH": str(REPOSITORY / "src")},
            capture_output=True,
            timeout=120,
            check=False,
        )
        assert result.returncode in (0, 1)
