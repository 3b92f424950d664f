"""Changes of the description in setup.py in a review."""

from __future__ import annotations

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

SETUP = "from setuptools import setup\nsetup(name='arm', description='%s', packages=[])\n"


def test_the_description_is_one_value(repository, compare):
    repository.commit({"a/package.xml": PACKAGE_XML, "a/setup.py": SETUP % "Node to move the arm"})
    repository.write({"a/setup.py": SETUP % "Nodes to move the arm"})
    result = compare(repository)
    assert sentences(subject(result, "a/setup.py")) == [
        "settings: 'description': Node to move the arm -> Nodes to move the arm"
    ]
    assert not breaking(result)
