import math
from functools import cache

import numpy as np

from linkwright import SteppedSimulation
from linkwright.learning import NotYet, check, expect_published
from linkwright.messages import get_message
from linkwright.testing import SteppedGraph

IMAGE, INFO, POINT = "sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo", "geometry_msgs/msg/PointStamped"
DETECTIONS = "vision_msgs/msg/Detection2DArray"
IMAGES = "/camera/image_raw"
WIDTH, HEIGHT = 320, 240
CAMERA = 0.17, 0.0, 0.21
BALL = 2.0, 0.3, 0.15
MARKERS = {7: (2.0, 0.4, 0.3), 23: (2.5, -0.7, 0.35)}
STARTS = ((0.0, 0.0, 0.0), (0.6, -0.3, 0.35), (3.2, 1.0, -2.6))

RED = {"red": (205, 25, 25), "crimson": (190, 15, 45), "dark red": (92, 12, 10), "light red": (255, 70, 66)}
OTHERS = {
    "white": (255, 255, 255),
    "gray": (128, 128, 128),
    "black": (8, 8, 8),
    "yellow": (230, 215, 40),
    "green": (30, 160, 40),
    "blue": (30, 50, 200),
}
CHINESE = {
    "red": "红色",
    "crimson": "绯红色",
    "dark red": "深红色",
    "light red": "浅红色",
    "white": "白色",
    "gray": "灰色",
    "black": "黑色",
    "yellow": "黄色",
    "green": "绿色",
    "blue": "蓝色",
}


def simulate(work, world="empty", start=(0.0, 0.0, 0.0)):
    x, y, yaw = start
    robot = work.package("my_robot_description").file("urdf/mbot_sim.xacro")
    return SteppedSimulation(world, robot, pose=(x, y, 0, 0, 0, yaw))


def program(work, name):
    return work.package("my_vision").program(name)


@cache
def camera_messages(work):
    """Return the messages of a second: the images, of which there is at least one, and the camera infos."""
    with simulate(work) as test:
        images, infos = test.record(IMAGES, IMAGE), test.record("/camera/camera_info", INFO)
        test.advance(1.0)
        others = [
            topic for topic, types in test.graph.get_topic_names_and_types() if IMAGE in types and topic != IMAGES
        ]
    if not len(images) and others:
        raise NotYet(
            en=f"Nothing is published on {IMAGES}, but on {others[0]}: compare <camera_name>.",
            zh=f"{IMAGES} 上没有消息，而 {others[0]} 上有：请检查 <camera_name>。",
        )
    if not len(images):
        raise NotYet(en=f"Nothing is published on {IMAGES}.", zh=f"{IMAGES} 上没有消息。")
    return images, infos


@check("camera", en="The camera publishes images of 320 x 240.", zh="相机发布 320 x 240 的图像。")
def publishes_images(work):
    images, _ = camera_messages(work)
    size = images.last.width, images.last.height
    if size != (WIDTH, HEIGHT):
        raise NotYet(
            en=f"The images are {size[0]} x {size[1]}, but should be 320 x 240.",
            zh=f"图像是 {size[0]} x {size[1]}，应当是 320 x 240。",
        )
    if images.last.encoding not in {"rgb8", "bgr8"}:
        raise NotYet(
            en=f"The images have the encoding {images.last.encoding}, which has no colors; write "
            "<format>R8G8B8</format>.",
            zh=f"图像的编码是 {images.last.encoding}，没有颜色；请写 <format>R8G8B8</format>。",
        )
    if not 8 <= len(images) <= 12:
        raise NotYet(
            en=f"{len(images)} images came in a second, but should be about 10.",
            zh=f"一秒内有 {len(images)} 张图像，应当约为 10 张。",
        )


@check("camera", en="Its horizontal field of view is 1.2 rad.", zh="它的水平视角是 1.2 rad。")
def has_field_of_view(work):
    _, infos = camera_messages(work)
    if not len(infos):
        raise NotYet(en="Nothing is published on /camera/camera_info.", zh="/camera/camera_info 上没有消息。")
    angle = 2 * math.atan(infos.last.width / 2 / infos.last.k[0])
    if abs(angle - 1.2) > 0.02:
        raise NotYet(
            en=f"The field of view is {angle:.3g} rad, but should be 1.2 rad.",
            zh=f"视角是 {angle:.3g} rad，应当是 1.2 rad。",
        )


