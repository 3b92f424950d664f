"""Repositories of git with a package of an arm, whose description includes a macro."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

Files = Mapping[str, "str | bytes | None"]

_SETTINGS = {
    "user.name": "Ann",
    "user.email": "ann@example.org",
    "protocol.file.allow": "always",
    "maintenance.auto": "false",  # a process after each commit
}
_OPTIONS = [word for name, value in _SETTINGS.items() for word in ("-c", f"{name}={value}")]

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


@cache
def _new_configuration() -> str:
    """Return the configuration that git gives to a new repository on this system."""
    with TemporaryDirectory() as folder:
        subprocess.run(["git", "init", "--quiet", folder], check=True)
        return Path(folder, ".git", "config").read_text(encoding="utf-8")


class Repository:
    """A repository of git in a temporary folder."""

    def __init__(self, root: Path) -> None:
        self.root = root
        folder = root / ".git"
        for name in ("objects", "refs/heads"):
            (folder / name).mkdir(parents=True)
        (folder / "config").write_text(_new_configuration(), encoding="utf-8")  # much faster than `git init`
        (folder / "HEAD").write_text("ref: refs/heads/main\n")

    def git(self, *words: str) -> str:
        result = subprocess.run(
            ["git", *_OPTIONS, *words], cwd=self.root, capture_output=True, text=True, encoding="utf-8", check=True
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
        return self._read_head() or self.git("rev-parse", "HEAD")

    def _read_head(self) -> str | None:
        """Return the hash of the last commit, or None if it is not in a file of its own."""
        kind, _, name = (self.root / ".git" / "HEAD").read_text().strip().rpartition(" ")
        file = self.root / ".git" / name
        return file.read_text().strip() if kind and file.is_file() else None
