"""The types of message classes, for type checkers, also of the packages in a workspace."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from linkwright.messages.definitions.library import Library
from linkwright.messages.stub_files import package_stubs
from linkwright.packages import PackageFinder
from linkwright.packages.active import use_finder

MANIFEST = "<package><name>{}</name></package>"


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    package = tmp_path / "my_msgs"
    (package / "msg").mkdir(parents=True)
    (package / "srv").mkdir()
    (package / "package.xml").write_text(MANIFEST.format("my_msgs"))
    (package / "msg" / "Count.msg").write_text("uint8 MOST=9\nstd_msgs/Header header\nint32[] values\nInner inner\n")
    (package / "msg" / "Inner.msg").write_text("string name\n")
    (package / "msg" / "Wrong.msg").write_text("no_such_type x\n")
    (package / "srv" / "Reset.srv").write_text("bool all\n---\n")
    return tmp_path


def test_stubs_have_fields_and_omit_invalid_files(workspace: Path) -> None:
    library = Library()
    with use_finder(PackageFinder(start=workspace)):
        names = [name for kind in ("msg", "srv", "action") for name in library.names(kind, "my_msgs")]
        stubs = package_stubs("my_msgs", names, library)
    assert sorted(stubs) == ["my_msgs/__init__.pyi", "my_msgs/msg/__init__.pyi", "my_msgs/srv/__init__.pyi"]
    for text in stubs.values():
        ast.parse(text)
    messages = stubs["my_msgs/msg/__init__.pyi"]
    assert "import std_msgs.msg\n" in messages
    assert "    MOST: ClassVar[int]\n" in messages
    assert "    header: std_msgs.msg.Header\n" in messages
    assert "    def values(self) -> array[int]: ...\n" in messages
    assert "    inner: Inner\n" in messages
    assert "Wrong" not in messages
    assert "    Request = Reset_Request\n" in stubs["my_msgs/srv/__init__.pyi"]
