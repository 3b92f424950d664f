"""Functions in which only names of variables, members or functions change have no line in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

CPP = """#include "arm.hpp"
double Arm::scale(double factor) {
  double result = factor * gain_;
  return result * offset_;
}
void Arm::onMode(int mode) { use(mode, gain_); }
void Arm::start() { onMode(1); stop(2); }
"""
HEADER = "class Arm {\n  double gain_;\n  double offset_;\n  void onMode(int mode);\n};\n"
PYTHON = """class Arm:
    def __init__(self, size):
        self._width = size
        total = 2 * size
        self.use(total)

    def limit(self):
        return self._width + other.height
"""
RETURN = "return self._width + other.{}"


def review_replaced(repository, compare, files, replaced):
    """Return the lines about sources in which texts are replaced."""
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), **files})
    changed = dict(files)
    for old, new in replaced.items():
        assert any(old in text for text in changed.values())
        changed = {path: text.replace(old, new) for path, text in changed.items()}
    repository.write(changed)
    return [line for subject in compare(repository).subjects for line in sentences(subject)]


@pytest.mark.parametrize(
    ("replaced", "expected"),
    [
        ({"result": "scaled"}, []),
        ({"factor": "share", "gain_": "scale_"}, []),
        ({"onMode": "on_mode"}, ["code renamed: 'Arm::onMode()' -> 'Arm::on_mode()'"]),
        (
            {"double result = factor * gain_": "double scaled = factor * gain_"},
            ["in 'Arm::scale()': `double result = factor * gain_` -> `double scaled = factor * gain_`"],
        ),
        ({"return result * offset_": "return result * limit_"}, ["code changed in 'Arm::scale()'"]),
        ({"stop(2)": "halt(2)"}, ["in 'Arm::start()': `stop(2)` -> `halt(2)`"]),
        (
            {"double result": "float result"},
            ["in 'Arm::scale()': `double result = factor * gain_` -> `float result = factor * gain_`"],
        ),
    ],
)
def test_names_in_cpp(repository, compare, replaced, expected):
    files = {"arm/src/arm.cpp": CPP, "arm/src/arm.hpp": HEADER}
    assert review_replaced(repository, compare, files, replaced) == expected


@pytest.mark.parametrize(
    ("replaced", "expected"),
    [
        ({"total": "double"}, []),
        ({"self._width": "self._length"}, []),
        (
            {"other.height": "other.length"},
            [f"in 'Arm.limit()': `{RETURN.format('height')}` -> `{RETURN.format('length')}`"],
        ),
        ({"use(total)": "use(size)"}, ["in 'Arm.__init__()': `self.use(total)` -> `self.use(size)`"]),
    ],
)
def test_names_in_python(repository, compare, replaced, expected):
    assert review_replaced(repository, compare, {"arm/scripts/arm.py": PYTHON}, replaced) == expected
