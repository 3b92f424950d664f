"""The lines of a review about literals that change in the statements of sources."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

PYTHON = '''"""Drive a rover."""
import math
import rospy

STEP = 1
MODES = ["idle", "walk", "run"]
GAINS = {"hip": {"p": 10, "d": 0.5}, "knee": 20}


class Rover:
    WIDTH = 0.4

    def drive(self, speed=0.5):
        """Drive with 1 m/s."""
        msg.j1 = 1
        self.timeout: float = 0.2
        if cost >= 253 and self.mode == Mode.FAST:
            return 3 * speed
        arm.add_tool(z_offset=0.30, name='drill')
        time.sleep(1.5)
        rospy.loginfo("drove 5 m")
        raise ValueError("not 6")

    def reset(self):
        self.items.append(1)
        self.items.append(2)
'''
CPP = """#include <rover.hpp>
#define LIMIT 10  // at most 12
constexpr double WHEEL = 0.1;
enum Mode { SLOW = 1, FAST = 2 };
namespace rover
{
class Light : public rclcpp::Node {
  double timeout_{0.2};
  bool is_on_ = false;
};
Light::Light() : Node("light"), rate_(5) {
  timer_ = create([this]() { level_ = 7; });
}
void Light::handle(double value) {
  switch (value) {
    case 1:
      level_ = std::min(level_ + 1, 100.0);
      break;
  }
  if (value > 0.5f && (is_on_ || value < LIMIT)) { return; }
  pub_ = make<std::array<int, 4>>("light", 8);
  RCLCPP_INFO(get_logger(), "level 9");
  map_["near"] = {1, 2, 3};
  state_.message = "Lidar not ready";
}
}
"""


@pytest.fixture
def review_lines(repository, compare):
    """Review a replacement in a source, and return the sentences."""

    def run(path, text, old, new):
        assert old in text
        repository.commit({"rover/package.xml": PACKAGE_XML.replace("arm_description", "rover"), path: text})
        repository.write({path: text.replace(old, new)})
        result = compare(repository)
        assert not breaking(result)
        return [sentence for subject in result.subjects for sentence in sentences(subject)]

    return run


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("STEP = 1", "STEP = 2", "values: STEP 1 -> 2"),
        ('"run"]', '"jump"]', 'values: MODES ["idle", "walk", "run"] -> ["idle", "walk", "jump"]'),
        ('"p": 10', '"p": 12', "values: GAINS hip.p 10 -> 12"),
        ("WIDTH = 0.4", "WIDTH = math.pi / 4", "values in Rover: WIDTH 0.4 -> math.pi / 4"),
        ("WIDTH = 0.4", "WIDTH = 0.5", "values in Rover: WIDTH 0.4 -> 0.5"),
        ("speed=0.5", "speed=0.8", "values in Rover.drive: drive(self, speed=0.5 -> 0.8)"),
        ("msg.j1 = 1", "msg.j1 = -35", "values in Rover.drive: msg.j1 1 -> -35"),
        ("float = 0.2", "float = 0.5", "values in Rover.drive: self.timeout 0.2 -> 0.5"),
        (">= 253", ">= 243", "values in Rover.drive: cost >= 253 -> 243"),
        ("Mode.FAST", "Mode.SLOW", "values in Rover.drive: self.mode == Mode.FAST -> Mode.SLOW"),
        ("3 * speed", "4 * speed", "values in Rover.drive: return 3 * speed -> 4 * speed"),
        ("0.30", "0.25", "values in Rover.drive: arm.add_tool(z_offset=0.30 -> 0.25, ...)"),
        ("'drill'", "'gripper'", "values in Rover.drive: arm.add_tool(z_offset=0.30, name='drill' -> 'gripper')"),
        ("sleep(1.5)", "sleep(2)", "values in Rover.drive: time.sleep(1.5 -> 2)"),
        ("sleep(1.5)", "sleep(limit(step))", "values in Rover.drive: time.sleep(1.5) -> time.sleep(limit(step))"),
        (
            "name='drill'",
            "name=arm.name",
            "values in Rover.drive: arm.add_tool(z_offset=0.30, name='drill' -> name=arm.name)",
        ),
    ],
)
def test_a_literal_that_changes_in_python_is_told_with_its_place(review_lines, old, new, expected):
    assert review_lines("rover/scripts/drive.py", PYTHON, old, new) == [expected]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("drove 5 m", "drove 6 m"),
        ("not 6", "not 7"),
        ("1 m/s", "2 m/s"),
        ("0.30, name='drill'", '.3, name="drill"'),
    ],
)
def test_texts_for_people_are_not_told(review_lines, old, new):
    assert review_lines("rover/scripts/drive.py", PYTHON, old, new) == []


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("append(1)\n", "append(0)\n        self.items.append(3)\n",
         "in 'Rover.reset()': `self.items.append(1)` -> `self.items.append(0)`; `self.items.append(3)` added"),
        ("append(1)\n        self.items.append(2)", "append(2)\n        self.items.append(1)",
         "code changed in 'Rover.reset()'"),
        ("msg.j1 = 1", "msg.j2 = 2", "in 'Rover.drive()': `msg.j1 = 1` -> `msg.j2 = 2`"),
        ("1.5", "PAUSE", "in 'Rover.drive()': `time.sleep(1.5)` -> `time.sleep(PAUSE)`"),
        ("time.sleep(1.5)", "clock.sleep(PAUSE)", "in 'Rover.drive()': `time.sleep(1.5)` -> `clock.sleep(PAUSE)`"),
    ],
)  # fmt: skip
def test_statement_without_a_counterpart_is_no_value(review_lines, old, new, expected):
    assert review_lines("rover/scripts/drive.py", PYTHON, old, new) == [expected]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("LIMIT 10", "LIMIT 12", "values: LIMIT 10 -> 12"),
        ("WHEEL = 0.1", "WHEEL = 0.2", "values: WHEEL 0.1 -> 0.2"),
        ("FAST = 2", "FAST = 3", "values: FAST 2 -> 3"),
        ("{0.2}", "{0.5}", "values in Light: timeout_ 0.2 -> 0.5"),
        ("{0.2}", " = 0.2", "code changed in 'Light'"),
        ("WHEEL = 0.1", "WHEEL = 0.5 * M_PI / 3", "values: WHEEL 0.1 -> 0.5 * M_PI / 3"),
        ("100.0)", "0.5 * gain_)", "values in Light::handle: std::min(level_ + 1, 100.0 -> 0.5 * gain_)"),
        ("level_ = 7", "level_ = 9 * gain_", "values in Light::Light: level_ 7 -> 9 * gain_"),
        ("level_ = 7", "level_ = 7 * level_", "in 'Light::Light()': `level_ = 7` -> `level_ = 7 * level_`"),
        ("= false", "= true", "values in Light: is_on_ false -> true"),
        ("rate_(5)", "rate_(6)", "values in Light::Light: rate_(5 -> 6)"),
        ("level_ = 7", "level_ = 8", "values in Light::Light: level_ 7 -> 8"),
        ("case 1", "case 2", "values in Light::handle: case 1 -> 2"),
        ("+ 1,", "+ 2,", "values in Light::handle: std::min(level_ + 1 -> level_ + 2, ...)"),
        ("100.0", "200.0", "values in Light::handle: std::min(level_ + 1, 100.0 -> 200.0)"),
        ("0.5f", "0.7f", "values in Light::handle: value > 0.5f -> 0.7f"),
        ("int, 4", "int, 5", "values in Light::handle: 4 -> 5"),
        ('"Lidar not', '"Laser not',
         'values in Light::handle: state_.message "Lidar not ready" -> "Laser not ready"'),
        ('"light", 8', '"light", 9', 'values in Light::handle: make("light", 8 -> 9)'),
        ("{1, 2, 3}", "{1, 2, 4}", 'values in Light::handle: map_["near"] {1, 2, 3} -> {1, 2, 4}'),
    ],
)  # fmt: skip
def test_a_literal_that_changes_in_cpp_is_told_with_its_place(review_lines, old, new, expected):
    assert review_lines("rover/src/light.cpp", CPP, old, new) == [expected]


@pytest.mark.parametrize(("old", "new"), [("level 9", "level 8"), ("at most 12", "at most 13"), ("0.5f", "0.50")])
def test_logs_comments_and_equal_numbers_in_cpp_are_not_told(review_lines, old, new):
    assert review_lines("rover/src/light.cpp", CPP, old, new) == []


def test_a_long_list_is_told_by_its_items(review_lines):
    keys = ", ".join(f"'key_{number}'" for number in range(20))
    text = f"KEYS = [{keys}]\n"
    assert review_lines("rover/keys.py", text, ", 'key_3'", ", 'key_x'") == [
        "values: KEYS [...]: 'key_x' added, 'key_3' removed"
    ]


def test_a_long_text_is_read_once_and_shown_in_part(review_lines):
    image = "Z" * 300_000
    (line,) = review_lines("rover/panel.py", f"IMAGE = '{image}'\n", "ZZZ'", "ZZY'")
    assert len(line) < 200


def test_a_constant_of_the_source_with_another_name_is_not_a_value(review_lines):
    text = "STEP = 1\n\ndef f():\n    return STEP\n"
    assert review_lines("rover/step.py", text, "STEP", "STEP_SIZE") == [
        "constants renamed: STEP -> STEP_SIZE",
        "code changed in 'f()'",
    ]


def test_texts_that_only_change_their_order_are_not_told(review_lines):
    text = "layout = [button('Start', size=4, key=1), button('Stop', size=4, key=1)]\n"
    old, new = "'Start', size=4, key=1), button('Stop'", "'Stop', size=4, key=1), button('Start'"
    (line,) = review_lines("rover/panel.py", text, old, new)
    assert line.startswith("outside of functions: `layout = [")


def test_values_that_other_lines_tell_are_not_told_again(review_lines):
    text = 'import rospy\nRATE = 10\nloop = rospy.Rate(RATE)\nrate = rospy.get_param("~rate", 5)\n'
    assert review_lines("rover/loop.py", text, "RATE = 10", "RATE = 20") == ["rate or period: Rate(10) -> Rate(20)"]


@pytest.mark.parametrize(("is_new", "expected"), [(True, "new"), (False, "old")])
def test_a_source_with_a_syntax_error_loses_no_names(repository, compare, is_new, expected):
    valid = 'import rospy\nrospy.Publisher("a", String, queue_size=1)\n'
    invalid = valid + "def f(:\n"
    repository.commit({"rover/a.py": valid if is_new else invalid})
    repository.write({"rover/a.py": invalid if is_new else valid})
    result = compare(repository)
    (subject,) = result.subjects
    assert breaking(result) == ["can no longer be parsed"] * is_new
    assert len(subject.changes) == is_new
    (problem,) = subject.problems
    assert str(problem.text) == f"the {expected} version has a syntax error in line 3; its names are not known"
    assert problem.is_of_old is not is_new


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("if cost >= 253 and self.mode", "if cost > 254 and self.mode",
         "values in Rover.drive: cost >= 253 -> cost > 254"),
        ("z_offset=0.30, name", "z_offset=0.35, side=True, name", "values in Rover.drive: 0.30 -> 0.35"),
        ("z_offset=0.30, name='drill'", "z_offset=0.35, size=4, name='drill'",
         ("in 'Rover.drive()': `arm.add_tool(z_offset=0.3, name='drill')` -> "
          "`arm.add_tool(z_offset=0.35, size=4, name='drill')`")),
        ("add_tool(z_offset=0.30, name='drill')", "drop(0.5)",
         "in 'Rover.drive()': `arm.add_tool(z_offset=0.3, name='drill')` -> `arm.drop(0.5)`"),
    ],
)  # fmt: skip
def test_the_only_number_that_changes_with_the_form_of_a_statement_is_told(review_lines, old, new, expected):
    assert review_lines("rover/scripts/drive.py", PYTHON, old, new) == [expected]


@pytest.mark.parametrize(
    ("path", "text", "old", "new", "expected"),
    [
        (
            "rover/save.py",
            "arm_share = find_share('arm')\n\ndef f():\n    use(arm_share)\n",
            ("arm_share", "'arm'"),
            ("leg_share", "'leg'"),
            "values: find_share('arm' -> 'leg')",
        ),
        (
            "rover/save.py",
            "def f():\n    self.near = read('near', 1)\n    far = read('far', 2)\n    use(self.near, far)\n",
            ("self.near", "1)"),
            ("self.close", "3)"),
            "values in f: read('near', 1 -> 3)",
        ),
        (
            "rover/save.cpp",
            'void f() {\n  auto near = read("near");\n  use(near);\n}\n',
            ("auto near", '"near"', "use(near"),
            ("auto close", '"close"', "use(close"),
            'values in f: read("near" -> "close")',
        ),
    ],
)
def test_values_of_renamed_variables_are_compared(review_lines, path, text, old, new, expected):
    changed = text
    for before, after in zip(old, new, strict=True):
        changed = changed.replace(before, after)
    assert review_lines(path, text, text, changed)[0] == expected


LINKS = """def link():
    add(ros='scan', gz=find())
    add(ros='points', gz=find('points'))
