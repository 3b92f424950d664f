"""The list of tests for each Python names existing files."""

from __future__ import annotations

from tests.places import REPOSITORY


def test_each_python_list_names_existing_tests():
    lines = (REPOSITORY / "tests" / "each_python.txt").read_text(encoding="utf-8").splitlines()
    for line in filter(None, lines):
        path, _, test = line.partition("::")
        assert line.startswith("#") or (path.startswith("tests/") and (REPOSITORY / path).exists()), line
        if test:
            text = (REPOSITORY / path).read_text(encoding="utf-8")
            assert f"def {test}(" in text or f"class {test}:" in text, line
