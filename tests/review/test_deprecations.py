"""The lines of a review about texts with which a source says that something is deprecated."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CPP = "void Arm::f() {\n  g(x);\n}\n"
PYTHON = "import warnings\ndef f():\n    g()\n"


@pytest.mark.parametrize(
    ("path", "text", "added", "expected"),
    [
        ("a.cpp", CPP, '  RCLCPP_WARN(log, "arm is depreciated, use %s", b);\n', "'arm is depreciated, use %s'"),
        ("a.hpp", CPP, '[[deprecated("use g")]] void h();\n', "'use g'"),
        ("a.py", PYTHON, "    warnings.warn('f will be removed')\n", "'f will be removed'"),
        ("a.cpp", CPP, '  // "deprecated"\n', None),
        ("a.cpp", CPP, '  RCLCPP_WARN(log, "arm is slow");\n', None),
    ],
)
def test_a_new_text_about_something_deprecated_is_told(repository, compare, path, text, added, expected):
    repository.commit({**MANIFEST, f"arm/{path}": text})
    repository.write(
        {f"arm/{path}": text + added if path != "a.py" else text.replace("    g()\n", f"{added}    g()\n")}
    )
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    told = [line for line in lines if "deprecated things" in line]
    assert told == ([] if expected is None else [f"new texts about deprecated things: {expected}"])
