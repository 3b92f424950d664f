"""Inputs of fixed defects, which the fuzzers or the search for defects found.

Each file of ``inputs/`` is named ``KIND--what-was-wrong.ending``, and the kind selects its reader. The checks are those
of the fuzzers (see ``fuzz/targets.py``): only Linkwright's errors are raised, and the output can be read again.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from fuzz import targets
from fuzz.documents import HEAD, Files

from tests.work import ends

INPUTS = sorted((Path(__file__).parent / "inputs").iterdir())

CHECKS: dict[str, Callable[[str], None]] = {
    "expression": targets.check_expression,
    "rviz": targets.check_rviz,
    "urdf": targets.check_urdf,
    "xacro": lambda text: targets.check_expansion(Files(text, f"{HEAD}/>", "a: 1")),
    "xml": targets.check_xml,
    "yaml": lambda text: targets.check_expansion(
        Files(f"""{HEAD}><a v="${{xacro.load_yaml('data.yaml')}}"/></robot>""", f"{HEAD}/>", text)
    ),
}


@pytest.mark.parametrize("path", INPUTS, ids=lambda path: path.name)
def test_fuzzer_finding_stays_fixed(path: Path) -> None:
    check = CHECKS[path.name.partition("--")[0]]
    with ends():
        check(path.read_bytes().decode("utf-8", "surrogatepass"))


@pytest.mark.parametrize("name", [name for name in targets.TARGETS if targets.hard_seeds(name)])
def test_slow_and_large_inputs_are_read_or_rejected(name: str) -> None:
    for text in targets.hard_seeds(name):
        targets.TARGETS[name](text.encode())
