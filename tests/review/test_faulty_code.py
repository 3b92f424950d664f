"""The lines of a review about code that no compiler accepts, that always fails, or whose result is undefined."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

CPP = "#include <string>\n\n%s\nint main() { Pump pump; }\n"
PUMP = "struct Pump {\n  int speed = 0;\n  int get() const { return speed; }\n};\n"
CMAKE = "add_executable(pump src/pump.cpp)\ninstall(TARGETS pump DESTINATION lib/pump)\n"
PACKAGE = {"pump/package.xml": PACKAGE_XML.replace("arm_description", "pump"), "pump/CMakeLists.txt": CMAKE}
PATH = "pump/src/pump.cpp"
SCRIPT = "pump/scripts/pump.py"


def review_cpp(repository, compare, old, new):
    repository.commit({**PACKAGE, **({} if old is None else {PATH: CPP % old})})
    repository.write({PATH: CPP % new})
    result = compare(repository)
    lines = sentences(subject(result, PATH))
    words = ("breaks off", "unresolved merge", "no longer returns a value", "returns no value")
    return [line for line in lines if any(word in line for word in words)], breaking(result)


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        ("void stop(Pump& p) { int a = 1; p. }\n", "`p.` breaks off"),
        ("void stop(Pump* p) { p->; }\n", "`p->` breaks off"),
        ("int two() { int a = ; return 2; }\n", "`int a =` breaks off"),
        ("bool is_on(int a) { return (a == 1 || ); }\n", "`return (a == 1 ||` breaks off"),
        (
            "<<<<<<< HEAD\nint a;\n=======\nint b;\n>>>>>>> other\n",
            "has the marks of an unresolved merge, such as '<<<<<<<'",
        ),
    ],
)
def test_code_that_no_compiler_accepts_is_breaking(repository, compare, code, expected):
    lines, broken = review_cpp(repository, compare, PUMP, PUMP + code)
    assert lines == [expected]
    assert expected in broken


@pytest.mark.parametrize(
    "code",
    [
        "Pump& operator=(const Pump&) = default;\n",
        "struct Big : Pump { using Pump::operator=; using Pump::operator->; };\n",
        "template <typename... T> void f(T... t) { auto g = [=] { return 1; }; g(t...); }\n",
        "#if 0\nvoid stop(Pump& p) { p. }\n#endif\n",
        "// p. }\n",
        "#define MEMBER(a) a.\n",
        "PUMP_OPERATOR(==)\nPUMP_OPERATORS(Pump, <<)\n",
    ],
)
def test_complete_code_is_not_told(repository, compare, code):
    repository.commit({**PACKAGE, PATH: CPP % PUMP})
    repository.write({PATH: CPP % (PUMP + code)})
    result = compare(repository)
    assert not [line for item in result.subjects for line in sentences(item) if "breaks off" in line]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            "int Pump::level(int a) { return a; }\n",
            "int Pump::level(int a) { speed = a; }\n",
            "function 'Pump::level' no longer returns a value",
        ),
        (
            "",
            "template <typename T>\nPump operator+(Pump a, T b) { Pump c; c.speed = a.speed + b; }\n",
            "function 'operator+' returns no value of its type 'Pump'",
        ),
        (
            "",
            'static std::string name() { ROS_INFO("no name"); }\n',
            "function 'name' returns no value of its type 'std::string'",
        ),
    ],
)
def test_a_function_without_its_result_is_told(repository, compare, old, new, expected):
    lines, broken = review_cpp(repository, compare, PUMP + old, PUMP + new)
    assert lines == [expected]
    assert (expected in broken) == bool(old)


@pytest.mark.parametrize(
    "code",
    [
        "void stop() { }\n",
        "inline void stop() { }\n",
        "Pump::Pump(int a) : speed(a) { }\n",
        "Pump::~Pump() { }\n",
        "Pump::operator bool() const { fail(); }\n",
        "int level() { throw 1; }\n",
        "int level() { std::abort(); }\n",
        "int level() { while (true) { step(); } }\n",
        "int level() { CHECK(1); }\n",
        "auto level() { step(); }\n",
        "typename std::enable_if<true, void>::type level() { step(); }\n",
        "TEST(Pump, level) { step(); }\n",
        "int values[] = {1, 2};\nint other{3};\n",
    ],
)
def test_functions_that_need_no_return_are_not_told(repository, compare, code):
    assert review_cpp(repository, compare, PUMP, PUMP + code)[0] == []


def test_faulty_code_that_the_old_version_had_is_not_told(repository, compare):
    old = PUMP + "int level() { step(1); }\nvoid stop(Pump& p) { p. }\n"
    lines, broken = review_cpp(repository, compare, old, old.replace("step(1)", "step(2)"))
    assert lines == broken == []


def test_an_added_source_of_a_built_package_breaks_it(repository, compare):
    code = PUMP + "void stop(Pump& p) { p. }\n"
    assert review_cpp(repository, compare, None, code)[1] == ["`p.` breaks off"]


SOURCE = "class Pump:\n    def __init__(self):\n        self.parts = []\n\n    def add(self, part):\n        {}\n"


@pytest.mark.parametrize(
    ("statement", "is_told"),
    [
        ("self.parts.append[part]", True),
        ("part = len[self.parts]", True),
        ("part = int[part]", True),
        ("part: list[int] = []", False),
        ("part = self.append[0]", False),
        ("self.parts[part]", False),
        ("open = []; part = open[1]", False),
    ],
)
def test_brackets_where_a_call_has_parentheses(repository, compare, statement, is_told):
    repository.commit({SCRIPT: SOURCE.format("self.parts.append(part)")})
    repository.commit({SCRIPT: SOURCE.format(statement)})
    result = compare(repository, "HEAD~1..HEAD")
    assert ("has square brackets where a call has parentheses" in str(breaking(result))) == is_told
    repository.commit({SCRIPT: SOURCE.format(statement) + "        print(part)\n"})
    result = compare(repository, "HEAD~1..HEAD")
    assert "square brackets" not in str([sentences(item) for item in result.subjects])
