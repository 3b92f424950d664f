"""The insertion of suppression comments, and their effect."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.language.proof import apply_edits
from linkwright.language.suppressions import find_code_at, make_suppression

XML, TEXT = "<!-- linkwright: ignore LW104 (reason) -->", "# linkwright: ignore LW104 (reason)"


@pytest.mark.parametrize(
    ("name", "text", "place", "expected"),
    [
        ("r.urdf", '<robot name="r">\n\t<lnik/>\n</robot>', "<lnik", f'<robot name="r">\n\t{XML}\n\t<lnik/>\n</robot>'),
        ("r.urdf", "<robot>\r\n  <a/>\r\n</robot>", "<a", f"<robot>\r\n  {XML}\r\n  <a/>\r\n</robot>"),
        ("r.urdf", '<robot>\n  <a\n    x="1"/>\n</robot>', "1", f'<robot>\n  {XML}\n  <a\n    x="1"/>\n</robot>'),
        ("r.urdf", "<robot>\n  <a/><b/>\n</robot>", "<b", f"<robot>\n  <a/><b/> {XML}\n</robot>"),
        ("r.urdf", "<robot>\n  <a/><b\n  x='1'/>\n</robot>", "<b", f"<robot>\n  <a/>{XML} <b\n  x='1'/>\n</robot>"),
        ("r.urdf", "<robot>\n  <a/>\n</robot>", "<robot", f"<robot> {XML}\n  <a/>\n</robot>"),
        ("r.urdf", "<robot\n  name='r'>\n</robot>", "<robot", f"{XML}\n<robot\n  name='r'>\n</robot>"),
        (
            "a.launch.py",
            "def f():\n    return g(\n        1)\n",
            "1",
            f"def f():\n    return g(\n        {TEXT}\n        1)\n",
        ),
        ("a.launch.py", 'a = """\nb"""\n', "b", f'a = """\nb"""  {TEXT}\n'),
        ("a.launch.py", 'a = """\nb\n"""\n', "b", None),
        ("a.yaml", "a: |\n  b\n  c\n", "b", None),
        ("a.yaml", "a:\n  b: 1\n", "b", f"a:\n  {TEXT}\n  b: 1\n"),
        ("CMakeLists.txt", "install(\n  FILES a)\n", "a)", f"install(\n  {TEXT}\n  FILES a)\n"),
        ("a.world", "<sdf><world/></sdf>", "<world", None),
        ("a.urdf", "no xml", "no", None),
    ],
)
def test_suppression_comment_is_inserted_at_valid_place(name, text, place, expected):
    edit = make_suppression(text, Path(name), "LW104", text.rindex(place))
    assert (None if edit is None else apply_edits(text, [edit])) == expected


def test_code_at_finds_code_in_comment():
    text = "<r>\n  <!-- linkwright: ignore LW104 LW105 (b) -->\n  <a/>\n</r>"
    assert find_code_at(text, text.index("LW105") + 5) == ("LW105", text.index("LW105"))
    assert find_code_at(text, text.index("ignore")) is None
    assert find_code_at(text, text.index("<a")) is None
