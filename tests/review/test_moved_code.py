"""The code of a script that moves into a function."""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences, subject

SCRIPT = "arm/scripts/arm_node"
MODULE = "arm/arm/arm_node.py"
CODE = """arm = Arm()
arm.limit = find_limit()
while arm.is_running():
    goal = arm.read()
    arm.move(goal)
"""
CALL = "#!/usr/bin/env python\nimport arm.arm_node\narm.arm_node.main()\n"


def as_function(code: str, name: str = "main") -> str:
    return f"def {name}():\n" + "".join(f"    {line}\n" for line in code.splitlines())


def as_script(code: str) -> str:
    return f"#!/usr/bin/env python\nif __name__ == '__main__':\n{as_function(code).partition(chr(10))[2]}"


@pytest.mark.parametrize(
    ("code", "ending"),
    [(CODE, ""), (CODE.replace("find_limit()", "arm.find_limit()"), ", with changes")],
)
def test_code_of_a_script_moves_into_a_module(repository, compare, code, ending):
    repository.commit({SCRIPT: as_script(CODE)})
    repository.write({SCRIPT: CALL, MODULE: as_function(code)})
    result = compare(repository)
    moved = f"code outside of functions moved to 'main()' in '{MODULE}'{ending}"
    assert sentences(subject(result, SCRIPT)) == [moved]
    assert not any("code added" in line for found in result.subjects for line in sentences(found))


def test_code_moves_into_a_function_of_the_same_script(repository, compare):
    repository.commit({SCRIPT: as_script(CODE)})
    repository.write({SCRIPT: f"#!/usr/bin/env python\n{as_function(CODE)}\nmain()\n"})
    assert sentences(subject(compare(repository), SCRIPT)) == ["code outside of functions moved to 'main()'"]


@pytest.mark.parametrize(
    "code", ["arm = Arm()\narm.start()\narm.stop()\n", CODE.replace("arm.", "leg.").replace("arm =", "leg =")]
)
def test_other_function_does_not_have_the_code(repository, compare, code):
    repository.commit({SCRIPT: as_script(CODE)})
    repository.write({SCRIPT: CALL, MODULE: as_function(code)})
    (line,) = sentences(subject(compare(repository), SCRIPT))
    assert line.startswith("outside of functions: `if __name__ == '__main__'` removed;")


def test_function_that_was_there_before_is_not_the_new_place(repository, compare):
    repository.commit({SCRIPT: as_script(CODE), MODULE: as_function(CODE)})
    repository.write({SCRIPT: CALL, MODULE: as_function(CODE) + "\nmain()\n"})
    (line,) = sentences(subject(compare(repository), SCRIPT))
    assert line.startswith("outside of functions: `if __name__ == '__main__'` removed;")