"""


@pytest.mark.parametrize(
    ("replaced", "expected"),
    [
        ({"'scan', gz=find()": "'scan', gz=find('laser')"}, ["gz=find() -> gz=find('laser')"]),
        (
            {"'scan', gz=find()": "'scan', gz=find('laser')", "find('points')": "find('laser/points')"},
            ["gz=find() -> gz=find('laser')", "find('points' -> 'laser/points')"],
        ),
        (
            {"    add(ros='points', gz=find('points'))\n": "", "find()": "find('scan')"},
            ["gz=find() -> gz=find('scan')"],
        ),
        ({"find('points')": "find(name)"}, ["gz=find('points' -> name)"]),
        ({"find('points')": "find(str('points'))"}, []),
        ({"find('points')": "find(NAME, name)"}, []),
        ({"find()": "find(name)"}, []),
        ({"find()": "find('no data was found')"}, []),
    ],
)
def test_an_argument_that_is_added_or_replaced_is_told_beside_other_changes(review_lines, replaced, expected):
    changed = LINKS
    for old, new in replaced.items():
        changed = changed.replace(old, new)
    lines = [line for line in review_lines("rover/link.py", LINKS, LINKS, changed) if line.startswith("values")]
    assert lines == ([f"values in link: {', '.join(expected)}"] if expected else [])


def test_statements_with_other_functions_are_not_compared(review_lines):
    text = "def f():\n    near = read('near')\n    use(near)\n"
    changed = "def f():\n    far = make('far')\n    use(far)\n"
    assert review_lines("rover/save.py", text, text, changed) == ["code changed in 'f()'"]


@pytest.mark.parametrize(("new", "is_told"), [("0x0b", False), ("0x0c", True)])
def test_the_notation_of_a_number_is_no_value_in_a_statement_of_another_shape(review_lines, new, is_told):
    text = "int Rover::read() {{\n  return parse(buffer, {}{});\n}}\n"
    lines = review_lines(
        "rover/src/a.cpp", text.format("0x0B", ""), text.format("0x0B", ""), text.format(new, " + first")
    )
    assert any(line.startswith("values in ") for line in lines) is is_told


def test_an_index_is_not_the_value_that_replaces_a_number(review_lines):
    text = "void Rover::read() {\n  covariance[14] = 1000000.0;\n}\n"
    lines = review_lines("rover/src/a.cpp", text, "1000000.0", "covariance_[2]")
    assert all("-> 2" not in line for line in lines)


@pytest.mark.parametrize(("old", "new", "is_told"), [("1.6581", "M_PI_2", True), ("1.5708", "M_PI_2", False)])
def test_a_constant_of_mathematics_replaces_a_number(review_lines, old, new, is_told):
    text = "void Rover::read() {\n  angle_ = a - NUMBER;\n}\n"
    lines = review_lines("rover/src/a.cpp", text.replace("NUMBER", old), old, new)
    assert (f"values in Rover::read: angle_ a - {old} -> a - {new}" in lines) is is_told


@pytest.mark.parametrize(
    ("path", "old", "new", "expected"),
    [
        ("a.py", 'self.ser = serial.Serial("/dev/a", 9600)', 'self.port = Serial("/dev/b", 9600)\n    self.start()',
         'values in f: Serial("/dev/a" -> "/dev/b", ...)'),
        ("a.cpp", 'port_ = new io::Serial("/dev/a");', 'serial_ = std::make(io::Serial("/dev/a")); start(1);', None),
        ("a.cpp", 'ser_ = open("/dev/a");', 'auto port = io::open("/dev/b"); start(1);',
         'values in f: open("/dev/a" -> "/dev/b")'),
        ("a.py", 'a = Serial("x"); b = Serial("y")', 'c = Serial("z")', None),
    ],
)  # fmt: skip
def test_a_call_whose_result_has_another_name(review_lines, path, old, new, expected):
    form = "def f(self):\n    {}\n    return 1\n" if path == "a.py" else "void f() {{ {}\n  return; }}\n"
    lines = review_lines(f"rover/{path}", form.format(old), form.format(old), form.format(new))
    values = [line for line in lines if line.startswith("values")]
    assert values == ([expected] if expected else [])
