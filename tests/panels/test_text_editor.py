"""The element at the cursor of a text editor."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.descriptions import examine
from linkwright.panels.description_details import describe
from linkwright.panels.text_editor import find_element_at

ARM = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="wheel" params="side">
    <link name="${side}_wheel">
      <inertial><mass value="1"/></inertial>
    </link>
  </xacro:macro>
  <link name="base"/>
  <xacro:wheel side="left"/>
  <xacro:wheel side="right"/>
  <joint name="left" type="fixed">
    <parent link="base"/><child link="left_wheel"/>
  </joint>
  <joint name="right" type="fixed"><parent link="base"/><child link="right_wheel"/></joint>
</robot>
"""


@pytest.mark.parametrize(
    ("line", "element"),
    [
        (1, None),
        (4, ("link", "left_wheel")),
        (7, ("link", "base")),
        (9, ("link", "right_wheel")),
        (11, ("joint", "left")),
    ],
)
def test_element_at_cursor_line_is_found(tmp_path: Path, line: int, element: tuple[str, str] | None) -> None:
    file = tmp_path / "arm.urdf.xacro"
    file.write_text(ARM)
    description = examine(file)
    assert description.robot is not None
    details = describe(description.robot, description.text, [], display="d", revision=1, prefix="")
    assert find_element_at(details, file, line) == element
    assert find_element_at(details, tmp_path / "other.xacro", line) is None
