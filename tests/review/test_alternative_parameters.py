"""Parameters of Python sources that are read with an alternative, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences

SOURCE = """from rclpy.node import Node
from rclpy.parameter import Parameter


class Lamp(Node):
    def __init__(self):
        super().__init__("lamp")
        self.power = self.get_parameter_or("power", ALTERNATIVE).value
"""


@pytest.mark.parametrize(("value", "expected"), [("1.0", []), ("2.0", ["parameter 'power': default 1.0 -> 2.0"])])
def test_the_default_is_the_value_of_the_alternative(repository, compare, value, expected):
    old = "Parameter('power', Parameter.Type.DOUBLE, 1.0)"
    repository.commit({"lamp/scripts/lamp.py": SOURCE.replace("ALTERNATIVE", old)})
    new = f"Parameter('power', value={value})"
    repository.write({"lamp/scripts/lamp.py": SOURCE.replace("ALTERNATIVE", new)})
    found = [text for each in compare(repository).subjects for text in sentences(each)]
    assert [text for text in found if "default" in text] == expected
