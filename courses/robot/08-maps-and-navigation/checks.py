import math

import numpy as np
from flat import BODY, CONFIG, MAP, PACKAGE, Flat, free_points, read_map, read_parameters, wall_points

from linkwright.graph import ActionClient, ActionServer, ServerGoalHandle
from linkwright.learning import NotYet, check
from linkwright.messages import get_action
from linkwright.navigation.grids.grid import FREE, OCCUPIED
from linkwright.navigation.maps.map_yaml import read_map_yaml
from linkwright.testing import SteppedGraph

MAPPING, NAVIGATION = "mapping.launch.py", "navigation.launch.py"
ROOMS = {"kitchen": (3.8, -0.8, math.pi), "hall": (0.0, 0.0, 0.0)}


def expect_parameters(running, node, parameters, names):
    """Require a node of a launch to have the parameters of a YAML file, and to use simulated time."""
    for name in names:
        if name not in parameters:
            raise NotYet(
                en=f"The YAML file does not set '{name}' of {node}.", zh=f"YAML 文件没有设置 {node} 的“{name}”。"
            )
        actual = running.wait_for_parameter(node, name)
        if actual != parameters[name]:
            raise NotYet(
                en=f"'{name}' of {node} is {actual}, and not {parameters[name]} as in the YAML file.",
                zh=f"{node} 的“{name}”是 {actual}，不是 YAML 文件中的 {parameters[name]}。",
            )
    if running.wait_for_parameter(node, "use_sim_time") is not True:
        raise NotYet(
            en=f"{node} does not use simulated time: use_sim_time is false.",
            zh=f"{node} 没有使用仿真时间：use_sim_time 是 false。",
        )


def expect_packaged(work, files, packages):
    """Require files to be installed, and packages to be listed in package.xml."""
    package = work.package(PACKAGE)
    package.expect_installed(*files)
    package.expect_dependencies(*packages)
    package.expect_no_findings()


@check("mapping", en="slam_toolbox has the frame of mbot.", zh="slam_toolbox 使用 mbot 的坐标系。")
def slam_has_frames(work):
    parameters = read_parameters(work, "config/slam.yaml", "slam_toolbox")
    if parameters.get("base_frame") != "base_footprint":
        raise NotYet(
            en=f"base_frame is '{parameters.get('base_frame')}'; mbot's frame on the ground is base_footprint.",
            zh=f"base_frame 是“{parameters.get('base_frame')}”；mbot 在地面上的坐标系是 base_footprint。",
        )
    expect_names(parameters, "slam.yaml", {"map_frame": "map", "odom_frame": "odom", "scan_topic": "scan"})
    if parameters.get("resolution", 0.05) != 0.05:
        raise NotYet(
            en=f"resolution is {parameters['resolution']}, but a cell should be 0.05 m wide.",
            zh=f"resolution 是 {parameters['resolution']}，一个格子应当宽 0.05 m。",
        )


def expect_names(parameters, file, names):
    """Require parameters, if they are set, to be names of mbot's frames and topics."""
    for name, expected in names.items():
        value = parameters.get(name, expected)
        if str(value).removeprefix("/") != expected:
            raise NotYet(
                en=f"{name} in {file} is '{value}', but mbot has '{expected}'.",
                zh=f"{file} 中的 {name} 是“{value}”，而 mbot 的是“{expected}”。",
            )


@check(
    "mapping",
    en="mapping.launch.py starts the flat and slam_toolbox, which draws a map.",
    zh="mapping.launch.py 启动公寓和 slam_toolbox，它画出地图。",
)
def slam_draws_map(work):
    parameters = read_parameters(work, "config/slam.yaml", "slam_toolbox")
    with work.package(PACKAGE).launch(MAPPING) as running:
        running.expect_node("/slam_toolbox")
        expect_parameters(running, "/slam_toolbox", parameters, ["base_frame", "minimum_travel_distance"])
        running.expect_node("/gazebo")
        try:
            running.wait_for_message("/map", lambda message: OCCUPIED in message.data)
        except NotYet:
            raise NotYet(
                en="slam_toolbox draws no wall; are scan_topic, odom_frame and max_laser_range in slam.yaml those of "
                "the lesson?",
                zh="slam_toolbox 没有画出墙；slam.yaml 中的 scan_topic、odom_frame 和 max_laser_range 与课文一致吗？",
            ) from None
        running.expect_transform("map", "base_footprint")


