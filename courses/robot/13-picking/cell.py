"""What the checks of the lesson share: the arm before the table, and move_group."""

import math
from functools import cache

import numpy as np

from linkwright import SteppedSimulation, load, standins
from linkwright.graph import ActionServer, LogLevel
from linkwright.learning import NotYet
from linkwright.messages import get_action, get_service
from linkwright.nodes import NodeOptions
from linkwright.packages import use_finder
from linkwright.planning.nodes.move_group import MoveGroup
from linkwright.planning.robot_model import RobotModel
from linkwright.testing import SteppedGraph

PACKAGE, ARM, BASE, TIP = "my_picking", "my_robot_arm", "base_footprint", "grasp_link"
SIM_TIME = ["--ros-args", "-p", "use_sim_time:=true"]
CONTROLLERS = ("joint_state_broadcaster", "arm_controller", "gripper_controller")
TABLE, CUBE = 0.3, 0.04
LOOK = {
    "shoulder_pan_joint": 0.0,
    "shoulder_lift_joint": 0.25,
    "elbow_joint": 1.05,
    "wrist_1_joint": 0.0,
    "wrist_2_joint": 1.8416,
    "wrist_3_joint": 0.0,
}


def shipped(work, package):
    """Return the folder of a package that comes with Linkwright."""
    return work.finder.find(package)


def arguments(work):
    """Return the arguments of the description for the simulator."""
    return {"simulator": "gz", "controllers": str(shipped(work, ARM) / "config" / "gz_controllers.yaml")}


@cache
def move_group_parameters(work):
    """Return the parameters of move_group, as pick_and_place.launch.py sets them."""
    standins.activate()
    from moveit_configs_utils import MoveItConfigsBuilder

    with use_finder(work.finder):
        builder = MoveItConfigsBuilder("mbot_arm", package_name=ARM).robot_description(mappings=arguments(work))
        return {**builder.to_moveit_configs().to_dict(), "use_sim_time": True}


class Cell(SteppedSimulation):
    """The arm before the table with its controllers and move_group.

    Args:
        work: the learner's workspace.
        cubes: x, y and yaw of cubes by color; the others stay where the world has them.
    """

    def __init__(self, work, cubes=None):
        world = shipped(work, "my_robot_gazebo") / "worlds" / "table.world"
        robot = shipped(work, ARM) / "config" / "mbot_arm.urdf.xacro"
        with use_finder(work.finder):
            super().__init__(world, robot, arguments=arguments(work), robot_state_publisher=True)
        self._work, self._cubes = work, cubes or {}

    def __enter__(self):
        with use_finder(self._work.finder):
            super().__enter__()
        for color, (x, y, yaw) in self._cubes.items():
            pose = (x, y, TABLE + CUBE / 2, 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))
            self.simulation.set_model_pose(f"{color}_cube", pose)
        self.advance(0.2)
        for name in CONTROLLERS:
            self._call("LoadController", "load_controller", name=name)
            self._call("ConfigureController", "configure_controller", name=name)
        self._call("SwitchController", "switch_controller", activate_controllers=list(CONTROLLERS), strictness=2)
        MoveGroup(self.graph, NodeOptions(parameters=move_group_parameters(self._work)))
        self.joints = self.record("/joint_states", "sensor_msgs/msg/JointState")
        self.advance(1.5)
        return self

    def _call(self, kind, service, **fields):
        service_type = get_service(f"controller_manager_msgs/srv/{kind}")
        client = self.node.create_client(service_type, f"/controller_manager/{service}")
        client.call_async(service_type.Request(**fields))
        self.advance(0.2)

    def run_program(self, name, *parameters, seconds):
        """Run a program of the learner until it ends.

        Raises:
            NotYet: it does not end in time.
        """
        words = [word for value in parameters for word in ("-p", value)]
        program = self.start_program(self._work.package(PACKAGE).program(name), [*SIM_TIME, *words])
        end = self.now + seconds
        while program.is_running and self.now < end:
            self.advance(0.5)
        if program.is_running:
            reason = self.last_warning()
            raise NotYet(
                en=f"'{name}' did not end within {seconds:g} s. {reason}",
                zh=f"“{name}”在 {seconds:g} s 内没有结束。{reason}",
            )
        self.advance(0.5)

    def joint_positions(self):
        """Return the positions of the joints by name."""
        return dict(zip(self.joints.last.name, self.joints.last.position, strict=True))

    def tip(self):
        """Return x, y and z of grasp_link in base_footprint."""
        with use_finder(self._work.finder):
            description = load(move_group_parameters(self._work)["robot_description"])
        model = RobotModel(description)
        found = self.joint_positions()
        model.move(np.array([found.get(name, 0.0) for name in model.joint_names]))
        return tuple(float(value) for value in model.link_pose(TIP)[:3])

    def cube(self, color):
        """Return x, y and z of the middle of a cube."""
        return tuple(self.simulation.model_pose(f"{color}_cube")[:3])

    def last_warning(self):
        """Return the last warning or error of a node, with its name; empty if there is none."""
        found = [record for record in self.log if record.level >= LogLevel.WARN]
        return f"{found[-1].node}: {found[-1].text}" if found else ""

    def last_line(self, name):
        """Return the last line that a node logged; empty if there is none."""
        found = [record.text for record in self.log if record.node.strip("/") == name]
        return found[-1] if found else ""


