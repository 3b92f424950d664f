"""Patterns of `linkwright.loading.deferred`, compared with immediately compiled ones."""

from __future__ import annotations

import copy
import pickle
import re

import pytest

from linkwright.loading.deferred import lazy_pattern
from tests.imports import loaded_by


def test_lazy_pattern_behaves_like_compiled_pattern() -> None:
    lazy, compiled = lazy_pattern(r"(\w+)=(\d+)", re.IGNORECASE), re.compile(r"(\w+)=(\d+)", re.IGNORECASE)
    text = "a=1, b=22"
    for _ in range(2):
        assert lazy.findall(text) == compiled.findall(text)
        assert lazy.sub(r"\2", text) == compiled.sub(r"\2", text)
        assert lazy.search(text, 3)[0] == "b=22"  # type: ignore[index]
    assert (lazy.pattern, lazy.flags, lazy.groups) == (compiled.pattern, compiled.flags, compiled.groups)
    assert lazy_pattern(rb"\d").findall(b"a1") == [b"1"]
    assert not hasattr(lazy, "nothing")


def test_lazy_pattern_can_be_copied_and_pickled() -> None:
    lazy = lazy_pattern("a+")
    assert copy.copy(lazy).fullmatch("aa")
    assert pickle.loads(pickle.dumps(lazy)).fullmatch("aa")


@pytest.mark.parametrize("name", ["lint.targets", "xmltree.tinyxml", "lint.suppression"])
def test_modules_compile_no_patterns_on_import(name: str) -> None:
    refuse = "import pathlib, shlex, linkwright.urdf, re; re.compile = None"
    assert f"linkwright.{name}" in loaded_by(f"{refuse}; import linkwright.{name}")
