"""The lines of a review about commands that sources start."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

FILES = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PYTHON = "import os\nimport subprocess\n\n\ndef stop(self, name):\n    self.count = 1\n    {}\n"
CPP = "#include <cstdlib>\nvoid stop(int name)\n{{\n  first();\n  {}\n}}\n"


def compare_code(repository, compare, path, template, old, new):
    repository.commit({**FILES, path: template.format(old)})
    repository.write({path: template.format(new)})
    return [line for line in sentences(subject(compare(repository), path)) if "commands" in line]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            'os.system("rosnode kill base")',
            'os.system("rosnode kill guard")\n    self.wait(1)\n    self.is_paused = True',
            ['commands added: os.system("rosnode kill guard"); commands removed: os.system("rosnode kill base")'],
        ),
        (
            "self.run()\n    self.wait(2)",
            'subprocess.Popen(["ros2", "run", "arm", name], shell=False)',
            ['commands added: subprocess.Popen(["ros2", "run", "arm", name])'],
        ),
        ("self.run()", 'self.system("stop")\n    self.popen("stop")\n    self.wait(2)', []),
        ("self.run()", "os.system(name)\n    self.wait(2)", []),  # no literal text
        ('os.system("stop")', 'self.wait(2)\n    os.system("stop")', []),
    ],
)
def test_commands_that_only_one_version_of_a_python_source_starts(repository, compare, old, new, expected):
    assert compare_code(repository, compare, "arm/scripts/stop.py", PYTHON, old, new) == expected


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        ('std::system("killall arm"); second(1); third();', ['commands added: std::system("killall arm")']),
        ('popen(("ls " + name).c_str(), "r"); second(1);', ['commands added: popen(("ls " + name).c_str())']),
        ('node->system("killall arm"); second(1); third();', []),
    ],
)
def test_commands_that_a_cpp_source_newly_starts(repository, compare, new, expected):
    assert compare_code(repository, compare, "arm/src/stop.cpp", CPP, "second();", new) == expected


def test_a_command_that_moves_to_another_source_is_not_told(repository, compare):
    old, new = PYTHON.format('os.system("stop arm")\n    self.wait(2)'), PYTHON.format("self.wait(3)\n    self.run()")
    repository.commit({**FILES, "arm/scripts/a.py": old, "arm/scripts/b.py": new})
    repository.write({"arm/scripts/a.py": new, "arm/scripts/b.py": old})
    result = compare(repository)
    assert not any("commands" in line for found in result.subjects for line in sentences(found))


def test_commands_of_an_added_program_are_told(repository, compare):
    repository.commit(FILES)
    repository.write({"arm/scripts/stop.py": PYTHON.format('os.system("systemctl reboot")')})
    lines = sentences(subject(compare(repository), "arm/scripts/stop.py"))
    assert 'commands added: os.system("systemctl reboot")' in lines
