"""The statements of functions that a review shows: conditions, results, formulas and calls."""

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
        ("pass", "if goal.a:\n    return False", "`if goal.a: return False` added"),
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
    ("old", "new", "changes"),
    [
        ("pass", "self.stop(goal)", "`self.stop(goal)` added"),
        ("self.a(goal)", "self.b(goal)", "`self.a(goal)` -> `self.b(goal)`"),
        ("self.a = goal.a", "self.a = self.b(goal)", "`self.a = goal.a` -> `self.a = self.b(goal)`"),
        ("pass", "if goal.a:\n    self.a(goal)\n    self.b(goal)",
         "`if goal.a` added; `self.a(goal)` added; `self.b(goal)` added"),
        ("pass", f"if goal.{'a' * 100}:\n    return", f"`if goal.{'a' * 92}...` added"),
        ("a = 1\nb = goal.b\nself.c(a)", "a = goal.a\nif a > 3:\n    return\nb = goal.b * 2\nself.d(b)\nself.e(b)",
         "`a = 1` -> `a = goal.a`; `if a > 3: return` added; `b = goal.b` -> `b = goal.b * 2`; and 3 more"),
    ],
)  # fmt: skip
def test_statements_that_tell_most_are_shown(repository, compare, old, new, changes):
    assert list_lines(repository, compare, old, new) == [f"in 'Arm.move()': {changes}"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("pass", "rest = goal.rest"),
        ("speed = goal.v\nself.go(speed)\nself.a(goal)", "value = goal.v\nself.a(goal)\nself.go(value)"),
    ],
)
def test_other_code_is_named_by_its_function(repository, compare, old, new):
    assert list_lines(repository, compare, old, new) == ["code changed in 'Arm.move()'"]


CPP = """#include <arm/arm.hpp>
double Arm::limit(double speed) const
{
  if (speed > 2.0) {
    return 2.0;
  }
  double gain = speed * gain_;
  msg.speed = gain;
  send(msg);
  return gain;
}
"""


@pytest.mark.parametrize(
    ("old", "new", "changes"),
    [
        ("speed > 2.0)", "std::abs(speed) > 2.0)", "`if (speed > 2.0)` -> `if (std::abs(speed) > 2.0)`"),
        ("* gain_", "+ gain_", None),
        ("* gain_", "* gain_ * 2", "`double gain = speed * gain_` -> `double gain = speed * gain_ * 2`"),
        ("double gain =", "const double gain =", None),
        ("msg.speed = gain;", "msg.speed = stop ? 0 : gain;", "`msg.speed = gain` -> `msg.speed = stop ? 0 : gain`"),
        ("  send(msg);", "  if (!msg.ok) return 0;\n  send(msg);", "`if (!msg.ok): return 0` added"),
        ("  send(msg);", "  msg.stamp = now();\n  pub_->publish(msg);",
         "`send(msg)` removed; `msg.stamp = now()` added; `pub_->publish(msg)` added"),
        ("(double speed)", "(double speed, int axis)", "arguments (double speed) -> (double speed, int axis)"),
    ],
)  # fmt: skip
def test_statements_of_cpp_are_shown_as_they_are_written(repository, compare, old, new, changes):
    assert old in CPP
    repository.commit({"arm/src/arm.cpp": CPP})
    repository.write({"arm/src/arm.cpp": CPP.replace(old, new)})
    lines = [str(line) for found in compare(repository).subjects for line in sentences(found)]
    assert [line for line in lines if line.startswith("in ")] == ([f"in 'Arm::limit()': {changes}"] if changes else [])


def test_statements_that_move_to_another_function_are_not_shown(repository, compare):
    old = "void a(int x)\n{\n  if (x > 3) { stop(); }\n  go(x, 4);\n}\nvoid b(int x)\n{\n  run(x);\n}\n"
    new = "void a(int x)\n{\n  b(x);\n}\nvoid b(int x)\n{\n  if (x > 3) { stop(); }\n  go(x, 4);\n  run(x);\n}\n"
    repository.commit({"arm/src/arm.cpp": old})
    repository.write({"arm/src/arm.cpp": new})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["in 'a()': `b(x)` added", "code changed in 'b()'"]


