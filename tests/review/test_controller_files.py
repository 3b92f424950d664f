"""Parameter files of the plugins of ros2_control in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

PATH = "arm_description/urdf/arm.urdf.xacro"
ROBOT = """<robot name="arm" xmlns:xacro="http://ros.org/wiki/xacro"><link name="base"/>
<gazebo><plugin name="control" filename="gz_ros2_control-system">
  <parameters>$(find arm_description)/config/{name}.yaml</parameters>
</plugin></gazebo></robot>
"""
MANAGER = "controller_manager:\n  ros__parameters:\n    {names}\n"
BOTH, ARM_ONLY = (
    MANAGER.format(names="\n    ".join(f"{name}: {{type: a/B}}" for name in names))
    for names in (("arm_controller", "hand_controller"), ("arm_controller",))
)
WRITER = "with open(os.path.join(folder, 'both.yaml'), 'w') as file:\n    yaml.dump(values, file)\n"


@pytest.mark.parametrize(
    ("files", "reason"),
    [
        (
            {"config/both.yaml": BOTH},
            "programs that load or command the controller 'hand_controller' do not find it",
        ),
        ({"config/both.yaml": ARM_ONLY}, None),
        ({}, None),
        ({"scripts/write.py": WRITER}, "controllers that only 'config/both.yaml' configures do not start"),
        ({"scripts/read.py": WRITER.replace("'w'", "'r'")}, None),
    ],
)
@pytest.mark.parametrize("is_macro", [False, True])
def test_controllers_that_only_the_old_file_has_are_lost(repository, compare, files, reason, is_macro):
    text = ROBOT
    if is_macro:
        text = text.replace("<gazebo>", '<xacro:macro name="control"><gazebo>').replace(
            "</gazebo>", "</gazebo></xacro:macro>"
        )
    others = {f"arm_description/{path}": content for path, content in files.items()}
    manifest = {"arm_description/package.xml": PACKAGE_XML, "arm_description/config/arm.yaml": ARM_ONLY}
    repository.commit({**manifest, **others, PATH: text.format(name="both")})
    repository.write({PATH: text.format(name="arm")})
    result = compare(repository)
    assert any("parameters" in str(change.sentence) for item in result.subjects for change in item.changes)
    assert [str(change.reason) for _, change in result.breaking_changes] == ([reason] if reason else [])
    assert len(breaking(result)) == bool(reason)