def sent_motion(work, name, *parameters):
    """Return the request that a program sends to move_action.

    Raises:
        NotYet: no goal arrives.
    """
    kind = get_action("moveit_msgs/action/MoveGroup")
    requests = []

    def execute(handle):
        requests.append(handle.request.request)
        handle.succeed()
        result = kind.Result()
        result.error_code.val = 1
        return result

    with SteppedGraph() as test:
        ActionServer(test.node, kind, "move_action", execute)
        words = [word for value in parameters for word in ("-p", value)]
        test.start_program(work.package(PACKAGE).program(name), ["--ros-args", *words])
        test.advance(3.0)
    if not requests:
        raise NotYet(en="No goal arrives at the action move_action.", zh="动作 move_action 没有收到目标。")
    if requests[0].group_name != "arm":
        raise NotYet(
            en=f"group_name of the request is '{requests[0].group_name}', but the SRDF calls the group 'arm'.",
            zh=f"请求的 group_name 是“{requests[0].group_name}”，而 SRDF 中的组名是“arm”。",
        )
    if not requests[0].goal_constraints:
        raise NotYet(en="The request has no goal_constraints.", zh="请求没有 goal_constraints。")
    return requests[0]


def answer_gripper(work, position, reached):
    """Return the command that the program 'grip' sends, and what it logs when the fingers stop at a position."""
    kind = get_action("control_msgs/action/GripperCommand")
    commands = []

    def execute(handle):
        commands.append(handle.request.command)
        handle.succeed()
        return kind.Result(position=reached, reached_goal=abs(reached - position) < 0.01, stalled=True)

    with SteppedGraph() as test:
        ActionServer(test.node, kind, "gripper_controller/gripper_cmd", execute)
        program = work.package(PACKAGE).program("grip")
        test.start_program(program, ["--ros-args", "-p", f"position:={position}"])
        test.advance(3.0)
        lines = [record.text for record in test.log if record.node.strip("/") == "grip"]
    if not commands:
        raise NotYet(
            en="No goal arrives at the action gripper_controller/gripper_cmd.",
            zh="动作 gripper_controller/gripper_cmd 没有收到目标。",
        )
    return commands[0], lines[-1] if lines else ""


def camera(x, y, height):
    """Return k, position and rotation of a camera that looks straight down."""
    k = np.array([[381.4, 0.0, 320.5], [0.0, 381.4, 240.5], [0.0, 0.0, 1.0]])
    return k, np.array((x, y, height)), np.array([[0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
