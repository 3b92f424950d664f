"""Python modules in folders below an installed Python package."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

CLASS = "class Arm:\n    def __init__(self, rate=1, {}timeout=30):\n        self.rate = rate\n"


@pytest.mark.parametrize(
    ("path", "is_breaking"),
    [("arm/arm/robots/arm.py", True), ("arm/arm/arm.py", True), ("arm/robots/arm.py", False)],
)
def test_new_parameter_before_others_breaks_callers_of_a_module(repository, compare, path, is_breaking):
    manifest = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/arm/__init__.py": ""}
    build = {"arm/CMakeLists.txt": "find_package(ament_cmake)\nament_python_install_package(arm)\nament_package()\n"}
    repository.commit({**manifest, **build, path: CLASS.format("")})
    repository.write({path: CLASS.format("mode='slow', ")})
    assert bool(breaking(compare(repository))) is is_breaking
