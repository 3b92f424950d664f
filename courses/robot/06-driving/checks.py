import math
from functools import cache
from itertools import pairwise

from linkwright import SteppedSimulation
from linkwright.learning import NotYet, check, expect_published
from linkwright.messages import get_message
from linkwright.testing import SteppedGraph

STARTS = ((0.0, 0.0, 0.0), (1.0, -2.0, 2.0))
WANDER_STARTS = ((0.0, 0.0, 0.0), (0.0, 1.0, -2.0))
BESIDE_WALL = (0.0, -2.55, 0.0)
BODY = 0.2
TWIST = "geometry_msgs/msg/Twist"
BUDGET = 5.0
"""The seconds for which a node may compute without waiting."""


class Run:
    """A learner's program that drives mbot through a world."""

    def __init__(self, work, name, *, world="empty", start=(0.0, 0.0, 0.0), seed=0):
        x, y, yaw = start
        robot = work.package("my_robot_description").file("urdf/mbot_sim.xacro")
        self.main = work.package("my_control").program(name)
        self.test = SteppedSimulation(world, robot, pose=(x, y, 0, 0, 0, yaw), seed=seed)
        self.start = x, y

    def __enter__(self):
        self.test.__enter__()
        self.test.advance(0.2)
        self.commands = self.test.record("/cmd_vel", TWIST)
        self.test.start_program(self.main, ["--ros-args", "-p", "use_sim_time:=true"], budget=BUDGET)
        return self

    def __exit__(self, *error):
        return self.test.__exit__(*error)

    @property
    def position(self):
        return self.test.robot_pose()[:2]

    def drive(self, seconds, period=0.1):
        """Advance, and return the positions."""
        positions = []
        for _ in range(round(seconds / period)):
            self.test.advance(period)
            positions.append(self.position)
        expect_published(self.test, "/cmd_vel", TWIST, self.commands)
        return positions


def expect_meter(work, tolerance):
    for start in STARTS:
        with Run(work, "drive_meter", start=start) as run:
            positions = run.drive(12.0)
            driven = math.dist(run.start, positions[-1])
            still = math.dist(positions[-10], positions[-1]) < 0.005
        if driven < 0.05:
            raise NotYet(
                en=f"From x = {start[0]:g}, y = {start[1]:g}, the robot does not move: all velocities on /cmd_vel are "
                "zero.",
                zh=f"从 x = {start[0]:g}，y = {start[1]:g} 出发，机器人没有动：/cmd_vel 上的速度都是零。",
            )
        if not still:
            raise NotYet(
                en=f"12 s after its start at x = {start[0]:g}, y = {start[1]:g}, yaw = {start[2]:g}, the robot still "
                f"drives; it is {driven:.2f} m from there.",
                zh=f"从 x = {start[0]:g}，y = {start[1]:g}，yaw = {start[2]:g} 出发 12 s 之后，机器人仍在行驶；"
                f"离出发点 {driven:.2f} m。",
            )
        if abs(driven - 1.0) > tolerance:
            raise NotYet(
                en=f"From x = {start[0]:g}, y = {start[1]:g}, the robot drove {driven:.3f} m instead of 1 m.",
                zh=f"从 x = {start[0]:g}，y = {start[1]:g} 出发，机器人走了 {driven:.3f} m，而不是 1 m。",
            )


@check(
    "meter", en="The robot stops after one meter, wherever it begins.", zh="无论从哪里出发，机器人都在一米之后停下。"
)
def drives_meter(work):
    expect_meter(work, 0.08)


