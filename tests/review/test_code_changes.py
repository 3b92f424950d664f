"""The lines of a review about functions whose code changes."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PYTHON = '''"""Drive."""
class Driver(Node):
    """A driver."""

    limits = limit(1)

    def __init__(self):
        super().__init__("driver")
        self.create_subscription(String, "mode", self.on_mode, 10)
        self.create_service(Trigger, "home", self.on_home)
        self.create_timer(0.1, self.on_timer)
        self.server = ActionServer(self, Reach, "reach", self.reach)

    def on_mode(self, msg: String) -> None:
        """Take a mode."""
        self.mode = msg.data
        self.get_logger().info("mode")

    def on_home(self, request, response):
        if self.mode:
            self.go(request)
            return response
        raise ValueError("no mode")

    def on_timer(self):
        for item in self.items:
            item.step()

    def reach(self, goal):
        goal.succeed()


def clamp(value, low):
    return max(value, low)
'''
CPP = """#include <rover.hpp>
DRIVER_MACRO(Rover)
void Rover::Rover() : Node("rover") {
  sub_ = create_subscription<String>("mode", 10, std::bind(&Rover::onMode, this, _1));
  timer_ = create_wall_timer(100ms, std::bind(&Rover::onTimer, this));
}
std::function<void(int)> Rover::onMode(const String & msg) {
  if (msg.data.empty()) return;
  RCLCPP_INFO(get_logger(), "mode");
  mode_ = msg.data;
  if (mode_ == last_) throw std::runtime_error("the mode is old");
}
void Rover::onTimer() {
  for (auto & item : items_) {
    item.step();
    count(item);
  }
}
"""


@pytest.fixture
def review_lines(repository, compare):
    """Review another text of a source, and return the sentences."""

    def run(path, old, new):
        repository.commit({**MANIFEST, path: old})
        repository.write({path: new})
        result = compare(repository)
        assert not breaking(result)
        return [sentence for subject in result.subjects for sentence in sentences(subject)]

    return run


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("= msg.data", "= msg.data.split('#')",
         ("in 'Driver.on_mode()' (callback of subscription 'mode'): "
         "`self.mode = msg.data` -> `self.mode = msg.data.split('#')`")),
        ("go(request)", "go(request.pose)",
         "in 'Driver.on_home()' (callback of service 'home'): `self.go(request)` -> `self.go(request.pose)`"),
        ("item.step()", "item.stop()", "in 'Driver.on_timer()' (callback of a timer): `item.step()` -> `item.stop()`"),
        ("goal.succeed()", "goal.abort()",
         "in 'Driver.reach()' (callback of action 'reach'): `goal.succeed()` -> `goal.abort()`"),
        ("            return response\n", "        return response\n",
         "code changed in 'Driver.on_home()' (callback of service 'home')"),
        ("max(value", "min(value", "in 'clamp()': `return max(value, low)` -> `return min(value, low)`"),
        ("(value, low)", "(value, low, high)", "in 'clamp()': arguments (value, low) -> (value, low, high)"),
        ("def clamp", "def _floor", "code renamed: 'clamp()' -> '_floor()'"),
        ("def clamp", "def half(x):\n    return x / 2\n\n\ndef clamp", "code added: 'half()'"),
        ("\n    def reach(self, goal):\n        goal.succeed()\n", "", "code removed: 'Driver.reach()'"),
        ("limit(1)", "limits()", "code changed in 'Driver'"),
        ("class Driver", "import os\n\n\nclass Driver", "imports added: 'import os'"),
        ("class Driver", "setup()\n\n\nclass Driver", "outside of functions: `setup()` added"),
    ],
)  # fmt: skip
def test_functions_of_python_with_other_code_are_named(review_lines, old, new, expected):
    assert old in PYTHON
    assert review_lines("arm/scripts/driver.py", PYTHON, PYTHON.replace(old, new, 1)) == [expected]


@pytest.mark.parametrize(
    ("imports", "expected"),
    [
        ("from arm.tool import open, close\n", []),
        ("from arm.tool import open\nfrom arm.tool import close\n", []),
        (
            "from arm.tool import open, lift, turn\n",
            ["imports added: 'from arm.tool import lift, turn'; imports removed: 'from arm.tool import close'"],
        ),
    ],
)
def test_imports_are_compared_name_by_name(review_lines, imports, expected):
    old = f"from arm.tool import close, open\n{PYTHON}"
    assert review_lines("arm/scripts/driver.py", old, f"{imports}{PYTHON}") == expected


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('info("mode")', 'info("the mode")'),
        ('        self.get_logger().info("mode")\n', ""),
        ('"no mode"', 'f"no {mode}"'),
        ("Take a mode", "Read a mode"),
        ("msg: String) -> None", "msg)"),
        ("max(value, low)", "max(\n        value,\n        low,\n    )  # the larger one"),
    ],
)
def test_layout_comments_annotations_and_outputs_of_python_are_not_named(review_lines, old, new):
    assert old in PYTHON
    assert review_lines("arm/scripts/driver.py", PYTHON, PYTHON.replace(old, new, 1)) == []


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("= msg.data;", "= msg.data + 'x';",
         "in 'Rover::onMode()' (callback of subscription 'mode'): `mode_ = msg.data` -> `mode_ = msg.data + 'x'`"),
        ("    count(item);\n  }", "  }\n  count(item);", "code changed in 'Rover::onTimer()' (callback of a timer)"),
        ("void Rover::onTimer", "void Rover::tick", "code renamed: 'Rover::onTimer()' -> 'Rover::tick()'"),
        ("void Rover::onTimer", "int half(int x) { return x / 2; }\nvoid Rover::onTimer", "code added: 'half()'"),
        ("DRIVER_MACRO(Rover)\n", "int size = half(3);\nDRIVER_MACRO(Rover)\n",
         "outside of functions: `int size = half(3)` added"),
    ],
)  # fmt: skip
def test_functions_of_cpp_with_other_code_are_named(review_lines, old, new, expected):
    assert old in CPP
    assert review_lines("arm/src/rover.cpp", CPP, CPP.replace(old, new, 1)) == [expected]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"the mode is old"', '"no new mode came"'),
        ('  RCLCPP_INFO(get_logger(), "mode");\n', ""),
        ("if (msg.data.empty()) return;", "if (msg.data.empty()) {\n    return;  // nothing\n  }"),
        ("for (auto & item : items_) {", "for (auto &item: items_)\n  {"),
        ("#include <rover.hpp>", "#include <rover.hpp>\n#include <vector>"),
    ],
)
def test_layout_comments_and_outputs_of_cpp_are_not_named(review_lines, old, new):
    assert old in CPP
    assert review_lines("arm/src/rover.cpp", CPP, CPP.replace(old, new, 1)) == []


def test_nothing_is_told_of_cpp_whose_braces_do_not_match(review_lines):
    text = "void f() {\n#ifdef A\n  if (a) {\n#else\n  if (b) {\n#endif\n    c();\n  }\n}\nvoid g() { d(); }\n"
    assert review_lines("arm/src/rover.cpp", text, text.replace("d()", "e()")) == []


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("timer(0.1", "timer(0.2", "rate or period: create_timer(0.1) -> create_timer(0.2)"),
        ("10)\n", '10)\n        self.declare_parameter("a", 1)\n', "parameters added: 'a' (1)"),
        ("self.mode = ", "self.level = 4\n        self.mode = ", None),
    ],
)
def test_a_function_that_other_lines_tell_of_is_not_named_again(review_lines, old, new, expected):
    line = expected or "in 'Driver.on_mode()' (callback of subscription 'mode'): `self.level = 4` added"
    assert review_lines("arm/scripts/driver.py", PYTHON, PYTHON.replace(old, new, 1)) == [line]


def test_a_function_is_named_for_what_other_lines_do_not_tell(review_lines):
    new = PYTHON.replace("create_timer(0.1", "create_timer(0.2").replace('super().__init__("driver")', "f(4)")
    new = new.replace("f(4)", 'super().__init__("driver")\n        self.reset()')
    assert review_lines("arm/scripts/driver.py", PYTHON, new) == [
        "rate or period: create_timer(0.1) -> create_timer(0.2)",
        "in 'Driver.__init__()': `self.reset()` added",
    ]


@pytest.mark.parametrize("is_function", [True, False])
@pytest.mark.parametrize("more", ["", "    rest = file.read()\n    file.truncate()\n"])
def test_code_that_changes_beside_values_is_told(review_lines, is_function, more):
    header = "def main():" if is_function else "if ready():"
    old = f'{header}\n    text = compile("a:(x)")\n    file = open("log", "r")\n    line = file.readline()\n'
    new = old.replace("a:", "a: ").replace('"r")\n', f'"r+")\n{more}')
    name = "values in main" if is_function else "values"
    values, *others = review_lines("arm/main.py", old, new)
    assert values.startswith(f"{name}: ")
    shown = (
        "code changed in 'main()'"
        if is_function
        else "outside of functions: `rest = file.read()` added; `file.truncate()` added"
    )
    assert others == ([shown] if more else [])


def test_functions_that_move_are_not_named(repository, compare):
    function = "\n\ndef clamp(value, low):\n    return max(value, low)\n"
    repository.commit({**MANIFEST, "arm/a.py": PYTHON, "arm/b.py": "B = 1\n"})
    repository.commit({"arm/a.py": function.strip() + "\n\n\n" + PYTHON.replace(function, "")})
    assert compare(repository, "HEAD~1..HEAD").subjects == []
    repository.commit({"arm/a.py": PYTHON.replace(function, ""), "arm/b.py": f"B = 1\n{function}"})
    assert compare(repository, "HEAD~1..HEAD").subjects == []


def test_the_line_is_that_of_the_first_statement_that_differs(repository, compare):
    repository.commit({**MANIFEST, "arm/scripts/driver.py": PYTHON})
    repository.write({"arm/scripts/driver.py": PYTHON.replace("= msg.data", "= msg.mode")})
    (found,) = compare(repository).subjects
    assert found.changes[0].location.line == PYTHON[: PYTHON.index("= msg.data")].count("\n") + 1


def test_macro_without_a_semicolon_may_stand_before_a_namespace(review_lines):
    text = "PLUGIN_EXPORT(arm::Arm, Base)\n\nnamespace arm\n{\nvoid Arm::start()\n{\n  move(a);\n}\n}\n"
    assert review_lines("arm.cpp", text, text.replace("move(a)", "turn(a)")) == [
        "in 'Arm::start()': `move(a)` -> `turn(a)`"
    ]


def test_a_class_in_cpp_may_have_a_macro_before_or_behind_its_name(review_lines):
    text = "class ARM_PUBLIC Tool ARM_FINAL : public Base {\n  int size() { return 1 + x; }\n};\n"
    assert review_lines("arm/src/tool.hpp", text, text.replace("+ x", "+ y")) == ["code changed in 'Tool::size()'"]


USER = """import math
from std_msgs.msg import String


