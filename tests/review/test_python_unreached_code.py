"""Code of Python sources, in a review, that a new exit keeps from running."""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences, subject

SOURCE = """import sys
import time


def wait(seconds):
    time.sleep(seconds)
    print("done")


wait(3)
print("start")
"""
START = "`print('start')` is never reached, because `{}` comes before it"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("wait(3)", "wait(3)\nsys.exit(1)", [START.format("sys.exit(1)")]),
        ("wait(3)", "wait(3)\nexit()\nwait(4)", [START.format("exit()")]),
        ("wait(3)", "wait(3)\nif sys.argv:\n    exit()", []),
        ('print("start")', "exit()", []),
        (
            "    time.sleep(seconds)\n",
            "    time.sleep(seconds)\n    return\n",
            ["in 'wait()': `print('done')` is never reached, because `return` comes before it"],
        ),
        (
            "import sys\n",
            "import sys\nsys.exit()\n",
            ["`wait(3)` is never reached, because `sys.exit()` comes before it"],
        ),
    ],
)
def test_statement_after_a_new_exit_is_told(repository, compare, old, new, expected):
    repository.commit({"a/scripts/pool.py": SOURCE})
    repository.commit({"a/scripts/pool.py": SOURCE.replace(old, new)})
    result = compare(repository, "HEAD~1..HEAD")
    lines = sentences(subject(result, "a/scripts/pool.py"))
    assert [line for line in lines if "never reached" in line] == expected
    repository.commit({"a/scripts/pool.py": SOURCE.replace(old, new) + "print(2)\n"})
    result = compare(repository, "HEAD~1..HEAD")
    assert not [line for item in result.subjects for line in sentences(item) if "never reached" in line]


def test_statements_before_the_new_exit_are_told_as_well(repository, compare):
    repository.commit({"a/scripts/pool.py": SOURCE})
    repository.commit({"a/scripts/pool.py": SOURCE.replace("wait(3)", "wait(120)\nexit()\nwait(3)")})
    lines = sentences(subject(compare(repository, "HEAD~1..HEAD"), "a/scripts/pool.py"))
    assert "`wait(3)` is never reached, because `exit()` comes before it" in lines
    assert any("`wait(120)` added" in line for line in lines)
