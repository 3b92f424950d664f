from linkwright.learning import Edit, right, wrong

DESCRIPTION, WORLDS = "src/my_robot_description/", "src/my_worlds/"
BASE, PARTS = DESCRIPTION + "urdf/mbot_base.xacro", DESCRIPTION + "urdf/parts.xacro"
SIM, WORLD = DESCRIPTION + "urdf/mbot_sim.xacro", WORLDS + "worlds/yard.world"
LAUNCH, SETUP = WORLDS + "launch/load_mbot.launch.py", WORLDS + "setup.py"

WHEEL_COLLISION = """      <collision>
        <origin xyz="0 0 0" rpy="${pi/2} 0 0"/>
        <geometry>
          <cylinder radius="${wheel_radius}" length="${wheel_length}"/>
        </geometry>
      </collision>
"""
FLAT_COLLISION = WHEEL_COLLISION.replace('        <origin xyz="0 0 0" rpy="${pi/2} 0 0"/>\n', "")
BODY_INERTIA = '    <xacro:cylinder_inertial mass="5" radius="${base_radius}" length="${base_length}"/>\n'
PLAIN_INERTIA = """    <inertial>
      <mass value="5"/>
      <inertia ixx="0.0607" ixy="0" ixz="0" iyy="0.0607" iyz="0" izz="0.1"/>
    </inertial>
"""
GZ_DRIVE = """    <plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system">
      <left_joint>left_wheel_joint</left_joint>
      <right_joint>right_wheel_joint</right_joint>
      <wheel_separation>0.38</wheel_separation>
      <wheel_radius>0.06</wheel_radius>
"""
WALL_POSE = "<pose>3 0 0.25 0 0 0</pose>"
COLLISION_OF_WALL = """<collision name="collision">
          <geometry><box><size>0.2 4 0.5</size></box></geometry>"""