@check("meter", en="It stops by /odom, not by the time.", zh="它依据 /odom 停下，而不是依据时间。")
def stops_by_odometry(work):
    """Publish the odometry of a robot that moves slower than it is told to."""
    odometry, early = get_message("nav_msgs/msg/Odometry"), 0.0
    with SteppedGraph() as test:
        commands = test.record("/cmd_vel", TWIST)
        test.start_program(work.package("my_control").program("drive_meter"), budget=BUDGET)
        for x in [0.005 * step for step in range(100)] + [1.2] * 10:
            message = odometry()
            message.pose.pose.position.x, message.pose.pose.orientation.w = x, 1.0
            test.publish("/odom", message)
            test.advance(0.1)
            if x < 0.49 and len(commands):
                early = commands.last.linear.x
        expect_published(test, "/cmd_vel", TWIST, commands)
        late = commands.last.linear.x
    if not early:
        raise NotYet(
            en="A robot with slipping wheels has driven 0.5 m by /odom, and the program stops it: compare the "
            "distance, not the time.",
            zh="轮子打滑的机器人按 /odom 只走了 0.5 m，程序就让它停下：请比较距离，而不是时间。",
        )
    if late > 0:
        raise NotYet(
            en="/odom says that the robot has driven 1.2 m, but the program drives on.",
            zh="/odom 表示机器人已经走了 1.2 m，但程序仍让它行驶。",
        )


@check("brake", en="It stops within 5 mm of one meter.", zh="它停在与一米处相差 5 mm 以内。")
def brakes(work):
    expect_meter(work, 0.005)


@check("brake", en="It drives at most at 0.3 m/s.", zh="速度不超过 0.3 m/s。")
def limits_speed(work):
    with Run(work, "drive_meter") as run:
        run.drive(2.0)
        fastest = max(command.linear.x for command in run.commands)
    if fastest > 0.31:
        raise NotYet(
            en=f"The program commands {fastest:.2f} m/s; min(0.3, remaining) limits the speed.",
            zh=f"程序发出的速度是 {fastest:.2f} m/s；用 min(0.3, remaining) 限制速度。",
        )


@cache
def drive_square(work):
    """Return the positions of the robot for a minute, and the last command."""
    with Run(work, "drive_square") as run:
        return run.drive(60.0), run.commands.last


def explain_end(positions, command):
    """Return where the robot is after a minute, and what it does there."""
    x, y = positions[-1]
    if math.dist(positions[-20], positions[-1]) < 0.01 and command.angular.z:
        en = (
            f"it turns on the spot at x = {x:.2f}, y = {y:.2f}: the error is math.atan2(dy, dx) minus the yaw, in "
            "radians, between -π and π, and a positive turn is to the left"
        )
        zh = (
            f"它在 x = {x:.2f}，y = {y:.2f} 处原地转动：误差是 math.atan2(dy, dx) 减去偏航角，"
            "单位是弧度，在 -π 和 π 之间；正的转速是左转"
        )
        return en, zh
    return f"it is at x = {x:.2f}, y = {y:.2f} then", f"这时它在 x = {x:.2f}，y = {y:.2f}"


@check("square", en="The robot passes the four corners in order.", zh="机器人依次经过四个角。")
def drives_square(work):
    corners = [(1, 0), (1, 1), (0, 1), (0, 0)]
    way, command = drive_square(work)
    positions = iter(way)
    for x, y in corners:
        if not any(math.dist(position, (x, y)) < 0.15 for position in positions):
            en, zh = explain_end(way, command)
            raise NotYet(
                en=f"The robot did not reach the corner ({x}, {y}) within 60 s; {en}.",
                zh=f"机器人在 60 s 内没有到达角 ({x}, {y})；{zh}。",
            )


@check("square", en="It stops where it began.", zh="它停在出发的地方。")
def ends_square(work):
    positions, _ = drive_square(work)
    if math.dist(positions[-20], positions[-1]) > 0.01 or math.dist(positions[-1], (0, 0)) > 0.15:
        x, y = positions[-1]
        raise NotYet(
            en=f"After 60 s the robot is at x = {x:.2f}, y = {y:.2f}, and should stand at 0, 0.",
            zh=f"60 s 之后机器人在 x = {x:.2f}，y = {y:.2f}，应当停在 0, 0。",
        )


