"""The lines of a review about keys, compared texts and constants that only one version of a source has."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

CPP = """#include <nlohmann/json.hpp>
void load(const json & sensor) {
  auto type = sensor["type"].as<std::string>();
  if (type == "lidar") { add(); }
  step();
}
"""
PYTHON = """import yaml


def load(path, name):
    config = yaml.safe_load(open(path))
    rate = config["rate"]
    if name == "left":
        use(rate)
    step()
"""
FUNCTIONS = {
    ".cpp": ("a/src/load.cpp", CPP, "void other() {{ {} }}\n"),
    ".py": ("a/scripts/load.py", PYTHON, "\n\ndef other():\n    {}\n"),
}
"""For each suffix: the path and text of a source, and a function with other code."""


@pytest.fixture
def review_lines(repository, compare):
    """Review two versions of files, and return the sentences."""

    def run(old, new):
        repository.commit(old)
        repository.write(new)
        result = compare(repository)
        assert not breaking(result)
        return [sentence for subject in result.subjects for sentence in sentences(subject)]

    return run


@pytest.mark.parametrize(
    ("suffix", "code", "expected"),
    [
        (".cpp", 'if (sensor["pose"]) { pose = sensor["pose"].as<int>(); }', 'sensor["pose"]'),
        (".cpp", 'if (type == "lidar" || type == "camera") { add(); }', 'type == "camera"'),
        (".cpp", 'auto found = names.find("tip");', 'names.find("tip")'),
        (".cpp", 'auto home = std::getenv("ROBOT_HOME");', 'std::getenv("ROBOT_HOME")'),
        (".cpp", 'if (type.compare("camera") == 0) { add(); }', 'type.compare("camera")'),
        (".cpp", 'if (strcmp(get(type), "camera") == 0) { add(); }', 'strcmp(get(type), "camera")'),
        (".py", 'limit = config["limits"]["speed"]', 'config["limits"], config["limits"]["speed"]'),
        (".py", 'limit = config.get("limit", 3)', 'config.get("limit", ...)'),
        (".py", 'use(rate if "extra" in config else 0)', '"extra" in config'),
        (".py", 'use(rate if "extra" not in config else 0)', '"extra" not in config'),
        (".py", 'use(name in ("left", "right"))', 'name in ("left", "right")'),
        (".py", 'use(name.lower() in ("left", "right"))', 'name.lower() in ("left", "right")'),
        (".py", 'use(name != "right")', 'name != "right"'),
        (".py", 'if name == "right":\n        step()', 'name == "right"'),
    ],
)
def test_keys_and_compared_texts_of_added_code_are_named(review_lines, suffix, code, expected):
    path, text, function = FUNCTIONS[suffix]
    lines = review_lines({path: text}, {path: text + function.format(code)})
    assert lines == ["code added: 'other()'", f"keys and compared texts added: {expected}"]


def test_keys_that_removed_code_read_are_named(review_lines):
    text = CPP + 'void other() { step(sensor["pose"].as<int>()); }\n'
    lines = review_lines({"a/src/load.cpp": text}, {"a/src/load.cpp": CPP})
    assert lines == ["code removed: 'other()'", 'keys and compared texts removed: sensor["pose"]']


@pytest.mark.parametrize(
    "code",
    [
        'use(config["rate"])',  # known
        'config["result"] = rate',  # written
        'use("result")',
        'use({"result": rate})',
        'print(config["result"])',
        'use(name == "please enter a name")',
        'use(name == "")',
        "use(config[name])",
        'use(list[1:"a"])',
        'use(f"{rate}" == rate)',
    ],
)
def test_other_texts_of_added_code_are_not_named(review_lines, code):
    path, text, function = FUNCTIONS[".py"]
    lines = review_lines({path: text}, {path: text + function.format(code)})
    assert not any("texts" in line for line in lines)


def test_keys_that_moved_to_another_source_are_not_named(review_lines):
    function = 'def read(config):\n    return config["mass"]\n'
    lines = review_lines(
        {"a/scripts/load.py": PYTHON + function, "a/scripts/other.py": PYTHON},
        {"a/scripts/load.py": PYTHON, "a/scripts/other.py": PYTHON + function},
    )
    assert not any("texts" in line for line in lines)


def test_many_keys_share_one_short_line(review_lines):
    path, text, function = FUNCTIONS[".py"]
    code = "\n    ".join(f'use(config["key_{number}"])' for number in range(30))
    (_, line) = review_lines({path: text}, {path: text + function.format(code)})
    assert line.startswith('keys and compared texts added: config["key_0"], ')
    assert line.endswith(" and 22 more")


SCRIPT = """import serial
from .tools import publish, read

PORT = "/dev/ttyACM0"
RATE: int = 50
OFFSETS = [0.1, -0.2]
LICENSE = "a text for human readers"
settings = read(PORT)
__version__ = "1.0.0"

if __name__ == "__main__":
    imu = serial.Serial(PORT)
    while True:
        publish(imu)
