"""Robots that `linkwright check` reads in tests."""

VALID_ROBOT = '<robot name="r">\n  <link name="base_link"/>\n</robot>\n'
XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LONG_AXIS = """<robot name="r">
  <link name="base_link"/>
  <link name="arm_link"/>
  <joint name="arm_joint" type="continuous">
    <parent link="base_link"/>
    <child link="arm_link"/>
    <axis xyz="0 0 2"/>
  </joint>
</robot>
"""
SELECTION = ["--select", "LW2"]
"""The options that select the rules of joints and links."""