def test_few_functions_show_their_statements(repository, compare):
    functions = [f"def move_{number}(goal):\n    return goal.a{{}}\n" for number in range(12)]
    repository.commit({PATH: "\n\n".join(functions).replace("{}", "")})
    repository.write({PATH: "\n\n".join(functions).replace("{}", " + goal.b")})
    lines = sentences(subject(compare(repository), PATH))
    assert [line.startswith("in ") for line in lines] == [True] * 8 + [False]
    assert lines[-1] == "code changed in 'move_8()', 'move_9()', 'move_10()', 'move_11()'"


def test_statement_that_another_line_reports_is_left_out(repository, compare):
    code = "self.arm = self.node.create_client(Home, 'home')\nself.arm.wait_for_service()"
    lines = list_lines(repository, compare, "pass", code)
    assert "in 'Arm.move()': `self.arm.wait_for_service()` added" in lines
    assert not any(line.startswith("code changed") for line in lines)


def test_equal_added_statements_are_shown_with_their_number(repository, compare):
    send = "self.arm.publish(pose)"
    lines = list_lines(repository, compare, send, f"{send}\ntime.sleep(1)\n{send}\ntime.sleep(1)\n{send}")
    assert lines == ["in 'Arm.move()': `time.sleep(1)` added (2 times); `self.arm.publish(pose)` added (2 times)"]


@pytest.mark.parametrize(
    ("old", "new", "changes"),
    [
        ("a, (b, c) = goal.x, goal.y\nself.d(a, b, c)", "a = goal.x\nb, c = goal.y\nself.d(a, b, c)", []),
        ("a = goal.x\nself.b, c = goal.y, 1\nself.d(a, c)", "a, self.b = goal.x, goal.y\nc = 1\nself.d(a, c)", []),
        ("a, b = 1, 2\nself.d(a, b)", "a, b = 1, goal.c\nself.d(a, b)", ["`b = 2` -> `b = goal.c`"]),
        ("a = 0.1\na = 0.1\nself.b(a)", "a = 0.1\nself.b(a)", []),
        ("return goal.a\nreturn goal.b", "return goal.a", []),
        ("if goal.a:\n    return goal.a\n    return goal.b", "if goal.a:\n    return goal.a", []),
        ("self.wait()\nself.stop()\nself.wait()", "self.stop()\nself.wait()", ["one of 2 `self.wait()` removed"]),
    ],
)  # fmt: skip
def test_statements_without_an_effect_are_no_change(repository, compare, old, new, changes):
    text = FUNCTION.replace("self.run(goal)", "EXTRA")  # a statement whose change is shown in any case
    for code, extra, write in ((old, "f(goal, 1)", repository.commit), (new, "f(goal, 2)", repository.write)):
        write({PATH: text.format(code.replace("\n", "\n        ")).replace("EXTRA", extra)})
    lines = [line for line in sentences(subject(compare(repository), PATH)) if line.startswith("in ")]
    assert lines == [f"in 'Arm.move()': {change}" for change in changes]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("a, b = b, a", "a = b\nb = a"),
        ("i[a], b = 1, i[b]", "i[a] = 1\nb = i[b]"),
        ("a = a + goal.x\na = a + goal.x", "a = a + goal.x"),
        ("a = self.pop()\na = self.pop()", "a = self.pop()"),
    ],
)
def test_statements_that_depend_on_each_other_are_changes(repository, compare, old, new):
    assert list_lines(repository, compare, f"{old}\nself.d(a, b)", f"{new}\nself.d(a, b)")


@pytest.mark.parametrize(
    ("old", "new", "is_shown"),
    [
        ('self.a: float = self.get_parameter("a").value', 'self.a: float = 1 / self.get_parameter("a").value', True),
        ('self.a = get_parameter("a").value', 'self.a = 0.5 * get_parameter("a").value', True),
        ('self.a = get_param("a", 1)', 'self.a = 2 * get_param("b", 1)', False),
        ('self.a = get_parameter("a").value', 'self.b = 2 * get_parameter("a").value', False),
        ('self.a = get_parameter("a").value', 'self.a = float(get_parameter("a").value)', False),
    ],
)
def test_other_computation_with_a_parameter_is_shown(repository, compare, old, new, is_shown):
    lines = list_lines(repository, compare, old, new)
    assert any("`self.a = " in line and " -> `self.a = " in line for line in lines) is is_shown
