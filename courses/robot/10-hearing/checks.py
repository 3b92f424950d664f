import ast
import math

import numpy as np

from linkwright.learning import NotYet, check, expect_published
from linkwright.messages import get_message
from linkwright.testing import SteppedGraph

TWIST, STRING = "geometry_msgs/msg/Twist", "std_msgs/msg/String"
String = get_message(STRING)
TEXTS = "/voice/text"
FORWARD, BACK, LEFT, RIGHT, STOP = (0.2, 0.0), (-0.2, 0.0), (0.0, 0.5), (0.0, -0.5), (0.0, 0.0)
ENGLISH = {"forward": FORWARD, "Go back!": BACK, "Turn LEFT, please": LEFT, "turn right": RIGHT, "Stop.": STOP}
CHINESE = {"前进": FORWARD, "后退一点": BACK, "请左转": LEFT, "右转。": RIGHT, "停下来": STOP}
PLACES = {
    "go to the kitchen": (2.8, -2.6, -1.57),
    "Go home!": (0.0, 0.0, 0.0),
    "drive to the bedroom": (-1.9, 1.6, 1.57),
    "去厨房": (2.8, -2.6, -1.57),
    "回家": (0.0, 0.0, 0.0),
    "请到卧室去": (-1.9, 1.6, 1.57),
}


class Listening:
    """A learner's node in a graph, to which the check says texts."""

    def __init__(self, work, name, topic, type_name, *parameters):
        self.name, self.topic = name, topic
        self.main = work.package("my_voice").program(name)
        self.arguments = ["--ros-args", *(word for value in parameters for word in ("-p", value))]
        self.test = SteppedGraph()
        self.type_name = type_name
        self.said = ""

    def __enter__(self):
        self.test.__enter__()
        self.recording = self.test.record(self.topic, self.type_name)
        self.test.start_program(self.main, self.arguments)
        self.test.advance(0.5)
        return self

    def __exit__(self, *error):
        return self.test.__exit__(*error)

    def say(self, text, seconds=0.3):
        self.said = text
        self.test.publish(TEXTS, String(data=text))
        self.test.advance(seconds)

    @property
    def velocity(self):
        """The last speed and turn rate."""
        try:
            expect_published(self.test, self.topic, self.type_name, self.recording)
        except NotYet as reason:
            raise NotYet(
                en=f"After '{self.said}' on {TEXTS}, {reason.text.get('en')}",
                zh=f"在 {TEXTS} 上收到“{self.said}”之后，{reason.text.get('zh')}",
            ) from None
        return self.recording.last.linear.x, self.recording.last.angular.z


def drive(work, *parameters):
    return Listening(work, "word_driver", "/cmd_vel", TWIST, *parameters)


def is_near(actual, expected):
    return math.dist(actual, expected) < 0.001


def expect_plain_commands(work):
    """Require the dictionary of the lesson to have each velocity once, and tuples of words."""
    source = (work.package("my_voice").folder / "my_voice/word_driver.py").read_text(encoding="utf-8")
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Dict) or not all(isinstance(key, ast.Tuple) for key in node.keys):
            continue
        keys = [ast.unparse(key) for key in node.keys]
        if repeated := next((key for key in keys if keys.count(key) > 1), None):
            raise NotYet(
                en=f"The dictionary has {repeated} twice, so the last one counts; compare the signs.",
                zh=f"字典中 {repeated} 出现了两次，只有最后一次有效；请检查正负号。",
            )
        for value in node.values:
            if isinstance(value, ast.Constant) and isinstance(value.value, str):
                raise NotYet(
                    en=f"The words ('{value.value}') need a comma: ('{value.value}',) is a tuple.",
                    zh=f"('{value.value}') 少了逗号：('{value.value}',) 才是元组。",
                )


def expect_velocities(work, texts):
    with drive(work) as robot:
        for text, expected in texts.items():
            robot.say(text)
            speed, turn = robot.velocity
            if not is_near((speed, turn), expected):
                raise NotYet(
                    en=f"After '{text}', linear.x is {speed:g} and angular.z is {turn:g}, "
                    f"but should be {expected[0]:g} and {expected[1]:g}.",
                    zh=f"听到“{text}”之后，linear.x 是 {speed:g}，angular.z 是 {turn:g}，"
                    f"应当是 {expected[0]:g} 和 {expected[1]:g}。",
                )


@check("words", en="word_driver obeys English texts.", zh="word_driver 服从英文文本。")
def obeys_english(work):
    work.package("my_voice").program("word_driver")
    expect_plain_commands(work)
    expect_velocities(work, ENGLISH)


