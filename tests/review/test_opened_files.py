"""The files that an added Python script reads and writes."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

HEAD = "import os\nfrom pathlib import Path\n\n"


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        ("with open('a.yaml') as a, open('b.yaml', 'w') as b:\n    b.write(a.read())",
         "files written: 'b.yaml'; files read: 'a.yaml'"),
        ("text = Path('a.yaml').read_text()", "files read: 'a.yaml'"),
        ("for name in os.listdir():\n    open(os.path.join('c', name), mode='a')",
         "files written: `os.path.join('c', name)`"),
        ("def load(path):\n    return open(path)", None),
        ("total = 1 + 2", None),
    ],
)  # fmt: skip
def test_files_of_an_added_script_are_told(repository, compare, code, expected):
    repository.commit({"arm/package.xml": PACKAGE_XML})
    repository.write({"arm/scripts/make.py": f"{HEAD}{code}\n"})
    result = compare(repository)
    assert [line for found in result.subjects for line in sentences(found)] == ([expected] if expected else [])
    assert result.other_files == ([] if expected else ["arm/scripts/make.py"])
