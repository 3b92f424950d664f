"""`import linkwright` offers the names for programs.

It loads each name only when it is used.
"""

from __future__ import annotations

import subprocess
import sys

import pytest

import linkwright

NAMES = [name for name in linkwright.__all__ if name != "__version__"]


@pytest.mark.parametrize("name", NAMES)
def test_public_names_are_documented_callables(name):
    found = getattr(linkwright, name)
    assert callable(found)
    assert found.__name__ == name
    assert found.__doc__


def test_importing_linkwright_loads_no_submodules():
    program = "import sys, linkwright; print(*sorted(m for m in sys.modules if m.startswith('linkwright.')))"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert result.stdout.split() == ["linkwright._version"]


def test_unknown_name_raises_attribute_error():
    with pytest.raises(AttributeError, match="module 'linkwright' has no attribute 'lode'"):
        linkwright.lode  # noqa: B018


def test_dir_lists_public_names():
    assert dir(linkwright) == linkwright.__all__


def test_expand_and_load_accept_text():
    text = '<robot name="a" xmlns:xacro="http://ros.org/wiki/xacro"><link name="${\'b\' + \'c\'}"/></robot>'
    assert '<link name="bc"/>' in str(linkwright.expand(text))
    assert linkwright.load(text).root == "bc"