@check(
    "mapping",
    en="setup.py installs both files, and the package has no findings.",
    zh="setup.py 安装这两个文件，功能包没有问题。",
)
def mapping_is_packaged(work):
    expect_packaged(work, ["config/slam.yaml", f"launch/{MAPPING}"], ["launch", "my_flat", "slam_toolbox"])


@check("save", en="maps/flat.yaml is a map with cells of 5 cm.", zh="maps/flat.yaml 是格子为 5 cm 的地图。")
def map_is_readable(work):
    resolution = read_map(work).resolution
    if abs(resolution - 0.05) > 1e-6:
        raise NotYet(
            en=f"A cell of the map is {resolution:g} m wide, but should be 0.05 m as in slam.yaml.",
            zh=f"地图的格子宽 {resolution:g} m，应当与 slam.yaml 一样是 0.05 m。",
        )


@check("save", en="Both rooms are free on it.", zh="两个房间在地图上都是空的。")
def map_has_rooms(work):
    grid, points = read_map(work), free_points()
    for name, chinese, room in (
        ("hall", "门厅", points[points[:, 0] < 1.4]),
        ("kitchen", "厨房", points[points[:, 0] > 1.6]),
    ):
        cells = grid.cells_of(room)
        inside = ((cells >= 0) & (cells < grid.cells.shape)).all(axis=1)
        share = float((grid.cells[tuple(cells[inside].T)] == FREE).sum() / len(room))
        if share < 0.9:
            side = "<" if name == "hall" else ">"
            hint_en, hint_zh = ("Is flat.yaml as map_saver_cli wrote it?", "flat.yaml 与 map_saver_cli 写的一样吗？")
            if (grid.cells == FREE).any():
                hint_en = hint_zh = ""
            raise NotYet(
                en=f"The map shows only {share:.0%} of the {name}, the room with x {side} 1.5. {hint_en}",
                zh=f"地图只显示了{chinese}（x {side} 1.5 的房间）的 {share:.0%}。{hint_zh}",
            )


@check("save", en="The walls are where they are in the flat.", zh="墙的位置与公寓一致。")
def map_has_walls(work):
    grid = read_map(work)
    occupied = grid.centers_of(np.argwhere(grid.cells == OCCUPIED))
    if not len(occupied):
        raise NotYet(en="The map has no occupied cell.", zh="地图中没有占用的格子。")
    points = wall_points()
    distances = np.sqrt(((points[:, None] - occupied[None]) ** 2).sum(axis=2).min(axis=1))
    share = float((distances < 0.15).mean())
    if share < 0.85:
        raise NotYet(
            en=f"Only {share:.0%} of the walls are where they should be; is the frame of the map where mbot began?",
            zh=f"只有 {share:.0%} 的墙在应在的位置；地图的原点是 mbot 出发的地方吗？",
        )


@check("save", en="setup.py installs the map.", zh="setup.py 安装地图。")
def map_is_packaged(work):
    package = work.package(PACKAGE)
    path = package.file(MAP)
    image = read_map_yaml(path).image
    package.expect_installed(MAP, f"maps/{image.name}")


@check("door", en="The width of the door is right.", zh="门的宽度正确。")
def knows_door(work):
    slips = {
        22.0: NotYet(en="That is a number of cells; a cell is 0.05 m wide.", zh="这是格子数；一个格子宽 0.05 m。"),
        110.0: NotYet(en="That is in cm; the answer is in m.", zh="这是以 cm 为单位；答案以 m 为单位。"),
        2.1: NotYet(en="That is the wall beside the door.", zh="这是门旁边的墙。"),
    }
    work.expect_number(1.1, tolerance=0.1, slips=slips)