@check("words", en="It obeys Chinese texts.", zh="它服从中文文本。")
def obeys_chinese(work):
    expect_velocities(work, CHINESE)


@check("words", en="Stop wins, whatever else is said.", zh="无论还说了什么，停总是优先。")
def stop_wins(work):
    with drive(work) as robot:
        for text in ("stop, do not go forward", "别前进了，停！"):
            robot.say("forward")
            robot.say(text)
            if not is_near(robot.velocity, STOP):
                raise NotYet(
                    en=f"After '{text}', the robot still drives at {robot.velocity[0]:g} m/s.",
                    zh=f"听到“{text}”之后，机器人仍以 {robot.velocity[0]:g} m/s 行驶。",
                )


@check("words", en="Other words change nothing.", zh="其他的话不改变任何东西。")
def ignores_others(work):
    with drive(work) as robot:
        robot.say("turn left")
        for text in ("what a nice day", "今天天气真好", ""):
            robot.say(text)
            if not is_near(robot.velocity, LEFT):
                speed, turn = robot.velocity
                raise NotYet(
                    en=f"'{text}' is no command, but changed the velocity to {speed:g} and {turn:g}.",
                    zh=f"“{text}”不是命令，却把速度改成了 {speed:g} 和 {turn:g}。",
                )


def velocity_after(work, texts, *parameters):
    """Say texts, each with the seconds that pass after it, and return the last velocity."""
    with drive(work, *parameters) as robot:
        for text, seconds in texts:
            robot.say(text, seconds)
        return robot.velocity


@check("silence", en="After three seconds without a command, the robot stops.", zh="三秒没有命令，机器人就停下。")
def stops_in_silence(work):
    if not is_near(velocity_after(work, [("forward", 2.5)]), FORWARD):
        raise NotYet(
            en="2.5 s after 'forward' the robot does not drive any more.", zh="“forward”之后 2.5 s，机器人已不再行驶。"
        )
    if not is_near(velocity_after(work, [("forward", 3.5)]), STOP):
        raise NotYet(en="3.5 s after 'forward' the robot still drives.", zh="“forward”之后 3.5 s，机器人仍在行驶。")


@check("silence", en="Each command begins the time anew.", zh="每条命令都重新计时。")
def renews_time(work):
    if not is_near(velocity_after(work, [("forward", 2.0), ("turn left", 2.0)]), LEFT):
        raise NotYet(
            en="2 s after a second command the robot does not obey it any more.",
            zh="第二条命令之后 2 s，机器人已不再执行它。",
        )
    if not is_near(velocity_after(work, [("forward", 2.0), ("what a nice day", 2.0)]), STOP):
        raise NotYet(
            en="'what a nice day' is no command, but keeps the robot driving.",
            zh="“what a nice day”不是命令，却让机器人继续行驶。",
        )


@check("silence", en="With timeout:=1.0 it stops sooner.", zh="timeout:=1.0 时更早停下。")
def obeys_timeout(work):
    if not is_near(velocity_after(work, [("forward", 1.5)], "timeout:=1.0"), STOP):
        raise NotYet(
            en="With timeout:=1.0, the robot still drives 1.5 s after 'forward'.",
            zh="timeout:=1.0 时，“forward”之后 1.5 s，机器人仍在行驶。",
        )


def levels_of(work, *blocks):
    """Return the levels that the learner's node publishes for blocks of samples."""
    message_type = get_message("audio_common_msgs/msg/AudioDataStamped")
    with Listening(work, "level_meter", "/level", "std_msgs/msg/Float32") as meter:
        for block in blocks:
            message = message_type()
            message.audio.data = np.asarray(block, "<i2").tobytes()
            meter.test.publish("/audio/audio_stamped", message)
            meter.test.advance(0.1)
        if len(meter.recording) < len(blocks):
            raise NotYet(
                en=f"After {len(blocks)} messages on /audio/audio_stamped, {len(meter.recording)} came on /level.",
                zh=f"在 /audio/audio_stamped 上发布 {len(blocks)} 条消息之后，/level 上有 {len(meter.recording)} 条。",
            )
        return [message.data for message in meter.recording]


@check(
    "sound", en="level_meter publishes the level of a tone on /level.", zh="level_meter 在 /level 上发布音调的电平。"
)
def measures_level(work):
    times = np.arange(1600) / 16000
    for height in (0.9, 0.05):
        expected = height / math.sqrt(2)
        level = levels_of(work, np.round(32767 * height * np.sin(2 * math.pi * 440 * times)))[-1]
        if not abs(level - expected) < 0.02 * expected:
            raise NotYet(
                en=f"A tone whose samples reach {height:g} of the greatest value has the level {expected:.3f}, "
                f"but /level says {level:.3g}.",
                zh=f"采样值达到最大值 {height:g} 倍的音调，电平是 {expected:.3f}，但 /level 是 {level:.3g}。",
            )


