from linkwright.learning import Edit, right, wrong

PACKAGE = "src/my_robot_description/"
XACRO, CONTROLLERS = PACKAGE + "urdf/mbot_control.xacro", PACKAGE + "config/controllers.yaml"
LAUNCH, WORLD = PACKAGE + "launch/control.launch.py", PACKAGE + "launch/control_world.launch.py"

JOINT = """    <joint name="{name}_wheel_joint">
      <command_interface name="velocity"/>
      <state_interface name="position"/>
      <state_interface name="velocity"/>
    </joint>"""
SECOND = """  </ros2_control>

  <ros2_control name="mbot_right_wheel" type="actuator">
    <hardware>
      <plugin>$(arg hardware)</plugin>
    </hardware>
    <xacro:driven_wheel name="right_wheel_joint"/>"""
NODES = ", ".join(f"'{name}'" for name in ("joint_state_broadcaster", "base_controller"))
LINEAR = """    linear.x.has_velocity_limits: true
    linear.x.max_velocity: 0.5
    linear.x.has_acceleration_limits: true
    linear.x.max_acceleration: 0.5
"""
NESTED = """    linear:
      x: {has_velocity_limits: true, max_velocity: 0.5, has_acceleration_limits: true, max_acceleration: 0.5}
"""
COMMAND = """    command = Command(['xacro ', str(model), ' hardware:=gazebo_ros2_control/GazeboSystem'])
    robot_description = ParameterValue(command, value_type=str)
"""
MODULE = """    mappings = {'hardware': 'gazebo_ros2_control/GazeboSystem'}
    robot_description = xacro.process_file(str(model), mappings=mappings).toxml()
"""
SPAWNER = "        Node(package='controller_manager', executable='spawner',"
MANAGER = """        Node(package='controller_manager', executable='ros2_control_node',
             parameters=[str(get_package_share_path('my_robot_description') / 'config' / 'controllers.yaml')]),
"""

CASES = [
    wrong("interfaces", "no type", Edit(XACRO, ' type="system"', ""), says='write type="system"'),
    wrong(
        "controllers",
        "a number in quotes",
        Edit(CONTROLLERS, "wheel_radius: 0.06", 'wheel_radius: "0.06"'),
        says="wheel_radius is '0.06'",
    ),
    right(
        "interfaces",
        "joints without a macro",
        Edit(XACRO, '    <xacro:driven_wheel name="left_wheel_joint"/>', JOINT.format(name="left")),
        Edit(XACRO, '    <xacro:driven_wheel name="right_wheel_joint"/>', JOINT.format(name="right")),
    ),
    right(
        "interfaces",
        "hardware for each wheel",
        Edit(XACRO, '    <xacro:driven_wheel name="right_wheel_joint"/>', SECOND),
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
        says="write <plugin>$(arg hardware)</plugin>",
    ),
    right("controllers", "a faster manager", Edit(CONTROLLERS, "update_rate: 50", "update_rate: 100")),
    right("controllers", "a wildcard", Edit(CONTROLLERS, "\nbase_controller:\n", "\n/**:\n")),
    right("controllers", "a wildcard for one level", Edit(CONTROLLERS, "\nbase_controller:\n", "\n/*:\n")),
    right("controllers", "an exponent", Edit(CONTROLLERS, "wheel_radius: 0.06", "wheel_radius: 6e-2")),
    wrong(
        "controllers",
        "a tab",
        Edit(CONTROLLERS, "    wheel_radius", "\twheel_radius"),
        says="controllers.yaml, line 14, column 1: ",
    ),
    wrong(
        "controllers",
        "the diameter",
        Edit(CONTROLLERS, "wheel_radius: 0.06", "wheel_radius: 0.12"),
        says="wheel_radius is 0.12",
    ),
    wrong(
        "controllers",
        "a misspelled type",
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
    wrong(
        "start",
        "a forgotten dependency",
        Edit(PACKAGE + "package.xml", "  <exec_depend>diff_drive_controller</exec_depend>\n", ""),
        says="package.xml does not list 'diff_drive_controller'",
    ),
    wrong("speed", "the diameter", says="the diameter", answer="2.5"),
    right("speed", "measured", answer="4.97"),
    right("limits", "levels instead of dots", Edit(CONTROLLERS, LINEAR, NESTED)),
    right("limits", "as for Jazzy", Edit(CONTROLLERS, "    linear.x.has_velocity_limits: true\n", "")),
    wrong(
        "limits",
        "a misspelled parameter",
        Edit(CONTROLLERS, "linear.x.max_velocity", "linear.x.max_velocty"),
        says="base_controller has no linear.x.max_velocity",
    ),
    wrong(
        "limits",
        "below the manager",
        Edit(CONTROLLERS, LINEAR, ""),
        Edit(CONTROLLERS, "    update_rate: 50\n", "    update_rate: 50\n" + LINEAR),
        says="base_controller has no linear.x.max_velocity",
    ),
    wrong(
        "limits",
        "degrees",
        Edit(CONTROLLERS, "angular.z.max_velocity: 2.0", "angular.z.max_velocity: 115.0"),
        says="angular.z.max_velocity of base_controller is 115.0, but should be 2.0",
    ),
    right(
        "simulate",
        "the module xacro",
        Edit(WORLD, COMMAND, MODULE),
        Edit(WORLD, "from ament_index_python", "import xacro\nfrom ament_index_python"),
        Edit(WORLD, "from launch.substitutions import Command\n", ""),
        Edit(WORLD, "from launch_ros.parameter_descriptions import ParameterValue\n", ""),
    ),
    wrong(
        "simulate",
        "the wrong hardware",
        Edit(WORLD, " hardware:=gazebo_ros2_control/GazeboSystem", ""),
        says="the hardware is mock_components/GenericSystem",
    ),
    wrong(
        "simulate",
        "no space before the argument",
        Edit(WORLD, "' hardware:=", "'hardware:="),
        says="write a space before 'hardware:='",
    ),
    wrong(
        "simulate",
        "the plugin of ROS 1",
        Edit(XACRO, "libgazebo_ros2_control.so", "libgazebo_ros_control.so"),
        says="libgazebo_ros_control.so is the plugin of ROS 1",
    ),
    wrong(
        "simulate",
        "a file that is not there",
        Edit(XACRO, "/config/controllers.yaml</parameters>", "/controllers.yaml</parameters>"),
        says="controllers.yaml' does not exist",
    ),
    wrong("simulate", "two managers", Edit(WORLD, SPAWNER, MANAGER + SPAWNER), says="2 controller managers run"),
    wrong(
        "simulate",
        "a forgotten dependency",
        Edit(PACKAGE + "package.xml", "  <exec_depend>gazebo_ros</exec_depend>\n", ""),
        says="package.xml does not list 'gazebo_ros'",
    ),
]
