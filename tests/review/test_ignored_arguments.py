"""Python functions that lose parameters which ``**kwargs`` still takes, and parameters at other places."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/arm/__init__.py": ""}


@pytest.mark.parametrize(
    ("old", "new", "body", "is_breaking"),
    [
        ("a, tool=None, **kwargs", "a, **kwargs", "return a", True),
        ("a, *args, tool=None, **kwargs", "a, *args, **kwargs", "return a", True),
        ("a, *args, tool=None, **kwargs", "a, *args, **kwargs", "return b(**kwargs)", False),
        ("a, *args, tool=None, **kwargs", "a, *args, gripper=None, **kwargs", "return a", False),
        ("a, *, tool=None", "a, **kwargs", "return a", False),
        ("a, b=1", "a, x=0, b=1", "return a", True),
        ("a, b=1, c=2", "a, c=2, b=1", "return a", True),
        ("a, b=1", "a, b=1, x=0", "return a", False),
    ],
)
@pytest.mark.parametrize("form", ["def f({}):\n    {}\n", "class F:\n    def __init__(self, {}):\n        {}\n"])
def test_parameter_that_a_function_loses_is_breaking(repository, compare, form, old, new, body, is_breaking):
    for parameters, write in ((old, repository.commit), (new, repository.write)):
        text = form.format(parameters, body if "class" not in form else body.replace("return ", "self.x = "))
        write({**MANIFEST, "arm/arm/tools.py": text})
    assert bool(breaking(compare(repository))) is is_breaking
