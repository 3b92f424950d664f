"""The statements of Python functions that a review shows: conditions, results and sent messages."""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences, subject

PATH = "arm/scripts/arm.py"
FUNCTION = """class Arm:
    def move(self, goal):
        self.check(goal)
        {}
        self.run(goal)
"""


def list_lines(repository, compare, old: str, new: str) -> list[str]:
    for code, write in ((old, repository.commit), (new, repository.write)):
        write({PATH: FUNCTION.format(code.replace("\n", "\n        "))})
    return sentences(subject(compare(repository), PATH))


@pytest.mark.parametrize(
    ("old", "new", "change"),
    [
        ("pass", "return False", "`return False` added"),
        ("return True", "pass", "`return True` removed"),
        ("pass", "if goal.is_empty():\n    return", "`if goal.is_empty(): return` added"),
        ("pass", "image = self.to(goal, self.cv.BGR2RGB)", "`image = self.to(goal, self.cv.BGR2RGB)` added"),
        ("self.wait(0.5)", "pass", "`self.wait(0.5)` removed"),
        ("pass", "self.pub.publish(goal)", "`self.pub.publish(goal)` added"),
        ("if goal.a:\n    self.a(goal)", "if goal.b and goal.a:\n    self.a(goal)",
         "`if goal.a` -> `if goal.b and goal.a`"),
        ("self.a(goal)", "if goal.ok:\n    self.a(goal)", "`if goal.ok` added"),
        ("return goal.a", "return self.limit(goal)", "`return goal.a` -> `return self.limit(goal)`"),
    ],
)  # fmt: skip
def test_small_change_is_shown(repository, compare, old, new, change):
    assert list_lines(repository, compare, old, new) == [f"in 'Arm.move()': {change}"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("pass", "self.stop(goal)"),
        ("self.a = goal.a", "self.a = self.b(goal)"),
        ("pass", "if goal.a:\n    self.a(goal)\n    self.b(goal)"),
        ("pass", f"if goal.{'a' * 100}:\n    return"),
    ],
)
def test_other_code_is_named_by_its_function(repository, compare, old, new):
    assert list_lines(repository, compare, old, new) == ["code changed in 'Arm.move()'"]


def test_statement_that_another_line_reports_is_left_out(repository, compare):
    code = "self.arm = self.node.create_client(Home, 'home')\nself.arm.wait_for_service()"
    lines = list_lines(repository, compare, "pass", code)
    assert "in 'Arm.move()': `self.arm.wait_for_service()` added" in lines
    assert not any(line.startswith("code changed") for line in lines)