@check("wall", en="The robot stops 0.3 to 0.7 m before a wall.", zh="机器人停在墙前 0.3 到 0.7 m 处。")
def stops_at_wall(work):
    for start in ((0.0, 0.0, 0.0), (0.0, 0.0, math.pi), BESIDE_WALL):
        with Run(work, "stop_at_wall", world=work.lesson / "room.world", start=start) as run:
            positions = run.drive(14.0)
        gap = 3.0 - abs(positions[-1][0])
        if math.dist(positions[-10], positions[-1]) > 0.01:
            raise NotYet(en="After 14 s the robot still drives.", zh="14 s 之后机器人仍在行驶。")
        if gap < BODY + 0.02:
            raise NotYet(en="The robot drove into the wall.", zh="机器人撞上了墙。")
        if math.dist(start[:2], positions[-1]) < 0.05:
            where = "beside a wall" if start is BESIDE_WALL else "3 m before a wall"
            zh_where = "墙的旁边" if start is BESIDE_WALL else "墙前 3 m 处"
            raise NotYet(
                en=f"The robot does not drive off {where}: look at the ranges within 0.5 rad of straight ahead alone, "
                "and drive if the smallest one is over 0.6 m.",
                zh=f"机器人在{zh_where}没有出发：只看正前方 0.5 rad 以内的距离，最小值大于 0.6 m 时行驶。",
            )
        if not 0.3 < gap < 0.75:
            raise NotYet(
                en=f"The robot stands {gap:.2f} m before the wall.",
                zh=f"机器人停在墙前 {gap:.2f} m 处。",
            )


def touches(position):
    """Return whether the body touches a wall, the box or the column of the room."""
    x, y = position
    dx, dy = max(abs(x - 1.5) - 0.4, 0), max(abs(y - 1.5) - 0.4, 0)
    return (
        max(abs(x), abs(y)) > 3.0 - BODY - 0.005
        or math.hypot(dx, dy) < BODY + 0.005
        or math.dist(position, (-1.2, -1.4)) < 0.3 + BODY + 0.005
    )


@cache
def wander(work, start):
    """Return the positions of the robot while the learner's program runs."""
    with Run(work, "wander", world=work.lesson / "room.world", start=start) as run:
        return run.drive(60.0)


@check("wander", en="The robot touches nothing for a minute.", zh="机器人一分钟内不碰到任何东西。")
def touches_nothing(work):
    for start in WANDER_STARTS:
        for index, position in enumerate(wander(work, start)):
            if touches(position):
                x, y = position
                raise NotYet(
                    en=f"After {index / 10:.0f} s the robot touches something at x = {x:.1f}, y = {y:.1f}.",
                    zh=f"{index / 10:.0f} s 之后，机器人在 x = {x:.1f}，y = {y:.1f} 处碰到了东西。",
                )


@check("wander", en="It drives at least 6 m in this time.", zh="在这段时间里至少走 6 m。")
def drives_far(work):
    positions = wander(work, WANDER_STARTS[0])
    way = sum(math.dist(*pair) for pair in pairwise(positions))
    if way < 6.0:
        raise NotYet(
            en=f"The robot drove only {way:.1f} m in a minute.",
            zh=f"机器人一分钟只走了 {way:.1f} m。",
        )


@check("drift", en="The error is right.", zh="误差正确。")
def knows_drift(work):
    slips = {
        0.05: NotYet(en="0.05 is 5 % of one meter; the robot drove 10 m.", zh="0.05 是一米的 5 %；机器人走了 10 m。"),
        10.5: NotYet(
            en="10.5 m is how far the robot really drove; the question is the difference.",
            zh="10.5 m 是机器人实际走的距离；问的是差值。",
        ),
    }
    work.expect_number(0.5, tolerance=0.03, slips=slips)
