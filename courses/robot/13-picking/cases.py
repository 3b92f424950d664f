from linkwright.learning import Edit, right, wrong

PACKAGE = "src/my_picking/"
ARM, SEEING, PICK = (PACKAGE + f"my_picking/{name}.py" for name in ("arm", "seeing", "pick"))
REACH, GRIP, MANIFEST = PACKAGE + "my_picking/reach.py", PACKAGE + "my_picking/grip.py", PACKAGE + "package.xml"

CASES = [
    right("fingers", "measured with the mouse", answer="0.071"),
    wrong("fingers", "one finger", says="what one finger moves", answer="0.035"),
    wrong("fingers", "centimeters", says="in cm", answer="7"),
    wrong("fingers", "millimeters", says="in mm", answer="70"),
    right("look", "smaller tolerances", Edit(ARM, "tolerance_above=0.01", "tolerance_above=0.005")),
    wrong("look", "a forgotten joint", Edit(ARM, "    'elbow_joint': 1.05,\n", ""), says="no angle for 'elbow_joint'"),
    wrong("look", "another angle", Edit(ARM, "1.8416", "-1.8416"), says="in the state 'look' of the SRDF it is 1.8416"),
    wrong("look", "a misspelled joint", Edit(ARM, "'elbow_joint'", "'elbow'"), says="no joint 'elbow'"),
    wrong("look", "another group", Edit(ARM, "'arm'", "'manipulator'"), says="calls the group 'arm'"),
    wrong("look", "another action", Edit(ARM, "'move_action'", "'move_group'"), says="No goal arrives"),
    wrong("look", "no constraints", Edit(ARM, "joint_constraints=joints", ""), says="no angle for"),
    wrong("reach", "another link", Edit(ARM, "'grasp_link'", "'hand_link'"), says="link_name is 'hand_link'"),
    wrong("reach", "another frame", Edit(ARM, "'base_footprint'", "'map'"), says="header.frame_id is 'map'"),
    wrong(
        "reach", "x and y exchanged", Edit(REACH, "arm.reach(x, y, z)", "arm.reach(y, x, z)"), says="the place in the"
    ),
    wrong(
        "reach",
        "it points up",
        Edit(ARM, "orientation.orientation = pose.orientation", "orientation.orientation.w = 1.0"),
        says="does not point down",
    ),
    wrong(
        "reach",
        "always content",
        Edit(REACH, "'the gripper is there' if done else 'the arm does not reach there'", "'the gripper is there'"),
        says="one that is 2 m away",
    ),
    wrong(
        "reach",
        "another name",
        Edit(PACKAGE + "setup.py", "            'reach = my_picking.reach:main',\n", ""),
        says="reach",
    ),
    right("grip", "a smaller force", Edit(ARM, "max_effort = 20.0", "max_effort = 15.0")),
    wrong(
        "grip",
        "a fixed position",
        Edit(ARM, "command.position = position", "command.position = 0.0"),
        says="in the goal is 0",
    ),
    wrong("grip", "no force", Edit(ARM, "        goal.command.max_effort = 20.0\n", ""), says="max_effort is 0 N"),
    wrong("grip", "another action", Edit(ARM, "gripper_cmd", "gripper_command"), says="gripper_controller/gripper_cmd"),
    wrong(
        "grip",
        "always held",
        Edit(ARM, "result.position > position + 0.01", "result.position >= position"),
        says="It logs 'it holds something'",
    ),
    wrong(
        "see",
        "a row before a column",
        Edit(SEEING, "(columns, rows)", "(rows, columns)"),
        says="should return (column, row)",
    ),
    wrong(
        "see", "every bright pixel", Edit(SEEING, " & (wanted > 2 * others)", ""), says="has 2000 pixels that are red"
    ),
    wrong("see", "the rotation inverted", Edit(SEEING, "@ rotation.T", "@ rotation"), says="A tilted camera"),
    wrong(
        "see",
        "the height of the camera forgotten",
        Edit(SEEING, "(height - position[2])", "-height"),
        says="looks down",
    ),
    wrong("see", "the lens forgotten", Edit(SEEING, "np.linalg.inv(k).T @ ", ""), says="looks down"),
    right("pick", "a little lower", Edit(PICK, "TABLE + 0.032", "TABLE + 0.028")),
    wrong(
        "pick",
        "always red",
        Edit(PICK, "find_pixels(picture, self.color)", "find_pixels(picture, 'red')"),
        says="The blue cube is still",
    ),
    wrong(
        "pick",
        "it does not open",
        Edit(PICK, "straight=True)\n        self.grip(OPEN)", "straight=True)"),
        says="does the gripper open?",
    ),
    wrong(
        "pick",
        "one place",
        Edit(PICK, "self.declare_parameter('place_x', 0.62).value", "0.62"),
        says="but should be at 0.550, 0.050",
    ),
    wrong("pick", "too high", Edit(PICK, "GRASP = TABLE + 0.032", "GRASP = TABLE + 0.08"), says="holds nothing"),
    wrong("pick", "a forgotten dependency", Edit(MANIFEST, "  <depend>shape_msgs</depend>\n", ""), says="shape_msgs"),
]