@check(
    "localize",
    en="navigation.launch.py starts map_server and amcl.",
    zh="navigation.launch.py 启动 map_server 和 amcl。",
)
def launch_localizes(work):
    parameters = read_parameters(work, CONFIG, "amcl")
    with work.package(PACKAGE).launch(NAVIGATION) as running:
        for name in ("/map_server", "/amcl"):
            running.expect_node(name)
        expect_parameters(running, "/amcl", parameters, ["base_frame_id", "max_particles"])
        expect_map(running)
        expect_map_frame(running, parameters)


def expect_map(running):
    try:
        running.wait_for_message("/map", lambda message: OCCUPIED in message.data)
    except NotYet:
        en, zh = ([problem.get(language) for problem in running.problems()] for language in ("en", "zh"))
        raise NotYet(
            en="map_server publishes no map; does a lifecycle_manager activate it, and is yaml_filename the path of "
            f"your map? {''.join(en[:1])}",
            zh="map_server 没有发布地图；lifecycle_manager 激活它了吗？yaml_filename 是你的地图的路径吗？"
            f"{''.join(zh[:1])}",
        ) from None


def expect_map_frame(running, parameters):
    """Require the transform that amcl publishes, or tell which of its parameters prevents it."""
    try:
        running.expect_transform("map", "base_footprint")
    except NotYet:
        names = {"global_frame_id": "map", "odom_frame_id": "odom", "scan_topic": "scan"}
        for name, expected in names.items():
            value = parameters.get(name, expected)
            if str(value).removeprefix("/") != expected:
                raise NotYet(
                    en=f"There is no transform from 'map' to 'base_footprint': {name} of amcl is '{value}', but mbot "
                    f"has '{expected}'.",
                    zh=f"没有从“map”到“base_footprint”的变换：amcl 的 {name} 是“{value}”，而 mbot 的是“{expected}”。",
                ) from None
        if parameters.get("set_initial_pose") is not True:
            raise NotYet(
                en="There is no transform from 'map' to 'base_footprint': amcl does not know where mbot begins; set "
                "set_initial_pose to true.",
                zh="没有从“map”到“base_footprint”的变换：amcl 不知道 mbot 从哪里出发；"
                "请把 set_initial_pose 设为 true。",
            ) from None
        raise


@check("localize", en="amcl corrects a wrong starting pose.", zh="amcl 修正不准的出发位姿。")
def amcl_corrects(work):
    for start in ((0.3, -0.2, 0.2), (-0.15, 0.2, -0.15)):
        with Flat(work, start=start, navigates=False) as test:
            for turn in (0.0, 0.8, -0.4, 0.8, -0.8, 0.4):
                test.drive(0.2, turn)
                test.watch(2.5)
            test.drive(0.0)
            test.watch(1.0)
            x, y, yaw = test.place
            if not len(test.estimates):
                reason = test.last_warning()
                raise NotYet(en=f"amcl publishes no pose. {reason}", zh=f"amcl 没有发布位姿。{reason}")
            pose = test.estimates.last.pose.pose
        error = math.dist((x, y), (pose.position.x, pose.position.y))
        turned = abs(math.remainder(2 * math.atan2(pose.orientation.z, pose.orientation.w) - yaw, math.tau))
        if error > 0.12 or turned > 0.12:
            away = math.hypot(*start[:2])
            raise NotYet(
                en=f"mbot began {away:.2f} m beside x = 0, y = 0. After 3 m of driving, the pose of amcl is wrong "
                f"by {error:.2f} m and {turned:.2f} rad.",
                zh=f"mbot 的出发点与 x = 0、y = 0 相差 {away:.2f} m。行驶 3 m 之后，amcl 的位姿仍相差 "
                f"{error:.2f} m 和 {turned:.2f} rad。",
            )


@check(
    "localize",
    en="setup.py installs the files, and the package has no findings.",
    zh="setup.py 安装这些文件，功能包没有问题。",
)
def localization_is_packaged(work):
    packages = ["launch_ros", "nav2_amcl", "nav2_lifecycle_manager", "nav2_map_server"]
    expect_packaged(work, [CONFIG, f"launch/{NAVIGATION}"], packages)


