"""A package of interface files in a separate workspace."""

from __future__ import annotations

from itertools import count
from pathlib import Path

import pytest

from linkwright.packages import PackageFinder
from linkwright.packages.active import use_finder

_numbers = count(1)
_MANIFEST = """<?xml version="1.0"?>
<package format="3"><name>{}</name><version>0.0.1</version><description>d</description>
<maintainer email="a@example.com">a</maintainer><license>MIT</license></package>
"""


class InterfacePackage:
    """A package of interface files.

    Each has another name, because the interfaces of a name are cached.
    """

    def __init__(self, folder: Path, name: str) -> None:
        self.folder = folder / "src" / name
        self.name = name
        self.folder.mkdir(parents=True)
        (self.folder / "package.xml").write_text(_MANIFEST.format(name))

    def write(self, kind: str, name: str, text: str, ending: str = "") -> Path:
        path = self.folder / kind / f"{name}.{ending or kind}"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path


@pytest.fixture
def interface_package(tmp_path):
    package = InterfacePackage(tmp_path, f"test{next(_numbers)}_msgs")
    with use_finder(PackageFinder(start=tmp_path, environment={})):
        yield package