def half(value: String) -> None:
    send(String(math.floor(value / 2)))


def send(text):
    try:
        show(text)
    except NameError:
        pass
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("import math\n", "", "uses 'math', which it no longer defines or imports"),
        ("def send(text)", "def post(text)", "uses 'send', which it no longer defines or imports"),
        ("import math\n", "from std_msgs.msg import *\n", "uses 'math', which it no longer defines or imports"),
        ("math.floor(", "np.floor(", "uses 'np', which nothing defines"),
        ("import math\n", "from numpy import *\nself.run()\n", "uses 'self', which nothing defines"),
    ],
)
def test_name_that_is_no_longer_defined_is_breaking(repository, compare, old, new, expected):
    repository.commit({**MANIFEST, "arm/scripts/half.py": USER})
    repository.write({"arm/scripts/half.py": USER.replace(old, new)})
    assert breaking(compare(repository)) == [expected]


METHODS = """class Reader:
    size = 3
    names = [size for _ in range(size)]

    def read(self, limit=size):
        return self.convert(limit)

    def convert(self, text):
        return text
"""


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        (METHODS.replace("self.convert(", "convert("), ["uses 'convert', which nothing defines"]),
        (METHODS.replace("return text", "return text * size"), ["uses 'size', which nothing defines"]),
        (METHODS.replace("limit=size", "limit=2 * size"), []),
        (METHODS.replace("return text", "return max(limit for limit in text)"), []),
        (METHODS.replace("self.convert(", "convert(") + "\n\nfrom arm.tools import convert\n", []),
    ],
)
def test_functions_do_not_see_the_names_of_their_class(repository, compare, new, expected):
    repository.commit({**MANIFEST, "arm/scripts/reader.py": METHODS})
    repository.write({"arm/scripts/reader.py": new})
    assert breaking(compare(repository)) == expected