@check("navigate", en="Both costmaps know how large mbot is.", zh="两个代价地图都知道 mbot 有多大。")
def costmaps_have_radius(work):
    for name in ("global_costmap", "local_costmap"):
        parameters = read_parameters(work, CONFIG, name, name)
        radius = parameters.get("robot_radius")
        if "footprint" in parameters:
            continue
        if not isinstance(radius, int | float) or not BODY - 0.001 <= radius <= BODY + 0.1:
            raise NotYet(
                en=f"robot_radius of {name} is {radius}; the body of mbot has a radius of 0.2 m.",
                zh=f"{name} 的 robot_radius 是 {radius}；mbot 的车身半径是 0.2 m。",
            )


LAYERS = {
    "global_costmap": ("StaticLayer", "ObstacleLayer", "InflationLayer"),
    "local_costmap": ("ObstacleLayer", "InflationLayer"),
}


@check("navigate", en="The costmaps have their layers.", zh="代价地图的各层齐全。")
def costmaps_have_layers(work):
    for costmap, layers in LAYERS.items():
        parameters = read_parameters(work, CONFIG, costmap, costmap)
        names = parameters.get("plugins")
        names = names if isinstance(names, list) else []
        for name in names:
            if f"{name}.plugin" not in parameters:
                raise NotYet(
                    en=f"The plugins of {costmap} list '{name}', but there is no plugin below '{name}:'.",
                    zh=f"{costmap} 的 plugins 中有“{name}”，但“{name}:”下面没有 plugin。",
                )
        found = [str(parameters[f"{name}.plugin"]) for name in names]
        for layer in layers:
            accepted = (layer, "VoxelLayer") if layer == "ObstacleLayer" else layer
            if not any(kind.endswith(accepted) for kind in found):
                raise NotYet(
                    en=f"{costmap} has no {layer} among its plugins.", zh=f"{costmap} 的 plugins 中没有 {layer}。"
                )
        for name in names:
            expect_source(costmap, name, parameters)


def expect_source(costmap, layer, parameters):
    """Require the sources of an obstacle layer to be the scans of mbot."""
    for source in str(parameters.get(f"{layer}.observation_sources", "")).split():
        topic = parameters.get(f"{layer}.{source}.topic")
        if str(topic).removeprefix("/") != "scan":
            raise NotYet(
                en=f"The topic of {layer} of {costmap} is {topic}, but mbot's laser publishes /scan.",
                zh=f"{costmap} 的 {layer} 的 topic 是 {topic}，而 mbot 的激光发布 /scan。",
            )


PLANNERS = (
    "nav2_navfn_planner/NavfnPlanner",
    "nav2_theta_star_planner/ThetaStarPlanner",
    "nav2_smac_planner/SmacPlanner2D",
    "nav2_smac_planner/SmacPlannerHybrid",
    "nav2_smac_planner/SmacPlannerLattice",
)
"""The planners of nav2; newer versions of nav2 write :: for the slash."""


@check("navigate", en="The planner is one of nav2.", zh="规划器是 nav2 的。")
def planner_exists(work):
    parameters = read_parameters(work, CONFIG, "planner_server")
    names = parameters.get("planner_plugins")
    for name in names if isinstance(names, list) else ["GridBased"]:
        kind = str(parameters.get(f"{name}.plugin", PLANNERS[0]))
        if kind.replace("::", "/") not in PLANNERS:
            raise NotYet(
                en=f"The plugin of {name} is '{kind}', which nav2 does not have; that of the lesson is {PLANNERS[0]}.",
                zh=f"{name} 的 plugin 是“{kind}”，nav2 没有这个插件；课文中的是 {PLANNERS[0]}。",
            )


@check("navigate", en="mbot goes to the kitchen and touches nothing.", zh="mbot 去厨房，什么也不碰到。")
def goes_to_kitchen(work):
    with Flat(work) as test:
        send(test, *ROOMS["kitchen"])
        while test.now < 70.0 and not has_arrived(test, "kitchen"):
            test.watch(1.0)
        expect_arrival(test, "kitchen")
        expect_no_contact(test)