@check(
    "camera",
    en="The images are in the frame camera_optical_frame, whose z axis points forward.",
    zh="图像在坐标系 camera_optical_frame 中，其 z 轴指向前方。",
)
def has_optical_frame(work):
    images, _ = camera_messages(work)
    frame = images.last.header.frame_id
    if frame != "camera_optical_frame":
        raise NotYet(
            en=f"The frame of the images is '{frame}', but should be 'camera_optical_frame'.",
            zh=f"图像的坐标系是“{frame}”，应当是“camera_optical_frame”。",
        )
    robot = work.package("my_robot_description").robot("urdf/mbot_sim.xacro")
    robot.expect_position("camera_optical_frame", (0, 0, 0), frame="camera_link")
    rotation = robot.pose("camera_optical_frame", "camera_link")[:3, :3]
    if not np.allclose(rotation, [(0, 0, 1), (-1, 0, 0), (0, -1, 0)], atol=0.02):
        x_axis, z_axis = (" ".join(f"{round(float(value), 2) + 0.0:g}" for value in rotation[:, i]) for i in (0, 2))
        raise NotYet(
            en=f"In camera_link, the z axis of camera_optical_frame points along {z_axis}, and x along {x_axis}; "
            "z must point forward, 1 0 0, and x to the right, 0 -1 0: check the rpy of camera_optical_joint.",
            zh=f"在 camera_link 中，camera_optical_frame 的 z 轴指向 {z_axis}，x 轴指向 {x_axis}；"
            "z 应当指向前方 1 0 0，x 应当指向右方 0 -1 0：请检查 camera_optical_joint 的 rpy。",
        )


