"""The nodes of v4l2_camera and usb_cam, with a video file and a device that a class replaces."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_message, get_service
from linkwright.nodes import NodeOptions
from linkwright.vision.cameras import video
from linkwright.vision.cameras.calibration import locate_calibration, read_calibration
from linkwright.vision.nodes.video_cameras import UsbCam, V4L2Camera, create_image
from tests.waiting import eventually

pytestmark = pytest.mark.extra("vision")

WIDTH, HEIGHT = 64, 48
IMAGE, INFO = get_message("sensor_msgs/msg/Image"), get_message("sensor_msgs/msg/CameraInfo")
CALIBRATION = f"""
image_width: {WIDTH}
image_height: {HEIGHT}
camera_name: front
camera_matrix: {{rows: 3, cols: 3, data: [60, 0, 32, 0, 61, 24, 0, 0, 1]}}
distortion_model: plumb_bob
distortion_coefficients: {{rows: 1, cols: 5, data: [0.1, -0.2, 0.001, 0.002, 0.0]}}
rectification_matrix: {{rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}}
projection_matrix: {{rows: 3, cols: 4, data: [60, 0, 32, 0, 0, 61, 24, 0, 0, 0, 1, 0]}}
"""


@pytest.fixture
def movie(tmp_path: Path) -> Path:
    """A video of two frames: blue, then red."""
    import cv2

    path = tmp_path / "film.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), 10.0, (WIDTH, HEIGHT))
    for color in ((255, 0, 0), (0, 0, 255)):
        writer.write(np.full((HEIGHT, WIDTH, 3), color, np.uint8))
    writer.release()
    return path


@pytest.fixture
def calibration(tmp_path: Path) -> Path:
    path = tmp_path / "front.yaml"
    path.write_text(CALIBRATION, encoding="utf-8")
    return path


@pytest.fixture
async def run_node(harness):
    nodes = []

    async def run(node_class, **parameters):
        nodes.append(node_class(harness.graph, NodeOptions(parameters=parameters)))
        images, infos = [], []
        harness.node.create_subscription(IMAGE, "/image_raw", images.append, 10)
        harness.node.create_subscription(INFO, "/camera_info", infos.append, 10)
        await harness.graph.settle()
        return images, infos

    yield run
    for node in nodes:
        node.close()


def main_color(image) -> str:
    """Return the name of the channel with the highest mean."""
    pixels = np.asarray(image.data, np.uint8).reshape(image.height, image.width, 3)
    return ("red", "green", "blue")[int(pixels.mean(axis=(0, 1)).argmax())]


async def test_video_file_is_published_and_repeated(harness, run_node, movie):
    images, infos = await run_node(V4L2Camera, video_device=str(movie), camera_frame_id="eye")
    await harness.clock.advance(0.35)  # of a video with 10 images a second
    assert [main_color(image) for image in images] == ["blue", "red", "blue"]
    image, info = images[0], infos[0]
    assert (image.encoding, image.width, image.height, image.step) == ("rgb8", WIDTH, HEIGHT, WIDTH * 3)
    assert image.header.frame_id == info.header.frame_id == "eye"
    assert image.header.stamp == info.header.stamp
    assert (info.width, info.height, list(info.k)) == (WIDTH, HEIGHT, [0.0] * 9)


async def test_calibration_file_is_published(harness, run_node, movie, calibration):
    parameters = {"camera_info_url": calibration.as_uri(), "camera_name": "front", "pixel_format": "mjpeg2rgb"}
    images, infos = await run_node(UsbCam, video_device=str(movie), framerate=50.0, **parameters)
    await harness.clock.advance(0.11)
    assert list(infos[0].k) == [60, 0, 32, 0, 61, 24, 0, 0, 1]
    assert (infos[0].distortion_model, infos[0].header.frame_id) == ("plumb_bob", "default_cam")
    assert images[0].encoding == "rgb8"


async def test_calibration_of_another_size_is_not_published(harness, run_node, movie, tmp_path, calibration):
    calibration.write_text(CALIBRATION.replace(f"image_width: {WIDTH}", "image_width: 640"), encoding="utf-8")
    _, infos = await run_node(V4L2Camera, video_device=str(movie), camera_info_url=str(calibration))
    await harness.clock.advance(0.11)
    assert (infos[0].width, list(infos[0].k)) == (WIDTH, [0.0] * 9)


async def test_video_file_in_the_folder_of_devices_is_no_device(harness, run_node, movie, monkeypatch):
    monkeypatch.setattr(video, "DEVICE_FOLDER", f"{movie.parent}/")
    images, _ = await run_node(V4L2Camera, video_device=str(movie))
    await harness.clock.advance(0.15)
    assert [main_color(image) for image in images] == ["blue"]


async def set_camera_info(harness, **fields):
    """Call the service of usb_cam, and return the response."""
    client = harness.node.create_client(get_service("sensor_msgs/srv/SetCameraInfo"), "/usb_cam/set_camera_info")
    future = client.call_async(client.srv_type.Request(camera_info=INFO(**fields)))
    await harness.graph.settle()
    return future.result()


async def test_calibration_is_stored_and_published_by_service(harness, run_node, movie, tmp_path):
    path = tmp_path / "new" / "front.yaml"
    parameters = {"camera_info_url": path.as_uri(), "camera_name": "front", "pixel_format": "mjpeg2rgb"}
    _, infos = await run_node(UsbCam, video_device=str(movie), framerate=50.0, **parameters)
    await harness.clock.advance(0.05)
    matrices = {"k": [float(n) for n in range(9)], "r": [1.0] * 9, "p": [0.5] * 12, "d": [0.1, -0.2, 0.0, 0.0]}
    response = await set_camera_info(harness, width=WIDTH, height=HEIGHT, distortion_model="fisheye", **matrices)
    assert response.success
    await harness.clock.advance(0.05)
    assert (list(infos[0].k), list(infos[-1].k)) == ([0.0] * 9, matrices["k"])
    name, stored = read_calibration(path)
    assert (name, stored.width, stored.height, stored.distortion_model) == ("front", WIDTH, HEIGHT, "fisheye")
    assert {field: list(getattr(stored, field)) for field in matrices} == matrices


async def test_calibration_that_cannot_be_stored_gets_the_reason(harness, run_node, movie):
    url = (movie / "front.yaml").as_uri()  # below a file
    await run_node(UsbCam, video_device=str(movie), camera_info_url=url, pixel_format="mjpeg2rgb")
    response = await set_camera_info(harness, width=WIDTH, height=HEIGHT)
    assert not response.success
    assert "Error storing camera calibration" in response.status_message
    assert str(movie / "front.yaml") in response.status_message


async def test_capture_stops_and_starts_by_service(harness, run_node, movie):
    images, _ = await run_node(UsbCam, video_device=str(movie), framerate=10.0, pixel_format="yuyv")
    client = harness.node.create_client(get_service("std_srvs/srv/SetBool"), "/set_capture")
    counts, texts = [], []
    for is_on in (True, False, True):
        future = client.call_async(client.srv_type.Request(data=is_on))
        await harness.graph.settle()
        texts.append(future.result().message)
        await harness.clock.advance(0.2)
        counts.append(len(images))
    assert counts == [2, 2, 4]
    assert texts == ["Start Capturing", "Stop Capturing", "Start Capturing"]
    assert images[0].encoding == "yuv422_yuy2"


async def test_v4l2_camera_without_device_stays_and_says_so(run_node, log):
    images, _ = await run_node(V4L2Camera, video_device="/dev/video987")
    assert not images
    assert [record for record in log if "camera '/dev/video987' cannot be opened" in str(record.text)]


@pytest.mark.parametrize("text", [None, "no video"])
async def test_usb_cam_without_camera_ends(harness, tmp_path, text):
    path = tmp_path / "film.avi"
    if text is not None:
        path.write_text(text, encoding="utf-8")
    with pytest.raises(LinkwrightError) as caught:
        UsbCam(harness.graph, NodeOptions(parameters={"video_device": str(path)}))
    assert caught.value.diagnostics[0].code == "VISION115"


@pytest.mark.parametrize(
    ("node_class", "parameters"),
    [
        (V4L2Camera, {"output_encoding": "rgb9"}),
        (V4L2Camera, {"image_size": [640]}),
        (UsbCam, {"framerate": 0.0}),
        (UsbCam, {"image_width": 0}),
    ],
)
async def test_invalid_values_are_refused(harness, movie, node_class, parameters):
    with pytest.raises(LinkwrightError) as caught:
        node_class(harness.graph, NodeOptions(parameters={"video_device": str(movie), **parameters}))
    assert caught.value.diagnostics[0].code == "NODE433"


class FakeDevice:
    """A capture of OpenCV that yields one color and records what is set."""

    def __init__(self, path, backend) -> None:
        import cv2

        self.cv2, self.values = cv2, {}
        FakeDevice.last = self

    def isOpened(self) -> bool:  # noqa: N802  # OpenCV's name
        return True

    def set(self, number, value) -> bool:
        self.values[number] = value
        return number != self.cv2.CAP_PROP_GAIN

    def get(self, number) -> float:
        return self.values.get(number, 0.0)

    def read(self):
        return True, np.full((HEIGHT, WIDTH, 3), (0, 255, 0), np.uint8)

    def release(self) -> None:
        self.values["released"] = True


async def test_device_is_read_in_a_thread_with_its_settings(harness, run_node, movie, monkeypatch, log):
    import cv2

    monkeypatch.setattr(cv2, "VideoCapture", FakeDevice)
    monkeypatch.setattr(video, "is_device", lambda path: path == str(movie))
    parameters = {"pixel_format": "mjpeg2rgb", "brightness": 10, "gain": 5, "image_width": 320, "image_height": 240}
    images, _ = await run_node(UsbCam, video_device=str(movie), **parameters)
    await eventually(lambda: images)
    assert main_color(images[0]) == "green"
    values = FakeDevice.last.values
    assert (values[cv2.CAP_PROP_FRAME_WIDTH], values[cv2.CAP_PROP_FRAME_HEIGHT]) == (320, 240)
    assert values[cv2.CAP_PROP_FOURCC] == cv2.VideoWriter_fourcc(*"MJPG")
    assert values[cv2.CAP_PROP_BRIGHTNESS] == 10
    assert [record for record in log if "GAIN" in str(record.text)]


@pytest.mark.parametrize("encoding", ["rgb8", "bgr8", "rgba8", "bgra8", "mono8", "yuv422", "yuv422_yuy2"])
def test_images_have_the_bytes_of_their_encoding(encoding):
    frame = np.full((4, 6, 3), (10, 20, 200), np.uint8)
    image = create_image(frame, encoding)
    assert (image.width, image.height, len(image.data)) == (6, 4, image.step * 4)
    first = list(np.asarray(image.data)[:4])
    luma = first[1 if encoding == "yuv422" else 0]
    expected = {"rgb8": [200, 20, 10], "bgr8": [10, 20, 200], "rgba8": [200, 20, 10], "bgra8": [10, 20, 200]}
    if encoding in expected:
        assert first[:3] == expected[encoding]
    else:
        assert luma == pytest.approx(0.299 * 200 + 0.587 * 20 + 0.114 * 10, abs=16)


def test_calibration_urls(tmp_path):
    environment = {"ROS_HOME": str(tmp_path)}
    assert locate_calibration("", "front", environment) == tmp_path / "camera_info" / "front.yaml"
    assert locate_calibration("file://${ROS_HOME}/${NAME}.yml", "left", environment) == tmp_path / "left.yml"


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("image_width", "width", "image_width is missing"),
        ("[60, 0, 32, 0, 61, 24, 0, 0, 1]", "[60]", "camera_matrix has 1 values, not 9"),
        ("image_width: 64", "image_width: wide", "wide"),
        ("image_width", "{", "line"),
    ],
)
def test_broken_calibration_files_are_errors(calibration, old, new, reason):
    calibration.write_text(CALIBRATION.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(LinkwrightError) as caught:
        read_calibration(calibration)
    assert caught.value.diagnostics[0].code == "VISION114"
    assert reason in str(caught.value.diagnostics[0].message)


def test_missing_calibration_file_is_an_error(tmp_path):
    with pytest.raises(LinkwrightError, match="cannot be read"):
        read_calibration(tmp_path / "none.yaml")
