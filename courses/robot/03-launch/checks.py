from linkwright.learning import NotYet, check

LAUNCH = "display.launch.py"
JOINTS = {"left_wheel_joint", "right_wheel_joint", "front_caster_joint", "back_caster_joint"}
NEEDED = ("joint_state_publisher", "launch", "launch_ros", "robot_state_publisher", "rviz2")


def package(work):
    return work.package("my_robot_description")


@check(
    "publisher",
    en="display.launch.py starts robot_state_publisher with the robot.",
    zh="display.launch.py 启动 robot_state_publisher，并把机器人交给它。",
)
def publishes_robot(work):
    with package(work).launch(LAUNCH) as running:
        running.expect_node("/robot_state_publisher")
        description = running.wait_for_message("/robot_description").data
    if "base_footprint" not in description:
        raise NotYet(
            en="The published robot has no base_footprint; it is not that of mbot_base.xacro.",
            zh="发布的机器人没有 base_footprint；它不是 mbot_base.xacro 中的机器人。",
        )


@check("joints", en="The positions of all four joints are published.", zh="四个关节的位置都发布了。")
def publishes_joints(work):
    with package(work).launch(LAUNCH) as running:
        names = set(running.wait_for_message("/joint_states").name)
        running.expect_distinct_nodes()
    if missing := sorted(JOINTS - names):
        raise NotYet(en=f"/joint_states has no {missing[0]}.", zh=f"/joint_states 中没有 {missing[0]}。")


@check(
    "joints",
    en="tf knows where the left wheel is on the robot.",
    zh="tf 知道左轮在机器人上的位置。",
)
def knows_wheel(work):
    with package(work).launch(LAUNCH) as running:
        running.expect_transform("base_link", "left_wheel_link", (0, 0.19, -0.05))


def topic_of(display):
    topic = display.get("Description Topic")
    return topic.get("Value") if isinstance(topic, dict) else None


def expect_robot_model(displays):
    """Require one of the RobotModel displays to be on, with the topic /robot_description."""
    shown = [display for display in displays if display.get("Value", display.get("Enabled")) is not False]
    if not shown:
        raise NotYet(
            en="The RobotModel display is switched off; write 'Value: true'.",
            zh="RobotModel 显示项被关闭了；请写“Value: true”。",
        )
    sources = {display.get("Description Source", "Topic") for display in shown}
    if "Topic" not in sources:
        raise NotYet(
            en=f"The Description Source of the RobotModel display is {min(sources)}, but should be Topic.",
            zh=f"RobotModel 显示项的 Description Source 是 {min(sources)}，应当是 Topic。",
        )
    topics = [topic_of(display) for display in shown]
    if not any(topics):
        raise NotYet(
            en="The RobotModel display has no Description Topic; write 'Value: /robot_description' below it, indented.",
            zh="RobotModel 显示项没有 Description Topic；请在它下面缩进写“Value: /robot_description”。",
        )
    if not any(str(topic).lstrip("/") == "robot_description" for topic in topics):
        raise NotYet(
            en=f"The Description Topic of the RobotModel display is {topics[0]}, but should be /robot_description.",
            zh=f"RobotModel 显示项的 Description Topic 是 {topics[0]}，应当是 /robot_description。",
        )


@check(
    "rviz",
    en="urdf.rviz shows the robot in the frame base_footprint.",
    zh="urdf.rviz 在坐标系 base_footprint 中显示机器人。",
)
def configuration_shows_robot(work):
    data = package(work).yaml("rviz/urdf.rviz")
    try:
        manager = data["Visualization Manager"]
        displays = [(str(display["Class"]), display) for display in manager["Displays"]]
        frame = manager["Global Options"]["Fixed Frame"]
    except (KeyError, TypeError) as error:
        what = str(error) if isinstance(error, KeyError) else "indentation"
        raise NotYet(
            en=f"urdf.rviz is not an RViz configuration: look for {what}, and compare the indentation with the text.",
            zh=f"urdf.rviz 不是 RViz 的配置：请检查 {what}，并对照文中的缩进。",
        ) from None
    robots = [display for name, display in displays if name == "rviz_default_plugins/RobotModel"]
    if not robots:
        names = ", ".join(name for name, _ in displays)
        raise NotYet(
            en=f"urdf.rviz has no RobotModel display (rviz_default_plugins/RobotModel); it has {names}.",
            zh=f"urdf.rviz 中没有 RobotModel 显示项（rviz_default_plugins/RobotModel）；有 {names}。",
        )
    expect_robot_model(robots)
    if frame != "base_footprint":
        raise NotYet(
            en=f"The fixed frame is '{frame}', but should be 'base_footprint'.",
            zh=f"固定坐标系是“{frame}”，应当是“base_footprint”。",
        )


@check("rviz", en="The launch file starts rviz2.", zh="launch 文件启动 rviz2。")
def starts_rviz(work):
    with package(work).launch(LAUNCH) as running:
        running.expect_rviz(package(work).file("rviz/urdf.rviz"))


@check(
    "argument",
    en="With model:=..., the launch file shows another robot.",
    zh="给出 model:=... 时，launch 文件显示另一个机器人。",
)
def shows_other_robot(work):
    other = package(work).file("urdf/mbot_base.urdf")
    with package(work).launch(LAUNCH, model=str(other)) as running:
        description = running.wait_for_message("/robot_description").data
    if "base_footprint" in description:
        raise NotYet(
            en="With model:=src/my_robot_description/urdf/mbot_base.urdf, the robot is still that of mbot_base.xacro.",
            zh="给出 model:=src/my_robot_description/urdf/mbot_base.urdf 时，仍是 mbot_base.xacro 中的机器人。",
        )


@check("argument", en="Without the argument, it shows mbot_base.xacro.", zh="不给参数时，显示 mbot_base.xacro。")
def shows_default(work):
    publishes_robot(work)


@check(
    "dependencies",
    en="package.xml lists the packages that the launch file uses.",
    zh="package.xml 列出了 launch 文件用到的功能包。",
)
def lists_dependencies(work):
    package(work).expect_dependencies(*NEEDED)
    if "ament_index_python" in package(work).file(f"launch/{LAUNCH}").read_text(encoding="utf-8"):
        package(work).expect_dependencies("ament_index_python")


@check(
    "install",
    en="setup.py installs the folders launch, rviz and urdf.",
    zh="setup.py 安装文件夹 launch、rviz 和 urdf。",
)
def installs_folders(work):
    package(work).expect_installed(
        "launch/display.launch.py", "rviz/urdf.rviz", "urdf/mbot_base.xacro", "urdf/parts.xacro"
    )


@check("install", en="The package has no findings.", zh="功能包没有任何问题。")
def has_no_findings(work):
    package(work).expect_no_findings()