def test_an_undefined_name_of_an_added_source_is_told_and_breaks_nothing(repository, compare):
    repository.commit(MANIFEST)
    repository.write({"arm/scripts/half.py": USER.replace("math.floor(", "np.floor(")})
    result = compare(repository)
    (found,) = result.subjects
    assert "uses 'np', which nothing defines" in sentences(found)
    assert breaking(result) == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("import math\n", "from numpy import *\n"),
        ("import math\n", "math = None\n"),
        ("show(text)", "view(text)"),
        ("value: String", "value: Text"),
        ("value / 2", "unicode(value) / 2"),
        ("value / 2", "[item for item in value][0]"),
        ("import math\n", "from std_msgs.msg import *\nmath = Math()\n"),
        ("import math\n", "print 'a'\n"),
    ],
)
def test_a_name_that_may_be_defined_is_not_breaking(repository, compare, old, new):
    repository.commit({**MANIFEST, "arm/scripts/half.py": USER})
    repository.write({"arm/scripts/half.py": USER.replace(old, new)})
    assert breaking(compare(repository)) == []


def test_code_of_python_2_that_prints_a_list_is_read(review_lines):
    text = "def plan(run):\n    print 'plan'\n    print [item for item in run.line]\n    run.go(run.line)\n"
    assert review_lines("arm/scripts/plan.py", text, text.replace("go(run.line)", "go()")) == [
        "in 'plan()': `run.go(run.line)` -> `run.go()`"
    ]