@check("sound", en="Silence has the level zero.", zh="静音的电平是零。")
def silence_is_zero(work):
    level = levels_of(work, np.zeros(1600))[-1]
    if not abs(level) < 0.001:
        raise NotYet(en=f"Silence has the level {level:.3g}.", zh=f"静音的电平是 {level:.3g}。")


@check("sound", en="The beginning of the second word is right.", zh="第二个词的起点正确。")
def knows_beginning(work):
    slips = {
        1.2: NotYet(en="1.2 s is the beginning of the first word.", zh="1.2 s 是第一个词的起点。"),
        4.4: NotYet(en="4.4 s is the beginning of the third word.", zh="4.4 s 是第三个词的起点。"),
        1.7: NotYet(
            en="1.7 s is the time between the first word and the second; count from the beginning.",
            zh="1.7 s 是第一个词与第二个词之间的时间；请从开头数起。",
        ),
    }
    work.expect_number(2.9, tolerance=0.15, slips=slips)


def goal_for(work, text, *, must_send=False):
    """Return the last goal after a text, or None."""
    with Listening(work, "goal_sender", "/goal_pose", "geometry_msgs/msg/PoseStamped") as sender:
        sender.say(text)
        if must_send:
            expect_published(sender.test, sender.topic, sender.type_name, sender.recording)
        return sender.recording.last if len(sender.recording) else None


def expect_goal(work, text):
    return goal_for(work, text, must_send=True)


@check("goals", en="goal_sender sends goals in the frame map.", zh="goal_sender 发送坐标系 map 中的目标。")
def goal_is_right(work):
    for text, (x, y, _) in PLACES.items():
        goal = expect_goal(work, text)
        if goal.header.frame_id != "map":
            raise NotYet(
                en=f"The frame of the goal is '{goal.header.frame_id}', but should be 'map'.",
                zh=f"目标的坐标系是“{goal.header.frame_id}”，应当是“map”。",
            )
        position = goal.pose.position
        if math.dist((position.x, position.y), (x, y)) > 0.05:
            raise NotYet(
                en=f"'{text}' sends the robot to {position.x:g} {position.y:g}, but should to {x:g} {y:g}.",
                zh=f"“{text}”把机器人派到 {position.x:g} {position.y:g}，应当是 {x:g} {y:g}。",
            )


@check("goals", en="Their quaternions are right.", zh="它们的四元数正确。")
def goal_has_quaternion(work):
    for text, (_, _, yaw) in PLACES.items():
        q = expect_goal(work, text).pose.orientation
        length = math.sqrt(q.x**2 + q.y**2 + q.z**2 + q.w**2)
        if abs(length - 1) > 0.02:
            raise NotYet(
                en=f"The quaternion {q.x:g} {q.y:g} {q.z:g} {q.w:g} for '{text}' has the length {length:.2f}, not 1.",
                zh=f"“{text}”的四元数 {q.x:g} {q.y:g} {q.z:g} {q.w:g} 长度是 {length:.2f}，而不是 1。",
            )
        actual = 2 * math.atan2(q.z, q.w)
        if abs(math.remainder(actual - yaw, math.tau)) > 0.05:
            raise NotYet(
                en=f"The goal for '{text}' has the yaw {actual:.2f}, but should have {yaw:g}.",
                zh=f"“{text}”的目标偏航角是 {actual:.2f}，应当是 {yaw:g}。",
            )


@check("goals", en="Other texts send nothing.", zh="其他文本不发送目标。")
def goal_needs_place(work):
    for text in ("go to the moon", "前进"):
        if goal_for(work, text) is not None:
            raise NotYet(en=f"'{text}' sends a goal.", zh=f"“{text}”发送了目标。")


def understand(work, text):
    """Return the action for a text in the learner's file of commands, and its values; None if there is none."""
    from linkwright.speech.commands.command_file import read_command_file

    match = read_command_file(work.package("my_voice").file("config/commands.yaml")).match_command(text)
    return None if match is None else (match.command.action, match.values)


def expect_action(work, text):
    found = understand(work, text)
    if found is None and "，" in work.package("my_voice").file("config/commands.yaml").read_text(encoding="utf-8"):
        raise NotYet(
            en=f"'{text}' is not understood; commands.yaml has a full-width comma: write ', ' between the sentences.",
            zh=f"听不懂“{text}”；commands.yaml 中有全角逗号：句子之间请用英文逗号“, ”。",
        )
    if found is None:
        raise NotYet(en=f"'{text}' is not understood.", zh=f"听不懂“{text}”。")
    return found


