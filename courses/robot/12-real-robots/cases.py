from linkwright.learning import Edit, right, wrong

FINDER = "src/my_senses/my_senses/color_finder.py"
DRIVER = "src/my_mission/my_mission/go_to_ball.py"
BRINGUP = "src/my_robot_bringup/"
MODEL, LAUNCH = BRINGUP + "urdf/mbot_hardware.xacro", BRINGUP + "launch/robot.launch.py"
CONTROLLERS = BRINGUP + "config/controllers.yaml"
CMAKE, MANIFEST = BRINGUP + "CMakeLists.txt", BRINGUP + "package.xml"

CHANNELS = "CHANNELS[message.encoding][COLORS.index(self.target)]"

TWO_SYSTEMS = """<?xml version="1.0"?>
<robot name="mbot" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="hardware" default="diffdrive_arduino/DiffDriveArduinoHardware"/>
  <xacro:arg name="device" default="/dev/ttyUSB0"/>
  <xacro:include filename="$(find my_robot_description)/urdf/mbot_base.xacro"/>
  <ros2_control name="wheels" type="system">
    <hardware>
      <plugin>$(arg hardware)</plugin>
      <param name="device">$(arg device)</param>
      <param name="left_wheel_name">left_wheel_joint</param>
      <param name="right_wheel_name">right_wheel_joint</param>
      <param name="baud_rate">115200</param>
      <param name="timeout_ms">500</param>
      <param name="loop_rate">50</param>
      <param name="enc_counts_per_rev">400</param>
      <param name="calculate_dynamics">true</param>
    </hardware>
    <joint name="left_wheel_joint">
      <command_interface name="velocity"><param name="min">-10</param></command_interface>
      <state_interface name="velocity"/>
      <state_interface name="position"/>
    </joint>
    <joint name="right_wheel_joint">
      <command_interface name="velocity"><param name="min">-10</param></command_interface>
      <state_interface name="velocity"/>
      <state_interface name="position"/>
    </joint>
  </ros2_control>
</robot>
"""

