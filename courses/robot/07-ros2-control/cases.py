from linkwright.learning import Edit, right, wrong

PACKAGE = "src/my_robot_description/"
XACRO, CONTROLLERS = PACKAGE + "urdf/mbot_control.xacro", PACKAGE + "config/controllers.yaml"
LAUNCH = PACKAGE + "launch/control.launch.py"

JOINT = """    <joint name="{name}_wheel_joint">
      <command_interface name="velocity"/>
      <state_interface name="position"/>
      <state_interface name="velocity"/>
    </joint>"""
NODES = ", ".join(f"'{name}'" for name in ("joint_state_broadcaster", "base_controller"))

CASES = [
    right(
        "interfaces",
        "joints without a macro",
        Edit(XACRO, '    <xacro:driven_wheel name="left_wheel_joint"/>', JOINT.format(name="left")),
        Edit(XACRO, '    <xacro:driven_wheel name="right_wheel_joint"/>', JOINT.format(name="right")),
    ),
    wrong(
        "interfaces",
        "a position command",
        Edit(XACRO, '<command_interface name="velocity"/>', '<command_interface name="position"/>'),
        says="must be velocity; it is: position",
    ),
    wrong(
        "interfaces",
        "a link for a joint",
        Edit(XACRO, '"left_wheel_joint"', '"left_wheel_link"'),
        says="no joint 'left_wheel_joint'",
    ),
    wrong(
        "interfaces",
        "no position",
        Edit(XACRO, '      <state_interface name="position"/>\n', ""),
        says="no state interface 'position'",
    ),
    wrong(
        "interfaces",
        "the argument is not used",
        Edit(XACRO, "<plugin>$(arg hardware)", "<plugin>mock_components/GenericSystem"),
        says="should be gazebo_ros2_control/GazeboSystem",
    ),
    right("controllers", "a faster manager", Edit(CONTROLLERS, "update_rate: 50", "update_rate: 100")),
    right("controllers", "a wildcard", Edit(CONTROLLERS, "\nbase_controller:\n", "\n/**:\n")),
    wrong(
        "controllers",
        "the diameter",
        Edit(CONTROLLERS, "wheel_radius: 0.06", "wheel_radius: 0.12"),
        says="wheel_radius is 0.12",
    ),
    wrong(
        "controllers",
        "a misspelt type",
        Edit(CONTROLLERS, "DiffDriveController", "DiffDriveControler"),
        says="The type of base_controller",
    ),
    wrong(
        "controllers",
        "not installed",
        Edit(PACKAGE + "setup.py", "'config', ", ""),
        says="config/controllers.yaml",
    ),
    right(
        "start",
        "a spawner for each controller",
        Edit(
            LAUNCH,
            "             arguments=[" + NODES + "]),",
            "             arguments=['joint_state_broadcaster']),\n"
            "        Node(package='controller_manager', executable='spawner',\n"
            "             arguments=['base_controller']),",
        ),
    ),
    wrong("start", "one controller", Edit(LAUNCH, ", 'base_controller'", ""), says="/base_controller/odom"),
    wrong("speed", "the diameter", says="the diameter", answer="2.5"),
    right("speed", "measured", answer="4.97"),
]
