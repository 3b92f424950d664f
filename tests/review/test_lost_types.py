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
