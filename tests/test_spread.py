"""What `--cases` leaves of parametrised tests."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.spread import spread

ROOT = Path(__file__).parents[1]


def cases(count: int) -> list[str]:
    return [f"tests/test_a.py::test_sum[{number}]" for number in range(count)]


def test_the_first_the_last_and_some_between_are_left():
    names = ["tests/test_a.py::test_alone", *cases(101), "tests/test_b.py::test_sum[1]"]
    assert spread(names, 5) == [names[0], *(names[1 + index] for index in (0, 25, 50, 75, 100)), names[-1]]


def test_one_case_is_the_first():
    assert spread(cases(3), 1) == cases(1)


@given(st.integers(0, 300), st.integers(1, 12))
def test_as_many_as_are_asked_for_are_left_each_once_and_in_order(count, most):
    left = spread(cases(count), most)
    assert len(left) == min(count, most)
    assert left == sorted(set(left), key=cases(count).index)


def test_none_at_all_is_refused():
    with pytest.raises(ValueError, match="not 0"):
        spread(cases(3), 0)


def test_pytest_leaves_out_cases_where_it_is_asked_to():
    command = [sys.executable, "-m", "pytest", "-q", "--collect-only", "-p", "no:cacheprovider", "--cases", "3"]
    told = subprocess.run(
        [*command, "tests/xacro/test_errors.py"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    names = re.findall(r"^tests/\S+::test_error\[", told.stdout, re.MULTILINE)
    assert len(names) == 3, told.stdout + told.stderr
