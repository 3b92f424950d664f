"""Parameters that another source of the package declares now, and parameters without a default."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/arm/__init__.py": ""}
NODE = "from rclpy.node import Node\n\n\nclass Arm(Node):\n    def __init__(self):\n        super().__init__('arm')\n{}"


def write_source(*lines: str) -> str:
    return NODE.format("".join(f"        {line}\n" for line in lines or ("pass",)))


def list_lines(repository, compare, old: dict[str, str], new: dict[str, str]) -> list[str]:
    repository.commit({**MANIFEST, **old})
    repository.write(new)
    return [line for found in compare(repository).subjects for line in sentences(found) if "default" in line]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("self.declare_parameter('port')", "node.declare_parameter('port', value='/dev/a')",
         ["parameter 'port': default - -> '/dev/a'"]),
        ("self.declare_parameter('port', 1)", "node.declare_parameter('port', 2)",
         ["parameter 'port': default 1 -> 2"]),
        ("self.declare_parameter('port', 1)", "node.declare_parameter('port', 1)", []),
        ("self.declare_parameter('port', PORT)", "node.declare_parameter('port', 1)", []),
    ],
)  # fmt: skip
def test_parameter_that_another_source_declares_now(repository, compare, old, new, expected):
    files = {"arm/arm/a.py": write_source(old), "arm/arm/b.py": write_source()}
    changed = {"arm/arm/a.py": write_source(), "arm/arm/b.py": write_source(new)}
    assert list_lines(repository, compare, files, changed) == expected


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("declare_parameter('a')", "declare_parameter('a', True)", ["parameter 'a': default - -> True"]),
        ("declare_parameter('a', 1.0)", "declare_parameter('a')", ["parameter 'a': default 1.0 -> -"]),
        ("declare_parameters('', [('a',)])", "declare_parameters('', [('a', 1)])", ["parameter 'a': default - -> 1"]),
        ("declare_parameter('a')", "declare_parameter('a', compute())", []),
        ("declare_parameter('a', **options)", "declare_parameter('a', 1)", []),
    ],
)
def test_default_that_only_one_version_has(repository, compare, old, new, expected):
    sources = (write_source(f"self.{line}") for line in (old, new))
    assert list_lines(repository, compare, {"arm/a.py": next(sources)}, {"arm/a.py": next(sources)}) == expected