def send(test, x, y, yaw):
    """Send mbot to a pose."""
    kind = get_action("nav2_msgs/action/NavigateToPose")
    goal = kind.Goal()
    goal.pose.header.frame_id = "map"
    goal.pose.pose.position.x, goal.pose.pose.position.y = float(x), float(y)
    goal.pose.pose.orientation.z, goal.pose.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    ActionClient(test.node, kind, "navigate_to_pose").send_goal_async(goal)


def has_arrived(test, room):
    x, y, yaw = ROOMS[room]
    place = test.place
    return math.dist(place[:2], (x, y)) < 0.25 and abs(math.remainder(place[2] - yaw, math.tau)) < 0.3


def expect_arrival(test, room):
    if has_arrived(test, room):
        return
    x, y, yaw = test.place
    reason = test.last_warning()
    raise NotYet(
        en=f"mbot should be in the {room}, at {place_text(*ROOMS[room])}, but is at {place_text(x, y, yaw)}. {reason}",
        zh=f"mbot 应当在 {room}，即 {place_text(*ROOMS[room])}，现在在 {place_text(x, y, yaw)}。{reason}",
    )


def place_text(x, y, yaw):
    return f"x = {x:.1f}, y = {y:.1f}, yaw = {yaw:.1f}"


def expect_no_contact(test):
    if test.smallest_gap < BODY + 0.005:
        raise NotYet(
            en="mbot touches a wall or the furniture; its body has a radius of 0.2 m.",
            zh="mbot 碰到了墙或家具；它的车身半径是 0.2 m。",
        )


@check("navigate", en="navigation.launch.py starts nav2's servers.", zh="navigation.launch.py 启动 nav2 的服务器。")
def launch_navigates(work):
    controller = read_parameters(work, CONFIG, "controller_server")
    with work.package(PACKAGE).launch(NAVIGATION) as running:
        for name in ("/planner_server", "/controller_server", "/behavior_server", "/bt_navigator"):
            running.expect_node(name)
        try:
            expect_parameters(running, "/controller_server", controller, ["FollowPath.plugin"])
        except NotYet as reason:
            if "FollowPath.plugin" not in controller:
                raise
            raise NotYet(
                en=f"{reason}; is controller_server in node_names of a lifecycle_manager, and FollowPath in "
                "controller_plugins?",
                zh=f"{reason.text.get('zh')}；controller_server 在 lifecycle_manager 的 node_names 中吗？"
                "controller_plugins 中有 FollowPath 吗？",
            ) from None
        running.expect_node("/global_costmap/global_costmap")
        running.wait_for_message("/global_costmap/costmap")
        running.expect_transform("map", "base_footprint")


@check("navigate", en="package.xml lists nav2's servers.", zh="package.xml 列出 nav2 的服务器。")
def navigation_is_packaged(work):
    packages = ["nav2_behaviors", "nav2_bt_navigator", "nav2_controller", "nav2_planner"]
    expect_packaged(work, [CONFIG, f"launch/{NAVIGATION}"], packages)


@check(
    "send",
    en="go_to_room sends mbot to the kitchen and back to the hall, and ends when it is there.",
    zh="go_to_room 让 mbot 去厨房，再回到门厅；到达后程序结束。",
)
def goes_to_rooms(work):
    package = work.package(PACKAGE)
    main, rooms = package.program("go_to_room"), package.file("config/rooms.yaml")
    parameters = read_parameters(work, "config/rooms.yaml", "go_to_room")
    for room in ROOMS:
        if room not in parameters:
            raise NotYet(en=f"rooms.yaml has no '{room}'.", zh=f"rooms.yaml 中没有“{room}”。")
    with Flat(work) as test:
        for room in ("kitchen", "hall"):
            words = ["--params-file", str(rooms), "-p", f"room:={room}", "-p", "use_sim_time:=true"]
            program = test.start_program(main, ["--ros-args", *words])
            end = test.now + 70.0
            while test.now < end and program.is_running and not has_arrived(test, room):
                test.watch(1.0)
            if not test.has_goal():
                raise NotYet(
                    en="No goal arrives at the action navigate_to_pose.", zh="动作 navigate_to_pose 没有收到目标。"
                )
            expect_arrival(test, room)
            test.watch(8.0)
            expect_arrival(test, room)
            if program.is_running:
                raise NotYet(
                    en=f"mbot is in the {room}, but go_to_room does not end.",
                    zh=f"mbot 已在 {room}，但 go_to_room 没有结束。",
                )