CASES = [
    wrong(
        "masses",
        "the diameter as radius",
        Edit(BASE, 'mass="5" radius="${base_radius}"', 'mass="5" radius="${2*base_radius}"'),
        says="the moment ixx of 'base_link' is 0.211",
    ),
    wrong(
        "drive",
        "a misspelled frame",
        Edit(SIM, "<robot_base_frame>base_footprint", "<robot_base_frame>base_footprnt"),
        says="compare <odometry_frame>",
    ),
    wrong(
        "laser", "a sensor of no link", Edit(SIM, 'reference="laser_link"', 'reference="laser"'), says="names no link"
    ),
    right("laser", "at the front", Edit(SIM, "0 0 0.105", "0.1 0 0.105")),
    wrong("world", "commas in a pose", Edit(WORLD, "3 0 0.25 0 0 0", "3, 0, 0.25, 0, 0, 0"), says="not commas"),
    wrong("collisions", "none on the wheels", Edit(PARTS, WHEEL_COLLISION, ""), says="wheel_link' has no <collision>"),
    wrong(
        "collisions", "a flat wheel", Edit(PARTS, WHEEL_COLLISION, FLAT_COLLISION), says="its axis points along 0 0 1"
    ),
    right("masses", "numbers instead of a macro", Edit(BASE, BODY_INERTIA, PLAIN_INERTIA)),
    right("masses", "a lighter body", Edit(BASE, 'mass="5"', 'mass="4.2"')),
    wrong("masses", "grams", Edit(BASE, 'mass="5"', 'mass="5000"'), says="is 5000 kg"),
    wrong(
        "masses",
        "no mass of the wheels",
        Edit(PARTS, "<xacro:cylinder_inertial", "<!-- <xacro:cylinder_inertial"),
        Edit(PARTS, 'rpy="${pi/2} 0 0"/>\n    </link>', 'rpy="${pi/2} 0 0"/> -->\n    </link>'),
        says="has no <inertial>",
    ),
    wrong(
        "drive",
        "the radius as diameter",
        Edit(SIM, "<wheel_diameter>0.12", "<wheel_diameter>0.06"),
        says="wheel diameter",
    ),
    wrong(
        "drive",
        "half of the separation",
        Edit(SIM, "<wheel_separation>0.38", "<wheel_separation>0.19"),
        says="wheel separation",
    ),
    wrong(
        "drive",
        "left and right exchanged",
        Edit(SIM, "<left_joint>left_", "<left_joint>right_"),
        Edit(SIM, "<right_joint>right_", "<right_joint>left_"),
        says="which joint is the left one",
    ),
    wrong(
        "drive",
        "a misspelled joint",
        Edit(SIM, "<left_joint>left_wheel_joint", "<left_joint>left_whell_joint"),
        says="but the robot has no such joint",
    ),
    right(
        "drive",
        "an old name of the plugin's folder",
        Edit(SIM, '<plugin name="diff_drive"', '<plugin name="drive_of_mbot"'),
    ),
    wrong("laser", "another topic", Edit(SIM, "~/out:=scan", "~/out:=laser"), says="should be '~/out:=scan'"),
    wrong(
        "laser",
        "another frame",
        Edit(SIM, "<frame_name>laser_link", "<frame_name>base_link"),
        says="frame of /scan is 'base_link'",
    ),
    wrong(
        "laser",
        "turned around",
        Edit(SIM, 'xyz="0 0 0.105" rpy="0 0 0"', 'xyz="0 0 0.105" rpy="0 0 3.14"'),
        says="the laser looks back",
    ),
    right("laser", "more samples", Edit(SIM, "<samples>360", "<samples>720")),
    wrong("world", "a wall that falls", Edit(WORLD, "      <static>true</static>\n", ""), says="'wall' must be static"),
    wrong(
        "world",
        "a ball without collision",
        Edit(
            WORLD,
            '<collision name="collision">\n          <geometry><sphere><radius>0.15</radius></sphere></geometry>\n        </collision>',
            "",
        ),
        says="did not move the ball",
    ),
    wrong("world", "another name", Edit(WORLD, '<model name="ball">', '<model name="bal">'), says="no model 'ball'"),
    right("world", "another color", Edit(WORLD, "0.8 0.1 0.1 1", "0.1 0.1 0.8 1")),
    wrong(
        "load",
        "another topic",
        Edit(LAUNCH, "'robot_description', '-entity'", "'robot_descripton', '-entity'"),
        says="still waits for the robot",
    ),
    wrong(
        "load",
        "no worlds installed",
        Edit(SETUP, "        ('share/' + package_name + '/worlds', glob('worlds/*')),\n", ""),
        says="yard.world",
    ),
    wrong(
        "load",
        "a forgotten dependency",
        Edit(WORLDS + "package.xml", "  <exec_depend>gazebo_ros</exec_depend>\n", ""),
        says="package.xml does not list 'gazebo_ros' as a dependency at run time",
    ),
    wrong("drive", "a decimal comma", Edit(SIM, ">0.38<", ">0,38<"), says="write a point as decimal separator"),
    wrong("drive", "centimeters", Edit(SIM, ">0.38<", ">38<"), says="lengths are in meters"),
    wrong(
        "drive",
        "one wheel twice",
        Edit(SIM, "<right_joint>right_", "<right_joint>left_"),
        says="name the same joint",
    ),
    wrong("drive", "no transform", Edit(SIM, "odom_tf>true", "odom_tf>false"), says="<publish_odom_tf>true"),
    wrong(
        "laser",
        "the left half alone",
        Edit(SIM, "<min_angle>-3.14", "<min_angle>0"),
        says="needs to see both sides",
    ),
    wrong(
        "laser",
        "upside down",
        Edit(SIM, 'xyz="0 0 0.105" rpy="0 0 0"', 'xyz="0 0 0.105" rpy="3.1416 0 0"'),
        says="'laser_link' has the wrong orientation",
    ),
    wrong("laser", "one ray", Edit(SIM, "<samples>360", "<samples>1"), says="has a single value"),
    wrong("laser", "no rate", Edit(SIM, "<update_rate>10</update_rate>", ""), says="<update_rate>10</update_rate>"),
    wrong("laser", "an unknown type", Edit(SIM, 'type="ray"', 'type="laser"'), says='write type="ray"'),
    wrong(
        "laser",
        "a sensor that ends before its plugin",
        Edit(SIM, '      <plugin name="laser"', '    </sensor>\n    <plugin name="laser"'),
        Edit(SIM, "    </sensor>\n  </gazebo>", "  </gazebo>"),
        says="close </sensor> after </plugin>",
    ),
    wrong("world", "a pose of URDF", Edit(WORLD, WALL_POSE, '<origin xyz="3 0 0.25"/>'), says="'wall' is at x = 0"),
    wrong("world", "degrees", Edit(WORLD, WALL_POSE, "<pose>3 0 0.25 0 0 90</pose>"), says="angles are in radians"),
    wrong(
        "world",
        "the sizes of URDF",
        Edit(
            WORLD,
            COLLISION_OF_WALL,
            '<collision name="collision">\n          <geometry><box size="0.2 4 0.5"/></geometry>',
        ),
        says="<box><size>0.2 4 0.5</size></box>",
    ),
    wrong("load", "no items", Edit(LAUNCH, "}.items()", "}"), says="write .items() after the dict"),
    wrong("load", "a small true", Edit(LAUNCH, "_time': True", "_time': true"), says="did you mean 'True'?"),
    wrong("wall", "the middle", says="middle of the wall", answer="3"),
    right("wall", "with noise", answer="2.91"),
]