def test_overloads_that_change_places_are_no_change(repository, compare):
    overloads = ["int f(int a)\n{\n  return a;\n}\n", "int f(double a)\n{\n  g(a);\n  return 1;\n}\n"]
    repository.commit({**MANIFEST, "arm/src/f.cpp": "".join(overloads)})
    repository.write({"arm/src/f.cpp": "".join(reversed(overloads))})
    assert [sentence for found in compare(repository).subjects for sentence in sentences(found)] == []


def test_code_outside_of_functions_changes_beside_a_function(review_lines):
    old = "LIMIT = compute(1)\ndef drive():\n    go()\n"
    new = "LIMIT = measure(1)\ndef drive():\n    stop()\n"
    lines = review_lines("arm/src/a.py", old, new)
    assert lines == [
        "in 'drive()': `go()` -> `stop()`",
        "outside of functions: `LIMIT = compute(1)` -> `LIMIT = measure(1)`",
    ]


def test_of_many_changed_statements_outside_of_functions_three_are_shown(review_lines):
    old = "\n".join(f"state_{letter} = compute(a)" for letter in "abcd")
    changes = [f"`state_{letter} = compute(a)` -> `state_{letter} = measure(a, b)`" for letter in "abc"]
    assert review_lines("arm/src/a.py", old, old.replace("compute(a)", "measure(a, b)")) == [
        f"outside of functions: {'; '.join(changes)}; and 1 more"
    ]