def drawn_image(colors, encoding):
    """Return an image with a square of each color on a gray ground, and the places of the squares by name."""
    pixels = np.full((HEIGHT, WIDTH, 3), 110, np.uint8)
    places = {}
    for index, (name, rgb) in enumerate(colors.items()):
        row, column = 20 + 60 * (index // 4), 20 + 75 * (index % 4)
        pixels[row : row + 40, column : column + 40] = rgb
        places[name] = slice(row + 4, row + 36), slice(column + 4, column + 36)
    image = get_message(IMAGE)(height=HEIGHT, width=WIDTH, encoding=encoding, step=3 * WIDTH)
    image.data = (pixels if encoding == "rgb8" else pixels[:, :, ::-1]).tobytes()
    image.header.frame_id = "camera_optical_frame"
    image.header.stamp.sec, image.header.stamp.nanosec = 12, 500_000_000
    return image, places


@cache
def mask_of(work, encoding="rgb8"):
    """Show an image to the learner's node, and return its mask and the places of the colors."""
    image, places = drawn_image({**RED, **OTHERS}, encoding)
    with SteppedGraph() as test:
        masks = test.record("/red_mask", IMAGE)
        test.start_program(program(work, "red_mask"))
        test.advance(0.2)
        test.publish(IMAGES, image)
        test.advance(0.2)
        expect_published(test, "/red_mask", IMAGE, masks)
    mask = masks.last
    if (mask.width, mask.height) != (WIDTH, HEIGHT) or mask.encoding not in {"mono8", "8UC1"}:
        raise NotYet(
            en=f"The mask is {mask.width} x {mask.height} in '{mask.encoding}', but should be 320 x 240 in 'mono8'.",
            zh=f"掩膜是 {mask.width} x {mask.height}，编码“{mask.encoding}”，应当是 320 x 240，编码“mono8”。",
        )
    pixels = np.frombuffer(bytes(mask.data), np.uint8).reshape(mask.height, mask.step)[:, : mask.width]
    return mask, {name: float((pixels[place] > 0).mean()) for name, place in places.items()}


@check("red", en="The mask contains what is red, dark or light.", zh="掩膜包含红色的部分，无论深浅。")
def mask_has_red(work):
    _, shares = mask_of(work)
    for name, color in RED.items():
        if shares["red"] < 0.1 and shares["blue"] > 0.9:
            raise NotYet(
                en="The mask contains blue in place of red: the channels are exchanged; use 'bgr8' with COLOR_BGR2HSV.",
                zh="掩膜包含的是蓝色而不是红色：通道顺序反了；“bgr8”要与 COLOR_BGR2HSV 一起使用。",
            )
        if shares[name] < 0.9:
            raise NotYet(en=f"The mask lacks {name}, rgb {color}.", zh=f"掩膜中缺少{CHINESE[name]}，rgb {color}。")


@check("red", en="It contains no other color.", zh="掩膜不包含其他颜色。")
def mask_has_nothing_else(work):
    _, shares = mask_of(work)
    for name, color in OTHERS.items():
        if shares[name] > 0.1:
            raise NotYet(
                en=f"The mask contains {name}, rgb {color}.",
                zh=f"掩膜包含{CHINESE[name]}，rgb {color}。",
            )


@check("red", en="Images in bgr8 give the same mask.", zh="bgr8 编码的图像得到同样的掩膜。")
def mask_obeys_encoding(work):
    _, shares = mask_of(work, "bgr8")
    if shares["red"] < 0.9 or shares["blue"] > 0.1:
        raise NotYet(
            en="In an image with the encoding bgr8, the mask has other colors than in one with rgb8; "
            "let CvBridge convert to one of them.",
            zh="对于编码为 bgr8 的图像，掩膜中的颜色与 rgb8 的不同；请让 CvBridge 转换成其中一种。",
        )


@check("red", en="The mask has the header of its image.", zh="掩膜带有原图像的 header。")
def mask_has_header(work):
    mask, _ = mask_of(work)
    if mask.header.frame_id != "camera_optical_frame" or mask.header.stamp.sec != 12:
        raise NotYet(
            en="The mask has another stamp or frame than its image; copy the header.",
            zh="掩膜的时间戳或坐标系与原图像不同；请复制 header。",
        )


@check("lens", en="The number of pixels is right.", zh="像素数正确。")
def knows_size(work):
    slips = {
        17.5: NotYet(en="17.5 belongs to the radius; the ball is 0.3 m wide.", zh="17.5 是半径的；球宽 0.3 m。"),
        48.0: NotYet(
            en="48 uses the width of the image; the focal length is the first number of k.",
            zh="48 用的是图像的宽度；焦距是 k 的第一个数。",
        ),
        24.1: NotYet(
            en="24 uses the middle of the image; the focal length is the first number of k.",
            zh="24 用的是图像的中心；焦距是 k 的第一个数。",
        ),
    }
    work.expect_number(35.1, tolerance=1.0, slips=slips)


def seen_from(start, point):
    """Return a point of the world as seen from camera_link of a robot: forward, left, up."""
    x, y, yaw = start
    dx, dy = point[0] - x, point[1] - y
    forward = math.cos(yaw) * dx + math.sin(yaw) * dy
    left = -math.sin(yaw) * dx + math.cos(yaw) * dy
    return forward - CAMERA[0], left - CAMERA[1], point[2] - CAMERA[2]


@cache
def find_ball(work, start, *, must_see=True):
    with simulate(work, work.lesson / "ball.world", start) as test:
        balls = test.record("/ball", POINT)
        test.start_program(program(work, "ball_finder"), ["--ros-args", "-p", "use_sim_time:=true"])
        test.advance(0.8)
        if must_see:
            expect_published(test, "/ball", POINT, balls)
    return balls


def meters(point):
    return " ".join(f"{value:.2f}" for value in point)


@check("ball", en="ball_finder publishes in the frame camera_link.", zh="ball_finder 在坐标系 camera_link 中发布。")
def ball_has_frame(work):
    balls = find_ball(work, STARTS[0])
    header = balls.last.header
    if header.frame_id != "camera_link":
        raise NotYet(
            en=f"The frame of /ball is '{header.frame_id}', but should be 'camera_link'.",
            zh=f"/ball 的坐标系是“{header.frame_id}”，应当是“camera_link”。",
        )
    if not header.stamp.sec and not header.stamp.nanosec:
        raise NotYet(
            en="The stamp of /ball is zero; copy that of the image.", zh="/ball 的时间戳是零；请复制图像的时间戳。"
        )


@check("ball", en="It says where the ball is, from three places.", zh="从三个位置看，它都能说出球在哪里。")
def ball_is_right(work):
    for start in STARTS:
        balls = find_ball(work, start)
        expected = seen_from(start, BALL)
        point = balls.last.point
        actual = point.x, point.y, point.z
        if math.dist(actual, expected) > 0.08 + 0.05 * expected[0] or abs(point.z - expected[2]) > 0.06:
            raise NotYet(
                en=f"/ball says {meters(actual)}, but the ball is at {meters(expected)} in camera_link "
                "(forward, left, up).",
                zh=f"/ball 是 {meters(actual)}，而球在 camera_link 中位于 {meters(expected)}（前、左、上）。",
            )


@check("ball", en="Without a ball it publishes nothing.", zh="没有球时不发布。")
def ball_is_absent(work):
    if len(find_ball(work, (0.0, 0.0, math.pi), must_see=False)):
        raise NotYet(
            en="The camera looks away from the ball, but /ball has messages.",
            zh="相机没有朝向球，但 /ball 上有消息。",
        )


@cache
def find_markers(work, start):
    """Return the last transform of each marker that the learner's node broadcasts."""
    world = work.package("my_worlds").file("worlds/markers.world")
    with simulate(work, world, start) as test:
        transforms = test.record("/tf", "tf2_msgs/msg/TFMessage")
        test.start_program(program(work, "marker_finder"), ["--ros-args", "-p", "use_sim_time:=true"])
        test.advance(0.8)
    return {
        each.child_frame_id: each
        for message in transforms
        for each in message.transforms
        if each.child_frame_id.startswith("marker")
    }


@check(
    "markers",
    en="tf has marker_7 and marker_23 in the camera's frame.",
    zh="tf 中有相机坐标系下的 marker_7 和 marker_23。",
)
def markers_have_frames(work):
    found = find_markers(work, STARTS[0])
    for number in MARKERS:
        name = f"marker_{number}"
        if name not in found:
            names = ", ".join(sorted(found))
            raise NotYet(
                en=f"The camera sees marker {number}, but tf has no '{name}'"
                + (f"; it has {names}." if names else "."),
                zh=f"相机看见标记 {number}，但 tf 中没有“{name}”" + (f"；有 {names}。" if names else "。"),
            )
        frame = found[name].header.frame_id
        if frame != "camera_optical_frame":
            raise NotYet(
                en=f"'{name}' is a child of '{frame}', but should be one of 'camera_optical_frame'.",
                zh=f"“{name}”的父坐标系是“{frame}”，应当是“camera_optical_frame”。",
            )


@check("markers", en="They are where the markers are.", zh="它们的位置与标记一致。")
def markers_are_right(work):
    for start in STARTS[:2]:
        found = find_markers(work, start)
        for number, place in MARKERS.items():
            forward, left, up = seen_from(start, place)
            expected = -left, -up, forward
            transform = found.get(f"marker_{number}")
            if transform is None:
                if abs(left) > 0.5 * forward:
                    continue  # near the edge of the image
                raise NotYet(
                    en=f"Marker {number} is {forward:.2f} m ahead, but tf has no 'marker_{number}'.",
                    zh=f"标记 {number} 在前方 {forward:.2f} m，但 tf 中没有“marker_{number}”。",
                )
            position = transform.transform.translation
            actual = position.x, position.y, position.z
            if math.dist(actual, expected) > 0.05 + 0.05 * forward:
                raise NotYet(
                    en=f"'marker_{number}' is at {meters(actual)} in camera_optical_frame, "
                    f"but should be at {meters(expected)}.",
                    zh=f"“marker_{number}”在 camera_optical_frame 中位于 {meters(actual)}，应当是 {meters(expected)}。",
                )


@check("markers", en="Their z axes point out of the markers.", zh="它们的 z 轴从标记向外。")
def markers_face_camera(work):
    for name, transform in find_markers(work, STARTS[0]).items():
        q = transform.transform.rotation
        toward_camera = -(1 - 2 * (q.x * q.x + q.y * q.y))
        if toward_camera < 0.9:
            raise NotYet(
                en=f"The z axis of '{name}' does not point toward the camera; "
                f"its rotation is {q.x:.2f} {q.y:.2f} {q.z:.2f} {q.w:.2f}.",
                zh=f"“{name}”的 z 轴没有指向相机；它的旋转是 {q.x:.2f} {q.y:.2f} {q.z:.2f} {q.w:.2f}。",
            )


def read_balls(work):
    """Return the names and the labeled images of the learner's data set."""
    from linkwright.vision.training.yolo_dataset import open_dataset

    if not (work.folder / "balls").is_dir():
        raise NotYet(en="The workspace has no folder 'balls'.", zh="工作空间中没有文件夹“balls”。")
    dataset = open_dataset(work.folder / "balls")
    if "test" not in dataset.splits:
        raise NotYet(
            en=f"The data set has no split 'test'; it has {', '.join(sorted(dataset.splits))}.",
            zh=f"数据集没有“test”部分；有 {', '.join(sorted(dataset.splits))}。",
        )
    return dataset.names, dataset.read("test")


@check(
    "dataset",
    en="The folder balls has at least 20 images with labels of balls.",
    zh="文件夹 balls 中至少有 20 张标注了球的图像。",
)
def has_dataset(work):
    names, images = read_balls(work)
    if "ball" not in names:
        raise NotYet(
            en=f"The classes of the data set are {', '.join(names)}; 'ball' is missing.",
            zh=f"数据集的类别是 {', '.join(names)}；缺少“ball”。",
        )
    if len(images) < 20:
        raise NotYet(
            en=f"The data set has {len(images)} test images, but should have at least 20.",
            zh=f"数据集有 {len(images)} 张测试图像，应当至少有 20 张。",
        )
    balls = sum(int((image.classes == names.index("ball")).sum()) for image in images)
    if not balls:
        raise NotYet(en="No image has the label of a ball.", zh="没有一张图像标注了球。")


@check("dataset", en="The recall of the detector is right.", zh="检测器的召回率正确。")
def knows_recall(work):
    from linkwright.vision.training.detector_evaluation import evaluate_detector

    names, images = read_balls(work)
    work.number()
    results = next(result for result in evaluate_detector("things", names, images).classes if result.name == "ball")
    slips = {
        results.ap50: NotYet(
            en="This is mAP50; the recall is in the last column.", zh="这是 mAP50；召回率在最后一列。"
        ),
        results.precision: NotYet(
            en="This is the precision: how many of the found boxes are balls.",
            zh="这是精确率：找到的方框中有多少是球。",
        ),
        100 * results.recall: NotYet(en="Write the share, not percent.", zh="请写小数，而不是百分数。"),
    }
    slips = {value: message for value, message in slips.items() if value is not None}
    work.expect_number(results.recall, tolerance=0.015, slips=slips)


def detection(name, column, width):
    message = get_message("vision_msgs/msg/Detection2D")()
    result = get_message("vision_msgs/msg/ObjectHypothesisWithPose")()
    result.hypothesis.class_id, result.hypothesis.score = name, 0.9
    message.results = [result]
    message.bbox.center.position.x, message.bbox.center.position.y = float(column), 130.0
    message.bbox.size_x = message.bbox.size_y = float(width)
    return message


def turn_for(work, *detections):
    """Show detections to the learner's node, and return the turn rate that it publishes."""
    with SteppedGraph() as test:
        commands = test.record("/cmd_vel", "geometry_msgs/msg/Twist")
        test.start_program(program(work, "watch_ball"))
        test.advance(0.2)
        for _ in range(5):
            test.publish(
                "/yolo/detections", get_message("vision_msgs/msg/Detection2DArray")(detections=list(detections))
            )
            test.advance(0.1)
        expect_published(test, "/cmd_vel", "geometry_msgs/msg/Twist", commands)
        running = list(commands)
    return running[-1].angular.z


def expect_turn(work, wanted, en, zh, *detections):
    """Require a turn to the left (1), to the right (-1) or none (0)."""
    actual = turn_for(work, *detections)
    sign = 0 if abs(actual) < 0.05 else math.copysign(1, actual)
    if sign != wanted:
        raise NotYet(en=f"{en}, angular.z is {actual:.2f}.", zh=f"{zh}，angular.z 是 {actual:.2f}。")


@check("detector", en="watch_ball turns toward the ball.", zh="watch_ball 转向球。")
def watches_ball(work):
    ball = "ball"
    expect_turn(work, 1, "With a ball at the left edge", "球在图像左边时", detection(ball, 40, 50))
    expect_turn(work, -1, "With a ball at the right edge", "球在图像右边时", detection(ball, 280, 50))
    expect_turn(work, 0, "With a ball in the middle", "球在图像中间时", detection(ball, 160, 50))


@check(
    "detector",
    en="It ignores other things, and the smaller of two balls.",
    zh="它忽略其他物体，也忽略两个球中较小的一个。",
)
def ignores_others(work):
    expect_turn(work, 0, "Without a detection", "没有检测结果时")
    expect_turn(work, 0, "With a cone at the left edge and no ball", "左边有锥桶而没有球时", detection("cone", 40, 50))
    both = detection("ball", 280, 20), detection("ball", 40, 60), detection("ball", 270, 25)
    expect_turn(work, 1, "With a near ball on the left and far ones on the right", "左边有近球、右边有远球时", *both)


@check(
    "detector",
    en="The launch file starts mbot, the detector and watch_ball.",
    zh="launch 文件启动 mbot、检测器和 watch_ball。",
)
def launches(work):
    def has_ball(message):
        return any(each.results[0].hypothesis.class_id == "ball" for each in message.detections)

    with work.package("my_vision").launch("seeing.launch.py") as running:
        running.expect_node("/watch_ball")
        running.wait_for_message("/yolo/detections", has_ball)
        running.wait_for_message("/cmd_vel")


@check(
    "detector",
    en="setup.py installs it, and package.xml lists what it needs.",
    zh="setup.py 安装了它，package.xml 列出了所需的功能包。",
)
def lists_dependencies(work):
    package = work.package("my_vision")
    package.expect_installed("launch/seeing.launch.py")
    package.expect_dependencies("my_robot_vision", "my_worlds", "launch_ros")
    package.expect_no_findings()
