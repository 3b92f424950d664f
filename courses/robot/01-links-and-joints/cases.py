from linkwright.learning import Edit, right, wrong

URDF = "src/my_robot_description/urdf/mbot_base.urdf"

CASES = [
    right("body", "with another color", Edit(URDF, "1 0.4 0 1", "0 0 1 1")),
    right("body", "with numbers written differently", Edit(URDF, 'radius="0.20"', 'radius="2e-1"')),
    wrong("body", "a misspelt name", Edit(URDF, "base_link", "base_lnk"), says="there is 'base_lnk'"),
    wrong("body", "the diameter as radius", Edit(URDF, '"0.20"', '"0.40"'), says="radius is 0.4 m"),
    wrong("body", "a misspelt attribute", Edit(URDF, "length=", "lenght="), says="has no 'length'"),
    wrong("body", "no closing tag", Edit(URDF, "</robot>", ""), says="mbot_base.urdf, line"),
]