CASES = [
    wrong("install", "no ament_package", Edit(CMAKE, "ament_package()", ""), says="does not call ament_package()"),
    right(
        "camera",
        "the image is turned around",
        Edit(
            FINDER,
            "        found = find_color(",
            "        if message.encoding == 'bgr8':\n            pixels = pixels[:, :, ::-1]\n        found = find_color(",
        ),
        Edit(FINDER, CHANNELS, "COLORS.index(self.target)"),
    ),
    wrong(
        "camera",
        "always bgr8",
        Edit(FINDER, CHANNELS, "CHANNELS['bgr8'][COLORS.index(self.target)]"),
        says="of encoding rgb8, color_finder publishes nothing",
    ),
    wrong(
        "camera",
        "still rgb8",
        Edit(FINDER, CHANNELS, "COLORS.index(self.target)"),
        says="of encoding bgr8, color_finder publishes nothing",
    ),
    wrong(
        "camera",
        "no answer to other encodings",
        Edit(
            FINDER,
            "        if message.encoding not in CHANNELS:\n            self.get_logger().error(f'no colors in {message.encoding}', throttle_duration_sec=5.0)\n            return\n",
            "",
        ),
        says="color_finder.py, line",
    ),
    wrong(
        "camera",
        "a misspelled encoding",
        Edit(FINDER, "'bgr8'", "'brg8'"),
        says="of encoding bgr8, color_finder publishes nothing",
    ),
    wrong(
        "camera",
        "green and blue exchanged",
        Edit(FINDER, "(2, 1, 0)", "(2, 0, 1)"),
        says="For a green ball in an image of encoding bgr8",
    ),
    wrong(
        "camera",
        "an error for each image",
        Edit(FINDER, ", throttle_duration_sec=5.0", ""),
        says="It logs 5 errors",
    ),
    wrong(
        "camera",
        "no error",
        Edit(
            FINDER,
            "self.get_logger().error(f'no colors in {message.encoding}', throttle_duration_sec=5.0)\n            return",
            "return",
        ),
        says="It logs no error",
    ),
    right(
        "qos",
        "a profile of one's own",
        Edit(
            FINDER,
            "from rclpy.qos import qos_profile_sensor_data\n",
            "from rclpy.qos import QoSProfile, ReliabilityPolicy\n\nSENSOR = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)\n",
        ),
        Edit(FINDER, "self.on_lens,\n                                 qos_profile_sensor_data", "self.on_lens, SENSOR"),
        Edit(
            FINDER, "self.on_image,\n                                 qos_profile_sensor_data", "self.on_image, SENSOR"
        ),
    ),
    wrong(
        "qos",
        "only the images",
        Edit(FINDER, "self.on_lens,\n                                 qos_profile_sensor_data", "self.on_lens, 10"),
        says="is not compatible with that of the publisher",
    ),
    wrong(
        "qos",
        "only the camera_info",
        Edit(FINDER, "self.on_image,\n                                 qos_profile_sensor_data", "self.on_image, 10"),
        says="is not compatible with that of the publisher",
    ),
    wrong(
        "qos",
        "no import",
        Edit(FINDER, "from rclpy.qos import qos_profile_sensor_data\n", ""),
        says="color_finder.py, line",
    ),
    wrong(
        "qos",
        "also the publisher",
        Edit(FINDER, "'ball', 10)", "'ball', qos_profile_sensor_data)"),
        says="go_to_ball asks for reliable",
    ),
    right(
        "give-up",
        "nanoseconds",
        Edit(
            DRIVER,
            "if now - self.search_start > Duration(seconds=self.value('search_time')):",
            "if (now - self.search_start).nanoseconds > 1e9 * self.value('search_time'):",
        ),
    ),
    wrong(
        "give-up",
        "milliseconds",
        Edit(
            DRIVER,
            "Duration(seconds=self.value('search_time'))",
            "Duration(nanoseconds=int(1e6 * self.value('search_time')))",
        ),
        says="it no longer searches",
    ),
    wrong(
        "give-up",
        "a constant",
        Edit(DRIVER, "Duration(seconds=self.value('search_time'))", "Duration(seconds=20)"),
        says="with search_time:=5.0",
    ),
    wrong(
        "give-up",
        "the state stays",
        Edit(
            DRIVER,
            "                self.state = 'waiting'\n                self.drive(0.0, 0.0)",
            "                self.drive(0.0, 0.0)",
        ),
        says="it is searching",
    ),
    wrong(
        "give-up",
        "not anew",
        Edit(
            DRIVER,
            "                self.search()\n            if now",
            "                self.state = 'searching'\n            if now",
        ),
        says="does not search for another 5 s",
    ),
    wrong(
        "give-up",
        "the first search only",
        Edit(
            DRIVER,
            "        if message.data:\n            self.search()",
            "        if message.data:\n            self.state = 'searching'\n"
            "            self.search_start = self.search_start or self.get_clock().now()",
        ),
        says="after the next target",
    ),
    right("hardware", "without macros, with limits", {MODEL: TWO_SYSTEMS}),
    wrong(
        "hardware",
        "links for joints",
        Edit(MODEL, '<xacro:driven_wheel name="left_wheel_joint"/>', '<xacro:driven_wheel name="left_wheel_link"/>'),
        says="left_wheel",
    ),
    wrong(
        "hardware",
        "positions",
        Edit(MODEL, '<command_interface name="velocity"/>', '<command_interface name="position"/>'),
        says="The interfaces of 'left_wheel_joint' are: position",
    ),
    wrong(
        "hardware",
        "a constant",
        Edit(MODEL, "<plugin>$(arg hardware)</plugin>", "<plugin>diffdrive_arduino/DiffDriveArduinoHardware</plugin>"),
        says="With hardware:=mock_components/GenericSystem",
    ),
    wrong(
        "hardware",
        "the device is constant",
        Edit(MODEL, "$(arg device)", "/dev/ttyUSB0"),
        says="With device:=/dev/ttyACM1",
    ),
    wrong(
        "hardware",
        "wheels exchanged",
        Edit(MODEL, '"left_wheel_name">left', '"left_wheel_name">right'),
        says="'left_wheel_name' is 'right_wheel_joint'",
    ),
    wrong(
        "hardware",
        "a forgotten parameter",
        Edit(MODEL, '      <param name="baud_rate">57600</param>\n', ""),
        says="has no parameter 'baud_rate'",
    ),
    wrong("hardware", "a letter for a digit", Edit(MODEL, ">30<", ">3o<"), says="'loop_rate' is '3o'"),
    wrong("hardware", "an actuator", Edit(MODEL, 'type="system"', 'type="actuator"'), says="should be 'system'"),
    wrong(
        "bringup",
        "wheels exchanged",
        Edit(CONTROLLERS, "left_wheel_names: [left", "left_wheel_names: [right"),
        Edit(CONTROLLERS, "\n    right_wheel_names: [right", "\n    right_wheel_names: [left"),
        says="left_wheel_names of /base_controller is",
    ),
    wrong(
        "bringup",
        "no radius",
        Edit(CONTROLLERS, "    wheel_radius: 0.06\n", ""),
        says="wheel_radius of /base_controller is",
    ),
    wrong(
        "bringup",
        "stamped velocities",
        Edit(CONTROLLERS, "use_stamped_vel: false", "use_stamped_vel: true"),
        says="is use_stamped_vel false?",
    ),
    wrong(
        "bringup",
        "hardware is not handed to xacro",
        Edit(LAUNCH, ", ' hardware:=', hardware]", "]"),
        says="With hardware:=mock_components/GenericSystem",
    ),
    wrong(
        "bringup",
        "another default",
        Edit(
            LAUNCH,
            "default_value='diffdrive_arduino/DiffDriveArduinoHardware'",
            "default_value='mock_components/GenericSystem'",
        ),
        says="With no arguments",
    ),
    wrong(
        "bringup",
        "always the camera",
        Edit(LAUNCH, ",\n             condition=IfCondition(LaunchConfiguration('camera'))", ""),
        says="With camera:=false",
    ),
    wrong(
        "bringup",
        "never the camera",
        Edit(LAUNCH, "default_value='true'", "default_value='false'"),
        says="does not start the driver of the camera",
    ),
    wrong(
        "bringup",
        "no remapping",
        Edit(LAUNCH, ",\n             remappings=[('/base_controller/cmd_vel_unstamped', '/cmd_vel')]", ""),
        says="base_controller does not subscribe to /cmd_vel",
    ),
    right(
        "bringup",
        "the topics of the camera are remapped",
        Edit(
            LAUNCH,
            "namespace='camera'",
            "remappings=[('image_raw', '/camera/image_raw'), ('camera_info', '/camera/camera_info')]",
        ),
    ),
    wrong("bringup", "no namespace", Edit(LAUNCH, ", namespace='camera'", ""), says="usb_cam has no namespace"),
    wrong(
        "bringup",
        "another namespace",
        Edit(LAUNCH, "namespace='camera'", "namespace='/cam'"),
        says="usb_cam has the namespace '/cam'",
    ),
    wrong(
        "bringup",
        "a misspelled driver",
        Edit(LAUNCH, "'usb_cam_node_exe'", "'usb_cam_node'"),
        says="The executable of usb_cam is 'usb_cam_node'",
    ),
    wrong("bringup", "no space", Edit(LAUNCH, "' hardware:='", "'hardware:='"), says="robot.launch.py"),
    wrong(
        "bringup",
        "simulated time",
        Edit(LAUNCH, "'simulation': 'false'", "'simulation': 'true'"),
        says="The simulator starts",
    ),
    wrong(
        "bringup",
        "one controller",
        Edit(LAUNCH, "['joint_state_broadcaster', 'base_controller']", "['joint_state_broadcaster']"),
        says="there is no node '/base_controller'",
    ),
    right(
        "install",
        "three rules",
        Edit(
            CMAKE,
            "install(DIRECTORY config launch urdf DESTINATION share/${PROJECT_NAME})",
            "foreach(folder config launch urdf)\n  install(DIRECTORY ${folder} DESTINATION share/${PROJECT_NAME})\nendforeach()",
        ),
    ),
    right(
        "install",
        "with a slash and a folder",
        Edit(
            CMAKE,
            "install(DIRECTORY config launch urdf DESTINATION share/${PROJECT_NAME})",
            "install(DIRECTORY config/ DESTINATION share/${PROJECT_NAME}/config)\ninstall(DIRECTORY launch urdf DESTINATION share/my_robot_bringup)",
        ),
    ),
    wrong(
        "install",
        "a slash at the end",
        Edit(CMAKE, "config launch urdf", "config launch/ urdf"),
        says="launch/robot.launch.py",
    ),
    wrong(
        "install",
        "without share",
        Edit(CMAKE, "DESTINATION share/${PROJECT_NAME}", "DESTINATION ${PROJECT_NAME}"),
        says="does not install 'config/controllers.yaml'",
    ),
    wrong(
        "install",
        "parentheses for braces",
        Edit(CMAKE, "DESTINATION share/${PROJECT_NAME}", "DESTINATION share/$(PROJECT_NAME)"),
        says="with braces",
    ),
    wrong(
        "install",
        "no ament_cmake",
        Edit(CMAKE, "find_package(ament_cmake REQUIRED)\n", ""),
        says="does not call find_package(ament_cmake REQUIRED)",
    ),
    wrong(
        "install",
        "after ament_package",
        Edit(CMAKE, "install(DIRECTORY config launch urdf DESTINATION share/${PROJECT_NAME})\n", ""),
        Edit(
            CMAKE,
            "ament_package()",
            "ament_package()\ninstall(DIRECTORY config launch urdf DESTINATION share/${PROJECT_NAME})",
        ),
        says="must be the last command",
    ),
    wrong(
        "install",
        "before the project",
        Edit(CMAKE, "install(DIRECTORY config launch urdf DESTINATION share/${PROJECT_NAME})\n", ""),
        Edit(
            CMAKE, "project(my", "install(DIRECTORY config launch urdf DESTINATION share/${PROJECT_NAME})\nproject(my"
        ),
        says="below project(...)",
    ),
    wrong(
        "install",
        "a misspelled folder",
        Edit(CMAKE, "config launch urdf", "confg launch urdf"),
        says="which does not exist",
    ),
    wrong(
        "install",
        "a forgotten dependency",
        Edit(MANIFEST, "  <exec_depend>usb_cam</exec_depend>\n", ""),
        says="does not list 'usb_cam'",
    ),
    wrong(
        "install",
        "a forgotten dependency of another package",
        Edit("src/my_mission/package.xml", "  <exec_depend>my_senses</exec_depend>\n", ""),
        says="package.xml does not depend: 'my_senses' [LW848]",
    ),
    wrong("domain", "one port a domain", says="250 ports", answer="7442"),
    wrong("domain", "without the first port", says="Add the 7400", answer="10500"),
    wrong("domain", "a comma", says="without a comma", answer="17,900"),
    wrong("domain", "the domain before", says="domain 41", answer="17650"),
]