POSES = {"kitchen": (3.8, -0.8, 3.14), "hall": (0.5, -0.4, 1.2)}
"""The rooms that the check gives as parameters."""


@check(
    "send",
    en="The goal is the pose of the room in the frame map.",
    zh="目标是房间在 map 坐标系中的位姿。",
)
def goal_is_room(work):
    main = work.package(PACKAGE).program("go_to_room")
    for room, (x, y, yaw) in POSES.items():
        pose = sent_goal(main, room, (x, y, yaw)).pose
        if pose.header.frame_id != "map":
            raise NotYet(
                en=f"header.frame_id of the goal is '{pose.header.frame_id}', but the rooms are in the frame 'map'.",
                zh=f"目标的 header.frame_id 是“{pose.header.frame_id}”，而房间的坐标系是“map”。",
            )
        place, turn = pose.pose.position, pose.pose.orientation
        actual = place.x, place.y, 2 * math.atan2(turn.z, turn.w)
        if math.dist(actual[:2], (x, y)) > 0.01 or abs(math.remainder(actual[2] - yaw, math.tau)) > 0.01:
            raise NotYet(
                en=f"With {room}:=[{x}, {y}, {yaw}], the goal is {place_text(*actual)}.",
                zh=f"{room}:=[{x}, {y}, {yaw}] 时，目标是 {place_text(*actual)}。",
            )


def sent_goal(main, room, pose):
    """Return the goal that go_to_room sends for a room."""
    return answer_goal(main, room, pose, ServerGoalHandle.succeed)[0]


def answer_goal(main, room, pose, finish):
    """Return the goal that go_to_room sends for a room, and what it logs after the result.

    Args:
        main: the program.
        room: the name of the room.
        pose: the pose of the room.
        finish: ends the goal, such as ServerGoalHandle.succeed.
    """
    kind = get_action("nav2_msgs/action/NavigateToPose")
    handles = []

    def execute(handle):
        finish(handle)
        return kind.Result()

    with SteppedGraph() as test:
        ActionServer(test.node, kind, "navigate_to_pose", execute, handle_accepted_callback=handles.append)
        words = ["-p", f"room:={room}", "-p", f"{room}:=[{', '.join(map(str, pose))}]"]
        test.start_program(main, ["--ros-args", *words])
        test.advance(5.0)
        if not handles:
            raise NotYet(
                en="No goal arrives at the action navigate_to_pose.", zh="动作 navigate_to_pose 没有收到目标。"
            )
        logged = len(test.log)
        handles[0].execute()
        test.advance(5.0)
        return handles[0].request, [record.text for record in test.log[logged:]]


@check("send", en="It tells whether mbot has arrived.", zh="它说明 mbot 是否到达。")
def tells_outcome(work):
    main = work.package(PACKAGE).program("go_to_room")
    _, arrived = answer_goal(main, "kitchen", POSES["kitchen"], ServerGoalHandle.succeed)
    try:
        _, aborted = answer_goal(main, "kitchen", POSES["kitchen"], ServerGoalHandle.abort)
    except Exception:  # noqa: BLE001  # the program may raise one if mbot has not arrived
        return
    if arrived and arrived == aborted:
        raise NotYet(
            en=f"It logs '{arrived[-1]}' when mbot has arrived, and also when the goal is aborted; is the status of "
            "the result compared with GoalStatus.STATUS_SUCCEEDED?",
            zh=f"mbot 到达时它在日志中写“{arrived[-1]}”，目标中止时也这样写；"
            "结果的 status 是与 GoalStatus.STATUS_SUCCEEDED 比较的吗？",
        )


@check(
    "send",
    en="setup.py installs rooms.yaml, and the package has no findings.",
    zh="setup.py 安装 rooms.yaml，功能包没有问题。",
)
def node_is_packaged(work):
    expect_packaged(work, ["config/rooms.yaml"], ["nav2_msgs"])
