"""Executables of ``setup.py`` files whose module or function is gone."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

SETUP = """from setuptools import setup
setup(name='lamp', packages=['lamp'], entry_points={'console_scripts': ['glow = lamp.glow:main']})
"""
MANIFEST = PACKAGE_XML.replace("arm_description", "lamp").replace("ament_cmake", "ament_python")
FILES = {"lamp/package.xml": MANIFEST, "lamp/lamp/__init__.py": "", "lamp/setup.py": SETUP}
PROGRAM = "import time\n\n\ndef main():\n    print(time.time())\n"
LOST = "executable 'glow': its function 'main' was removed"


def compare_programs(repository, compare, old: str, new: str | None, **others: str):
    repository.commit({**FILES, "lamp/lamp/glow.py": old, **{f"lamp/lamp/{name}.py": "" for name in others}})
    repository.commit({"lamp/lamp/glow.py": new, **{f"lamp/lamp/{name}.py": text for name, text in others.items()}})
    return compare(repository, "HEAD~1..HEAD")


@pytest.mark.parametrize("start", ["", "from math import *\n"], ids=["alone", "beside-all-names-of-another-package"])
def test_an_executable_whose_function_is_gone_no_longer_starts(repository, compare, start):
    new = f"{start}import time\n\n\nclass Glow:\n    pass\n\n\nif __name__ == '__main__':\n    main()\n"
    review = compare_programs(repository, compare, start + PROGRAM, new)
    assert LOST in breaking(review)
    assert not [finding for finding in review.new_findings if finding.code == "LW827"]


def test_an_executable_whose_module_is_gone_no_longer_starts(repository, compare):
    assert "executable 'glow': its module 'lamp.glow' was removed" in breaking(
        compare_programs(repository, compare, PROGRAM, None)
    )


@pytest.mark.parametrize(
    "new",
    [
        PROGRAM.replace("time.time()", "1"),
        "from lamp.base import main\n",
        "from .base import *\n",
        "from lamp.base import *\n",
        "from math import *\n",
        "globals()['main'] = print\n",
    ],
)
def test_a_function_that_the_module_may_still_have_is_not_lost(repository, compare, new):
    assert LOST not in breaking(compare_programs(repository, compare, PROGRAM, new, base=PROGRAM))


def test_an_executable_that_never_had_its_function_is_not_lost(repository, compare):
    new = "import time\n"
    assert LOST not in breaking(compare_programs(repository, compare, "import sys\n", new))


def test_a_new_executable_is_not_lost(repository, compare):
    setup = SETUP.replace("'glow = lamp.glow:main'", "")
    repository.commit({**FILES, "lamp/setup.py": setup, "lamp/lamp/glow.py": PROGRAM})
    repository.commit({"lamp/setup.py": SETUP, "lamp/lamp/glow.py": "import time\n"})
    assert LOST not in breaking(compare(repository, "HEAD~1..HEAD"))
