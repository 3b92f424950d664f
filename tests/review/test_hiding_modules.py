"""Python modules that a package installs and that hide those of other packages."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

SETUP = "from setuptools import find_packages, setup\nsetup(name='arm', packages=find_packages())\n"


@pytest.mark.parametrize(
    ("package", "folder", "is_hiding"),
    [
        ("arm", "launch", True),
        ("arm", "platform", True),
        ("arm", "arm/launch", False),
        ("arm", "arm_launch", False),
        ("launch", "launch", False),
    ],
)
def test_installed_module_with_the_name_of_a_known_one_is_breaking(repository, compare, package, folder, is_hiding):
    manifest = PACKAGE_XML.replace("arm_description", package)
    repository.commit({"arm/package.xml": manifest, "arm/setup.py": SETUP, "arm/arm/__init__.py": ""})
    repository.write({f"arm/{folder}/__init__.py": "", "arm/setup.py": SETUP.replace("arm'", "arm', zip_safe=True")})
    result = compare(repository)
    line = f"installed Python modules added: '{folder.replace('/', '.')}'"
    assert any(line in sentences(found) for found in result.subjects)
    assert (line in breaking(result)) == is_hiding
