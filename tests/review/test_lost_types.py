"""Files in C++ that use a class which a header of the repository no longer has."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, subject

HEADER = "#pragma once\nnamespace m {\nstruct Position {\n  float x;\n};\n}\n"
FILES = {
    "lib/include/m/position.h": HEADER,
    "lib/include/m/state.h": '#include "position.h"\n// Position\nnamespace m { struct State { Position p; }; }\n',
    "lib/src/main.cpp": "#include <m/state.h>\nint main() {\n  m::Position p;\n}\n",
    "lib/src/other.cpp": "#include <geometry_msgs/Position.h>\nvoid f(Position p);\n",
    "lib/src/far.cpp": "#include <m/state.h>\nvoid f(geometry_msgs::Position p);\n",
}
USED = "uses 'Position', which 'lib/include/m/position.h' no longer has"


def test_users_of_a_renamed_structure_do_not_build(repository, compare):
    repository.commit(FILES)
    repository.write({"lib/include/m/position.h": HEADER.replace("Position", "Place")})
    result = compare(repository)
    assert breaking(result) == [USED, USED]
    (change,) = subject(result, "lib/src/main.cpp").changes
    assert change.location.line == 3


@pytest.mark.parametrize(
    "files",
    [
        {"lib/include/m/more.h": "struct Position { int y; };\n"},
        {"lib/include/m/more.h": "typedef struct { int y; } Position;\n"},
        {"lib/include/m/more.h": "using Position = Place;\n"},
    ],
)
def test_a_structure_that_another_file_declares_is_not_lost(repository, compare, files):
    repository.commit(FILES)
    repository.write({"lib/include/m/position.h": HEADER.replace("Position", "Place"), **files})
    assert breaking(compare(repository)) == []


ENUMERATIONS = """#pragma once
namespace m {
enum Register { REG_SPEED = 1, REG_ODOM = 2 };
enum class Mode { kFast, kSlow };
}
"""
ENUMERATOR_FILES = {
    "lib/include/m/registers.h": ENUMERATIONS,
    "lib/test/registers_test.cc": "#include <m/registers.h>\nTEST(a, b) { send(m::REG_SPEED, 2); }\n",
    "lib/src/main.cpp": "#include <m/registers.h>\nint f(m::Mode mode) { return mode == m::Mode::kFast; }\n",
    "lib/src/other.cpp": "int f() { return REG_SPEED; }\n",
}


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("REG_SPEED = 1, ", "", {"lib/test/registers_test.cc": "REG_SPEED"}),
        ("kFast", "kRapid", {"lib/src/main.cpp": "kFast"}),
        ("kSlow", "kCareful", {}),
        ("enum Register { REG_SPEED = 1, ", "constexpr int REG_SPEED = 1;\nenum Register { ", {}),
    ],
)
def test_users_of_a_lost_enumerator_do_not_build(repository, compare, old, new, found):
    repository.commit(ENUMERATOR_FILES)
    assert old in ENUMERATIONS
    repository.write({"lib/include/m/registers.h": ENUMERATIONS.replace(old, new)})
    result = compare(repository)
    used = {item.path: str(item.changes[0].sentence) for item in result.subjects if "include" not in item.path}
    assert used == {
        path: f"uses '{name}', which 'lib/include/m/registers.h' no longer has" for path, name in found.items()
    }


def test_an_enumeration_that_moves_to_a_base_class_is_not_lost(repository, compare):
    enumeration = "  enum class Stream { kPlay, kRecord, kBoth };\n"
    derived = '#pragma once\n#include "base.h"\nclass Derived : public Base {\n public:\n%s  int n;\n};\n'
    use = '#include "derived.h"\nbool f(%s s) { return s == %s::kPlay || s == %s::kRecord || s == %s::kBoth; }\n'
    repository.commit(
        {
            "lib/src/base.h": "#pragma once\nclass Base {\n public:\n};\n",
            "lib/src/derived.h": derived % enumeration,
            "lib/src/main.cpp": use % (("Derived::Stream",) * 4),
        }
    )
    repository.write(
        {
            "lib/src/base.h": f"#pragma once\nclass Base {{\n public:\n{enumeration}}};\n",
            "lib/src/derived.h": derived % "",
            "lib/src/main.cpp": use % (("Base::Stream",) * 4),
        }
    )
    assert breaking(compare(repository)) == []


def test_a_name_in_another_namespace_is_not_that_of_the_header(repository, compare):
    header = "#pragma once\nnamespace m::control {\nenum class Mode { manual, automatic };\n}\n"
    use = "#include <m/mode.hpp>\nbool f(%sMode mode) { return mode == %sMode::manual; }\n"
    files = {"lib/include/m/mode.hpp": header, "lib/src/main.cpp": use % (("m::control::",) * 2)}
    repository.commit({**files, "lib/src/other.cpp": files["lib/src/main.cpp"]})
    header = header.replace("enum class Mode { manual, automatic };\n", "")
    repository.write({"lib/include/m/mode.hpp": header, "lib/src/main.cpp": use % (("m::types::",) * 2)})
    used = [item.path for item in compare(repository).subjects if "uses 'Mode'" in str(item.changes[0].sentence)]
    assert used == ["lib/src/other.cpp"]