@check("grammar", en="Both languages drive and turn by numbers.", zh="两种语言都能按数字行驶和转弯。")
def drives_by_numbers(work):
    from linkwright.speech.commands.actions import Drive, resolve_amount

    for text, wanted in {
        "forward": (1, 0, None, None),
        "前进": (1, 0, None, None),
        "turn left": (0, 1, None, None),
        "左转": (0, 1, None, None),
        "turn right": (0, -1, None, None),
        "右转": (0, -1, None, None),
        "go forward half a meter": (1, 0, 0.5, None),
        "前进一米半": (1, 0, 1.5, None),
        "turn left ninety degrees": (0, 1, None, math.pi / 2),
        "左转九十度": (0, 1, None, math.pi / 2),
        "turn right 45 degrees": (0, -1, None, math.pi / 4),
        "右转四十五度": (0, -1, None, math.pi / 4),
    }.items():
        action, values = expect_action(work, text)
        if not isinstance(action, Drive):
            raise NotYet(en=f"'{text}' does not drive.", zh=f"“{text}”不是行驶命令。")
        signs = [int(math.copysign(1, value)) if value else 0 for value in (action.x, action.turn)]
        if signs != list(wanted[:2]):
            raise NotYet(
                en=f"'{text}' drives with x = {action.x:g} and turn = {action.turn:g}, "
                f"but should with {wanted[0]} and {wanted[1]}.",
                zh=f"“{text}”以 x = {action.x:g}，turn = {action.turn:g} 行驶，应当是 {wanted[0]} 和 {wanted[1]}。",
            )
        amounts = [resolve_amount(value, values) for value in (action.distance, action.angle)]
        for name, actual, expected in zip(("distance", "angle"), amounts, wanted[2:], strict=True):
            if (actual is None) != (expected is None) or (actual is not None and abs(actual - expected) > 0.01):
                raise NotYet(
                    en=f"'{text}' has the {name} {actual}, but should have {expected}.",
                    zh=f"“{text}”的 {name} 是 {actual}，应当是 {expected}。",
                )


@check("grammar", en="'stop' and 停 stop the robot.", zh="stop 和“停”让机器人停下。")
def stops_by_words(work):
    from linkwright.speech.commands.actions import Stop

    for text in ("stop", "停"):
        if not isinstance(expect_action(work, text)[0], Stop):
            raise NotYet(en=f"'{text}' does not stop the robot.", zh=f"“{text}”不会让机器人停下。")


@check("grammar", en="Balls are published on /target by their colors.", zh="球的颜色发布在 /target 上。")
def names_balls(work):
    from linkwright.speech.commands.actions import Publish, fill_template

    for text, color in {
        "go to the red ball": "red",
        "go to the blue ball": "blue",
        "去红球那里": "red",
        "去绿色的球": "green",
        "去蓝色的球那里": "blue",
    }.items():
        action, values = expect_action(work, text)
        if not isinstance(action, Publish) or action.topic not in {"/target", "target"}:
            raise NotYet(en=f"'{text}' publishes nothing on /target.", zh=f"“{text}”没有在 /target 上发布消息。")
        data = fill_template(action.message, values).get("data")
        if data != color:
            raise NotYet(
                en=f"'{text}' publishes '{data}', but should '{color}'.",
                zh=f"“{text}”发布“{data}”，应当是“{color}”。",
            )


@check("grammar", en="setup.py installs the file.", zh="setup.py 安装了这个文件。")
def installs_commands(work):
    work.package("my_voice").expect_installed("config/commands.yaml")


@check("listen", en="The launch file recognizes the words of the recording.", zh="launch 文件识别出录音中的词。")
def recognizes_recording(work):
    sounds = work.lesson / "start" / "sounds"
    arguments = {"words": str(sounds / "words.json"), "wav": str(sounds / "commands.wav")}
    with work.package("my_voice").launch("hearing.launch.py", **arguments) as running:
        running.expect_node("/goal_sender")
        running.wait_for_message(TEXTS, lambda message: message.data == "forward")
        running.wait_for_message("/cmd_vel", lambda message: message.angular.z > 0)


@check(
    "listen",
    en="setup.py installs it, and package.xml lists what it needs.",
    zh="setup.py 安装了它，package.xml 列出了所需的功能包。",
)
def lists_dependencies(work):
    package = work.package("my_voice")
    package.expect_installed("launch/hearing.launch.py")
    package.expect_dependencies("my_robot_voice", "my_worlds", "launch_ros")
    package.expect_no_findings()