"""


def test_new_script_names_constants_and_its_main_code(review_lines):
    assert review_lines({"a/x.txt": ""}, {"a/scripts/imu.py": SCRIPT}) == [
        'constants added: PORT = "/dev/ttyACM0", RATE = 50, OFFSETS = [0.1, -0.2]',
        "code added outside of functions",
    ]


def test_new_program_names_functions_that_no_other_line_names(review_lines):
    script = "def read():\n    return 1\n\n\ndef main():\n    read()\n\n\nif __name__ == '__main__':\n    main()\n"
    program = "int half(int x) { return x / 2; }\nint main() { return half(2); }\n"
    assert review_lines({"a/x.txt": ""}, {"a/scripts/run.py": script, "a/src/run.cpp": program}) == [
        "code added: 'read()', 'main()'",
        "code added: 'half()', 'main()'",
    ]


@pytest.mark.parametrize(
    ("path", "old", "new", "expected"),
    [
        ("a/a.py", "A = 1\n", "A = 1\nB = 2\n", "constants added: B = 2"),
        ("a/a.py", "A = 1\nB = 2\n", "A = 1\n", "constants removed: B = 2"),
        ("a/a.py", "A = 1\nB = 2\n", "A = 1\nC = 2\n", "constants renamed: B -> C"),
        ("a/a.cpp", "int a;\n", "int a;\nconst int Arm::names[COUNT] = {1, 2};\n", "constants added: names = {1, 2}"),
        ("a/a.py", "AB = '/a'\n", "AB = '/a'\nC = AB + '/c'\n", "constants added: C = AB + '/c'"),
        ("a/a.py", "A = 1\nB = 2\n", "A = 1\nC = 3\n", "constants added: C = 3; constants removed: B = 2"),
        ("a/a.cpp", "int a = 1;\n", "int a = 1;\nconst double B = 2.5;\n", "constants added: B = 2.5"),
        ("a/a.cpp", "int a = 1;\n", "int a = 1;\n#define B 2.5\n", "constants added: B = 2.5"),
        ("a/a.cpp", "int a = 1;\n", 'int a = 1;\nstatic const char * B = "b";\n', 'constants added: B = "b"'),
    ],
)
def test_constants_outside_of_functions_are_named(review_lines, path, old, new, expected):
    assert review_lines({path: old}, {path: new})[0] == expected


@pytest.mark.parametrize(
    ("path", "new"),
    [
        ("a/a.py", "A = 1\nA_B = A\n"),
        ("a/a.py", "A = 1\nA[0] = 3\n"),
        ("a/a.py", "A = 1\nA.x = 3\n"),
        ("a/a.py", "A = 1\nB += 3\n"),
        ("a/a.cpp", "int A = 1;\nnamespace b = c;\n"),
        ("a/a.cpp", "int A = 1;\nusing B = int;\n"),
        ("a/a.cpp", "int A = 1;\nint count = 0;\nint b() { return ++count; }\n"),
        ("a/a.cpp", 'int A = 1;\nint rate = 5;\nvoid b() { n.getParam("rate", rate); }\n'),
        ("a/a.cpp", "int A = 1;\nint size = 0;\nvoid b() { read(&size); }\n"),
        ("a/a.cpp", "int A = 1;\nint b() { int c = 3; return c; }\n"),
    ],
)
def test_other_statements_are_not_constants(review_lines, path, new):
    old = "A = 1\n" if path.endswith(".py") else "int A = 1;\n"
    assert not any("constants" in line for line in review_lines({path: old}, {path: new}))


def test_variables_of_a_new_script_are_not_constants(review_lines):
    script = (
        "count = 0\nlast = None\ntopic = '/image'\nfor item in read(topic):\n    count += 1\n    use(item, count)\n"
    )
    assert "constants added: topic = '/image'" in review_lines({"a/x.txt": ""}, {"a/scripts/run.py": script})


def test_constant_that_a_line_names_is_no_other_code(review_lines):
    old = "RATE = 'fast'\nLIMIT = 1.0\n\n\ndef run():\n    go(RATE, LIMIT)\n"
    new = old.replace("RATE = 'fast'\n", "").replace("go(RATE, LIMIT)", "go(LIMIT)")
    assert review_lines({"a/run.py": old}, {"a/run.py": new}) == [
        "constants removed: RATE = 'fast'",
        "values in run: go(RATE, LIMIT) -> go(LIMIT)",
    ]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("kLow = 20.0f", "kLower = 18.0f", ["constants added: kLower = 18.0f; constants removed: kLow = 20.0f"]),
        ("kLow = 20.0f", "kLower = 20.0f", ["constants renamed: kLow -> kLower"]),
        ("  int count = 4;\n", "", ["code changed in 'Battery' (removed: count)"]),
    ],
)
def test_constants_of_classes_are_told(repository, compare, old, new, expected):
    text = "class Battery {\n  static constexpr float kLow = 20.0f;\n  int count = 4;\n};\n"
    repository.commit({"a/package.xml": PACKAGE_XML, "a/src/battery.hpp": text})
    assert old in text
    repository.write({"a/src/battery.hpp": text.replace(old, new)})
    assert sentences(compare(repository).subjects[0]) == expected


def test_a_constant_of_a_function_is_no_constant_of_the_source(repository, compare):
    text = "class Clock {\n  static constexpr int kStart = 3;\n  int next() {\n    return kStart;\n  }\n};\n"
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/clock.cpp": text})
    new = text.replace("return kStart;", "constexpr int kStep = 1000;\n    return kStart * kStep;")
    repository.write({"arm/src/clock.cpp": new.replace("kStart = 3;", "kStart = 3;\n  static constexpr int kEnd = 9;")})
    (found,) = compare(repository).subjects
    assert [line for line in sentences(found) if "constants" in line] == ["constants added: kEnd = 9"]
