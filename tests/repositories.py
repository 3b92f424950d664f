"""Repositories of git with a package of an arm, whose description includes a macro."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping
from pathlib import Path

Files = Mapping[str, "str | bytes | None"]

PACKAGE_XML = """<?xml version="1.0"?>
<package format="3">
  <name>arm_description</name>
  <version>1.0.0</version>
  <description>An arm.</description>
  <maintainer email="ann@example.org">Ann</maintainer>
  <license>Apache-2.0</license>
  <exec_depend>xacro</exec_depend>
</package>
"""

MACRO = """<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="segment" params="name parent length:=0.5">
    <link name="${name}">
      <inertial>
        <mass value="2"/>
        <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>
      </inertial>
      <visual><geometry><box size="0.1 0.1 ${length}"/></geometry></visual>
    </link>
    <joint name="${name}_joint" type="revolute">
      <parent link="${parent}"/>
      <child link="${name}"/>
      <origin xyz="0 0 ${length}"/>
      <axis xyz="0 1 0"/>
      <limit lower="-1.5" upper="1.5" effort="10" velocity="1"/>
    </joint>
  </xacro:macro>
</robot>
"""

ARM = """<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">
  <xacro:include filename="$(find arm_description)/urdf/segment.xacro"/>
  <xacro:arg name="tool" default="none"/>
  <link name="base_link"/>
  <xacro:segment name="upper" parent="base_link"/>
  <xacro:segment name="middle" parent="upper"/>
  <xacro:segment name="lower" parent="middle"/>
  <xacro:if value="${'$(arg tool)' == 'probe'}">
    <link name="probe"/>
    <joint name="probe_joint" type="fixed">
      <parent link="lower"/>
      <child link="probe"/>
      <origin xyz="0 0 0.2"/>
    </joint>
  </xacro:if>
</robot>
"""

PACKAGE = {
    "arm_description/package.xml": PACKAGE_XML,
    "arm_description/urdf/segment.xacro": MACRO,
    "arm_description/urdf/arm.urdf.xacro": ARM,
}


class Repository:
    """A repository of git in a temporary folder."""

    def __init__(self, root: Path) -> None:
        self.root = root
        root.mkdir(parents=True)
        self.git("init", "--quiet", "--initial-branch=main")

    def git(self, *words: str) -> str:
        identity = ("-c", "user.name=Ann", "-c", "user.email=ann@example.org", "-c", "protocol.file.allow=always")
        result = subprocess.run(
            ["git", *identity, *words], cwd=self.root, capture_output=True, text=True, encoding="utf-8", check=True
        )
        return result.stdout.strip()

    def write(self, files: Files) -> None:
        """Write files; those without content are removed."""
        for name, content in files.items():
            path = self.root / name
            if content is None:
                path.unlink()
                continue
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content if isinstance(content, bytes) else content.encode())

    def commit(self, files: Files, message: str = "A change") -> str:
        """Write files, commit them, and return the hash of the commit."""
        self.write(files)
        self.git("add", "--all")
        self.git("commit", "--quiet", "--allow-empty", "--message", message)
        return self.git("rev-parse", "HEAD")