def test_changed_statements_outside_of_functions_that_tell_nothing_are_not_shown(review_lines):
    old = "\n".join(f"call_{letter}()" for letter in "abcd")
    lines = review_lines("arm/src/a.py", f"{old}\n", "")
    assert lines == ["code changed outside of functions"]


def test_a_moved_statement_outside_of_functions_is_not_shown(review_lines):
    old = "first = compute()\nsecond = measure()\nclose()\n"
    new = "second = measure()\nfirst = compute()\nclose(first)\n"
    assert review_lines("arm/src/a.py", old, new) == ["outside of functions: `close()` -> `close(first)`"]


def test_objects_outside_of_functions_change_beside_a_function(review_lines):
    old = 'ValueArg frame("f", "frame", "map", cmd);\nvoid drive() { go(); }\n'
    new = 'ValueArg base("b", "base-link", "base", cmd);\nvoid drive() { stop(); }\n'
    lines = review_lines("arm/src/a.cpp", old, new)
    objects = ('ValueArg frame("f", "frame", "map", cmd)', 'ValueArg base("b", "base-link", "base", cmd)')
    changed = "outside of functions: `{}` -> `{}`".format(*objects)
    assert lines == ["in 'drive()': `go()` -> `stop()`", changed]


def test_calls_and_declarations_of_a_changed_function_are_not_other_code(review_lines):
    old = "void drive();\nint state = drive();\nvoid drive() { go(); }\n"
    new = "void drive(int speed);\nint state = drive(1);\nvoid drive(int speed) { go(speed); }\n"
    lines = review_lines("arm/src/a.cpp", old, new)
    assert "outside" not in str(lines)


DEFAULTS = """class Rover {
public:
  int get(int a, bool is_new = false) const {
    stop();
    return a;
  }
  template <typename T = int>
  T other(std::vector<T> a = {1, 2}) {
    return a.front();
  }
  int count(int a) { return a; }
};
"""


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("stop();", "halt();", "in 'Rover::get()': `stop()` -> `halt()`"),
        ("a.front()", "a.back()", "in 'Rover::other()': `return a.front()` -> `return a.back()`"),
        ("int a) { return a;", "int a) { return n(a);", "in 'Rover::count()': `return a` -> `return n(a)`"),
    ],
)
def test_function_with_default_arguments_is_named(review_lines, old, new, line):
    assert review_lines("arm/src/rover.hpp", DEFAULTS, DEFAULTS.replace(old, new)) == [line]


def test_macro_with_the_name_of_a_parameter_is_its_name(repository, compare):
    text = """#define STAMPED_PARAM "use_stamped"
Rover::Rover() : Node("rover") {
  stamped_ = declare_parameter<bool>(STAMPED_PARAM, false);
}
"""
    repository.commit({**MANIFEST, "arm/src/rover.cpp": text})
    repository.write({"arm/src/rover.cpp": text.replace('"use_stamped"', '"is_stamped"')})
    assert breaking(compare(repository)) == ["parameter 'use_stamped' (false) renamed to 'is_stamped' (false)"]


def test_a_source_in_c_is_read(repository, compare):
    text = "static int limit(int value) {\n  return min(value, 3);\n}\n"
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/driver.c": text})
    repository.write({"arm/src/driver.c": text.replace("3", "4")})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["values in limit: min(value, 3 -> 4)"]


def test_an_added_source_in_c_is_only_another_file(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML})
    repository.write({"arm/src/driver.c": "#define LIMIT 3\nint limit(int value) { return value + LIMIT; }\n"})
    assert not compare(repository).subjects


def test_a_generated_source_in_c_is_only_another_file(repository, compare):
    text = "/* This file was auto-generated. */\nint limit(int value) {\n  return min(value, 3);\n}\n"
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/driver.c": text})
    repository.write({"arm/src/driver.c": text.replace("3", "4")})
    assert not compare(repository).subjects
