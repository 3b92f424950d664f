from linkwright.learning import Edit, right, wrong

URDF_FOLDER = "src/my_robot_description/urdf/"
XACRO, PARTS = URDF_FOLDER + "mbot_base.xacro", URDF_FOLDER + "parts.xacro"
NAMESPACE = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'
CASTER_HEIGHT = "${-(base_length/2 + caster_radius)}"
TWO_PARAMETERS, LEFT = 'params="prefix reflect"', '<xacro:wheel prefix="left" reflect="1"/>'
INCLUDE = '  <xacro:include filename="$(find my_robot_description)/urdf/parts.xacro"/>\n'
FOOTPRINT = "${wheel_radius + 0.05}"

CASES = [
    wrong(
        "properties",
        "no dollar and no braces",
        Edit(XACRO, 'radius="${base_radius}"', 'radius="base_radius"'),
        says="write ${base_radius}",
    ),
    wrong(
        "macro",
        "a link with the same name in both calls",
        Edit(XACRO, '<link name="${prefix}_wheel_link">', '<link name="wheel_link">'),
        says="link 'wheel_link' is defined twice",
    ),
    wrong(
        "include",
        "below the calls",
        Edit(XACRO, INCLUDE, ""),
        Edit(XACRO, "</robot>", INCLUDE + "</robot>"),
        says="stand above the call",
    ),
    wrong("include", "no folder", Edit(XACRO, "/urdf/parts.xacro", "/parts.xacro"), says="urdf/parts.xacro'?"),
    wrong(
        "macro", "a call without the prefix", Edit(XACRO, LEFT, LEFT.replace("xacro:", "")), says="write <xacro:wheel"
    ),
    wrong(
        "arithmetic", "the number", Edit(XACRO, CASTER_HEIGHT, "-0.095"), says="when the check sets base_length to 0.3"
    ),
    wrong(
        "footprint",
        "a joint that turns",
        Edit(XACRO, 'name="base_joint" type="fixed"', 'name="base_joint" type="continuous"'),
        says="should be 'fixed'",
    ),
    wrong(
        "footprint",
        "a point with a visual",
        Edit(
            XACRO,
            '<link name="base_footprint"/>',
            '<link name="base_footprint"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>',
        ),
        says="without <visual>",
    ),
    right(
        "properties",
        "a property from another one",
        Edit(
            XACRO,
            '<xacro:property name="caster_radius" value="0.015"/>',
            '<xacro:property name="caster_radius" value="${0.03/2}"/>',
        ),
    ),
    wrong("properties", "no namespace", Edit(XACRO, NAMESPACE, ""), says="mbot_base.xacro, line"),
    wrong(
        "properties",
        "braces without a dollar",
        Edit(XACRO, 'radius="${base_radius}"', 'radius="{base_radius}"'),
        says="radius",
    ),
    wrong(
        "properties",
        "a misspelled name",
        Edit(XACRO, 'radius="${base_radius}"', 'radius="${base_raduis}"'),
        says="base_raduis",
    ),
    wrong(
        "properties",
        "a number that is left",
        Edit(XACRO, 'radius="${base_radius}"', 'radius="0.20"'),
        says="radius is 0.2 m, but should be 0.3",
    ),
    right(
        "macro",
        "a parameter with a default",
        Edit(XACRO, TWO_PARAMETERS, 'params="prefix reflect:=1"'),
        Edit(XACRO, LEFT, '<xacro:wheel prefix="left"/>'),
    ),
    right(
        "macro",
        "the distance as a parameter",
        Edit(XACRO, TWO_PARAMETERS, 'params="prefix y"'),
        Edit(XACRO, "${reflect*0.19}", "${y}"),
        Edit(XACRO, 'prefix="left" reflect="1"', 'prefix="left" y="0.19"'),
        Edit(XACRO, 'prefix="right" reflect="-1"', 'prefix="right" y="-0.19"'),
    ),
    wrong(
        "macro",
        "the right wheel at the left",
        Edit(XACRO, 'prefix="right" reflect="-1"', 'prefix="right" reflect="1"'),
        says="right_wheel_link' is at 0 0.19 -0.05",
    ),
    wrong("macro", "a call of an unknown macro", Edit(XACRO, LEFT, LEFT.replace("wheel ", "whell ")), says="whell"),
    wrong("macro", "a missing parameter", Edit(XACRO, LEFT, '<xacro:wheel prefix="left"/>'), says="reflect"),
    wrong(
        "arithmetic", "a height that is left", Edit(XACRO, CASTER_HEIGHT, "-0.095"), says="should be at 0.18 0 -0.165"
    ),
    wrong(
        "arithmetic",
        "the wrong sign",
        Edit(XACRO, CASTER_HEIGHT, "${base_length/2 + caster_radius}"),
        says="is at 0.18 0 0.095",
    ),
    right(
        "footprint",
        "a property for the height",
        Edit(
            XACRO,
            '<link name="base_footprint"/>',
            '<link name="base_footprint"/><xacro:property name="h" value="${0.05 + wheel_radius}"/>',
        ),
        Edit(XACRO, FOOTPRINT, "${h}"),
    ),
    wrong("footprint", "a number", Edit(XACRO, FOOTPRINT, "0.11"), says="should be at 0 0 0.15"),
    wrong(
        "footprint",
        "parent and child exchanged",
        Edit(
            XACRO,
            '<parent link="base_footprint"/>\n    <child link="base_link"/>',
            '<parent link="base_link"/>\n    <child link="base_footprint"/>',
        ),
        says="root of the tree is 'base_link'",
    ),
    wrong(
        "argument",
        "off by default",
        Edit(XACRO, 'default="true"', 'default="false"'),
        says="no link is called 'camera_link'",
    ),
    wrong("argument", "the wrong braces", Edit(XACRO, "$(arg camera)", "${arg camera}"), says="mbot_base.xacro, line"),
    wrong(
        "argument",
        "a condition that is always true",
        Edit(XACRO, "$(arg camera)", "true"),
        says="still has 'camera_link'",
    ),
    wrong("include", "a misspelled file", Edit(XACRO, "parts.xacro", "parst.xacro"), says="parst.xacro"),
    right("include", "a relative path", Edit(XACRO, "$(find my_robot_description)/urdf/parts.xacro", "parts.xacro")),
]
