"""Interface files that are written while a process runs."""

from __future__ import annotations

import pytest

from linkwright.messages.definitions import library
from linkwright.messages.definitions.library import Library
from linkwright.messages.errors import InterfaceNotFoundError

MANIFEST = """<package format="3"><name>new_msgs</name><version>1.0.0</version><description>d</description>
<maintainer email="a@example.org">a</maintainer><license>l</license></package>"""


def test_new_interface_is_found_within_a_second(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    now = [0.0]
    monkeypatch.setattr(library.time, "monotonic", lambda: now[0])
    types = Library()
    with pytest.raises(InterfaceNotFoundError):
        types.definition("new_msgs/msg/New")
    (tmp_path / "new_msgs" / "msg").mkdir(parents=True)
    (tmp_path / "new_msgs" / "package.xml").write_text(MANIFEST)
    (tmp_path / "new_msgs" / "msg" / "New.msg").write_text("int32 number\n")
    for _ in range(3):
        now[0] += 0.4
        try:
            definition = types.definition("new_msgs/msg/New")
        except InterfaceNotFoundError:
            definition = None
    assert definition is not None
