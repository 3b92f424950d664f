"""The types with which Python sources declare parameters without a default."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

PATH = "arm/arm.py"
NODE = "class Arm(Node):\n    def __init__(self):\n        super().__init__('arm')\n        {}\n"
DESCRIPTOR = "ParameterDescriptor(type=ParameterType.PARAMETER_{})"


def list_lines(repository, compare, old: str, new: str) -> list[str]:
    for code, write in ((old, repository.commit), (new, repository.write)):
        write({PATH: NODE.format(code)})
    return sentences(subject(compare(repository), PATH))


@pytest.mark.parametrize(
    ("arguments", "type_name"),
    [
        (f", descriptor={DESCRIPTOR.format('STRING')}", "str"),
        (f", None, {DESCRIPTOR.format('DOUBLE')}", None),
        (f", descriptor=rcl_interfaces.msg.{DESCRIPTOR.format('INTEGER_ARRAY')}", "int[]"),
        (", rclpy.Parameter.Type.BOOL", "bool"),
        (", value=Parameter.Type.STRING_ARRAY", "str[]"),
        (", descriptor=ParameterDescriptor(description='The name.')", None),
    ],
)
def test_declared_type_is_told_once(repository, compare, arguments, type_name):
    lines = list_lines(
        repository, compare, "self.declare_parameter('tool')", f"self.declare_parameter('tool'{arguments})"
    )
    told = [f"parameter 'tool': type - -> {type_name}"]
    assert [line for line in lines if "type -" in line] == ([] if type_name is None else told)
    assert type_name is None or lines == told


def test_another_declared_type_is_breaking(repository, compare):
    old, new = (f"self.declare_parameter('tool', Parameter.Type.{name})" for name in ("STRING", "INTEGER"))
    for code, write in ((old, repository.commit), (new, repository.write)):
        write({PATH: NODE.format(code)})
    result = compare(repository)
    assert sentences(subject(result, PATH)) == ["parameter 'tool': type str -> int"]
    assert breaking(result) == sentences(subject(result, PATH))


def test_default_in_place_of_a_type(repository, compare):
    lines = list_lines(
        repository,
        compare,
        "self.declare_parameter('tool', Parameter.Type.DOUBLE)",
        "self.declare_parameter('tool', 0.5)",
    )
    assert lines == ["parameter 'tool': default - -> 0.5"]
