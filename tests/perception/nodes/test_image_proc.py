"""image_proc: rectified and resized images, against OpenCV and against formulas."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from linkwright.perception.nodes.crop_decimate import CropDecimateNode
from linkwright.perception.nodes.debayer import DebayerNode
from linkwright.perception.nodes.image_arrays import create_resizing, to_array, to_image
from linkwright.perception.nodes.image_proc import RectifyNode, ResizeNode
from linkwright.perception.nodes.rectification import create_rectification

IMAGE, INFO = get_message("sensor_msgs/msg/Image"), get_message("sensor_msgs/msg/CameraInfo")
WIDTH, HEIGHT = 64, 48
K = [60.0, 0.0, 31.0, 0.0, 58.0, 24.5, 0.0, 0.0, 1.0]
P = [50.0, 0.0, 32.0, 0.0, 0.0, 50.0, 23.0, 0.0, 0.0, 0.0, 1.0, 0.0]
PLUMB_BOB = [-0.3, 0.12, 0.002, -0.001, 0.01]
RATIONAL = [0.5, 0.1, 0.001, -0.002, 0.02, 0.6, 0.15, 0.03]
FISHEYE = [0.05, -0.02, 0.01, -0.003]


def camera_info(model: str = "plumb_bob", d=PLUMB_BOB, stamp: int = 1, **fields):
    info = INFO(width=WIDTH, height=HEIGHT, distortion_model=model, d=list(d), k=K, p=P, **fields)
    info.r = [0.999, -0.01, 0.04, 0.0102, 0.99994, -0.003, -0.0399, 0.0034, 0.9992]
    info.header.stamp.sec = stamp
    return info


def image(pixels: np.ndarray, encoding: str, stamp: int = 1):
    message = to_image(pixels, IMAGE(encoding=encoding))
    message.header.stamp.sec, message.header.frame_id = stamp, "camera"
    return message


def smooth_pixels(channels: int = 3, dtype: str = "u1") -> np.ndarray:
    rows, columns = np.mgrid[:HEIGHT, :WIDTH]
    values = [100 + 60 * np.sin(columns / (7 + i)) * np.cos(rows / (5 + i)) for i in range(channels)]
    return np.stack(values, axis=-1).astype(dtype)


@pytest.mark.parametrize(
    ("model", "d"),
    [
        ("plumb_bob", PLUMB_BOB),
        ("plumb_bob", PLUMB_BOB[:4]),
        ("rational_polynomial", RATIONAL),
        ("equidistant", FISHEYE),
    ],
)
def test_rectification_samples_where_opencv_does(model, d):
    cv2 = pytest.importorskip("cv2")
    info = camera_info(model, d)
    matrices = np.array(K).reshape(3, 3), np.array(d), np.array(info.r).reshape(3, 3), np.array(P).reshape(3, 4)[:, :3]
    create_map = cv2.fisheye.initUndistortRectifyMap if model == "equidistant" else cv2.initUndistortRectifyMap
    columns, rows = create_map(*matrices, (WIDTH, HEIGHT), cv2.CV_32FC1)
    sampling = create_rectification(info)
    np.testing.assert_allclose(sampling.columns, columns, atol=1e-3)
    np.testing.assert_allclose(sampling.rows, rows, atol=1e-3)
    pixels = smooth_pixels()
    expected = cv2.remap(pixels, columns, rows, cv2.INTER_LINEAR)
    difference = np.abs(sampling.apply(pixels).astype(int) - expected.astype(int))
    assert difference.max() <= 3  # OpenCV has steps of 1/32 pixel
    assert difference.mean() < 0.5


@pytest.mark.parametrize("interpolation", [0, 1])
@pytest.mark.parametrize("factors", [(0.5, 0.5), (1.5, 2.0), (0.3, 1.25)])
def test_resizing_matches_opencv(interpolation, factors):
    cv2 = pytest.importorskip("cv2")
    pixels = smooth_pixels(1, "f4")
    expected = cv2.resize(pixels, (0, 0), fx=factors[0], fy=factors[1], interpolation=interpolation)
    size = expected.shape[1], expected.shape[0]
    result = create_resizing((WIDTH, HEIGHT), size, factors, interpolation).apply(pixels)[..., 0]
    np.testing.assert_allclose(result, expected, atol=0.05)


@pytest.mark.parametrize(
    ("encoding", "dtype", "channels"),
    [
        ("mono8", "u1", 1),
        ("bgra8", "u1", 4),
        ("rgb16", "u2", 3),
        ("16UC1", "u2", 1),
        ("32FC2", "f4", 2),
        ("8SC3", "i1", 3),
    ],
)
def test_encodings_keep_their_pixels(encoding, dtype, channels):
    pixels = np.arange(4 * 5 * channels).reshape(4, 5, channels).astype(dtype)
    message = image(pixels, encoding)
    assert message.step == 5 * channels * np.dtype(dtype).itemsize
    assert (to_array(message) == pixels).all()
    swapped = IMAGE(encoding=encoding, width=5, height=4, step=message.step, is_bigendian=1)
    swapped.data = pixels.astype(np.dtype(dtype).newbyteorder(">")).tobytes()
    assert (to_array(swapped) == pixels).all()


@pytest.mark.parametrize("encoding", ["yuv422", "16FC1", "mono32", ""])
def test_unknown_encodings_are_errors(encoding):
    with pytest.raises(ValueError, match="not supported"):
        to_array(IMAGE(encoding=encoding))


class Camera:
    """Publishes images and camera_info, and records the results of a node."""

    def __init__(self, harness, namespace: str, result: str) -> None:
        self.harness = harness
        node = harness.node
        self.images = node.create_publisher(IMAGE, f"{namespace}/image_raw", 10)
        self.infos = node.create_publisher(INFO, f"{namespace}/camera_info", 10)
        self.results, self.result_infos = [], []
        self.result = result

    async def listen(self) -> None:
        node = self.harness.node
        node.create_subscription(IMAGE, self.result, self.results.append, 10)
        node.create_subscription(INFO, f"{self.result.rpartition('/')[0]}/camera_info", self.result_infos.append, 10)
        await self.harness.graph.settle()

    async def publish(self, message, info) -> None:
        self.infos.publish(info)
        self.images.publish(message)
        await self.harness.graph.settle()


@pytest.fixture
async def run_node(harness):
    nodes = []

    async def run(node_class, remappings=(), **parameters):
        nodes.append(node_class(harness.graph, NodeOptions(parameters=parameters, remappings=list(remappings))))
        await harness.graph.settle()

    yield run
    for node in nodes:
        node.close()


async def test_rectified_images_have_header_and_encoding(harness, run_node):
    camera = Camera(harness, "/cam", "/cam/image_rect")
    await run_node(RectifyNode, [("image", "/cam/image_raw"), ("image_rect", "/cam/image_rect")])
    assert not camera.images.get_subscription_count()
    await camera.listen()
    pixels = smooth_pixels()
    await camera.publish(image(pixels, "rgb8"), camera_info())
    (result,) = camera.results
    assert (result.encoding, result.header.frame_id, result.header.stamp.sec) == ("rgb8", "camera", 1)
    assert (to_array(result) == create_rectification(camera_info()).apply(pixels)).all()


async def test_image_waits_for_camera_info_of_its_time(harness, run_node):
    camera = Camera(harness, "/cam", "/cam/image_rect")
    await run_node(RectifyNode, [("image", "/cam/image_raw"), ("image_rect", "/cam/image_rect")])
    await camera.listen()
    await camera.publish(image(smooth_pixels(), "rgb8", stamp=2), camera_info(stamp=1))
    assert not camera.results
    await camera.publish(image(smooth_pixels(), "rgb8", stamp=3), camera_info(stamp=2))
    assert [result.header.stamp.sec for result in camera.results] == [2]


async def test_lens_without_distortion_leaves_images_unchanged(harness, run_node):
    camera = Camera(harness, "/cam", "/cam/image_rect")
    await run_node(RectifyNode, [("image", "/cam/image_raw"), ("image_rect", "/cam/image_rect")])
    await camera.listen()
    pixels = smooth_pixels()
    await camera.publish(image(pixels, "bgr8"), camera_info(d=[0.0] * 5))
    assert (to_array(camera.results[0]) == pixels).all()


async def test_uncalibrated_camera_is_logged(harness, run_node, log):
    camera = Camera(harness, "/cam", "/cam/image_rect")
    await run_node(RectifyNode, [("image", "/cam/image_raw"), ("image_rect", "/cam/image_rect")])
    await camera.listen()
    info = camera_info()
    info.k = [0.0] * 9
    await camera.publish(image(smooth_pixels(), "bgr8"), info)
    assert not camera.results
    assert [record for record in log if "not calibrated" in str(record.text)]


@pytest.mark.parametrize(
    ("parameters", "size", "factors"),
    [
        ({"scale_width": 0.5, "scale_height": 0.25}, (32, 12), (0.5, 0.25)),
        ({"use_scale": False, "width": 16}, (16, 48), (0.25, 1.0)),
    ],
)
async def test_resized_images_have_matching_camera_info(harness, run_node, parameters, size, factors):
    camera = Camera(harness, "/cam", "/small/image_raw")
    remappings = [("image/image_raw", "/cam/image_raw"), ("resize/image_raw", "/small/image_raw")]
    await run_node(ResizeNode, remappings, **parameters)
    await camera.listen()
    await camera.publish(image(smooth_pixels(), "rgb8"), camera_info())
    (result,), (info,) = camera.results, camera.result_infos
    assert (result.width, result.height) == (info.width, info.height) == size
    x, y = factors
    assert list(info.k) == pytest.approx([60 * x, 0, 31 * x, 0, 58 * y, 24.5 * y, 0, 0, 1])
    assert list(info.p)[:7] == pytest.approx([50 * x, 0, 32 * x, 0, 0, 50 * y, 23 * y])
    assert list(info.d) == PLUMB_BOB


@pytest.mark.parametrize(
    ("parameters", "part"),
    [
        ({}, np.s_[:, :]),
        ({"offset_x": 4, "offset_y": 6, "width": 20, "height": 10}, np.s_[6:16, 4:24]),
        ({"decimation_x": 4, "decimation_y": 2}, np.s_[::2, ::4]),
        ({"offset_x": 40, "width": 100, "decimation_x": 3}, np.s_[:, 40:64:3]),
    ],
)
async def test_cropped_images_are_parts_with_matching_camera_info(harness, run_node, parameters, part):
    camera = Camera(harness, "/in", "/out/image_raw")
    await run_node(CropDecimateNode, target_frame_id="part", **parameters)
    await camera.listen()
    pixels = smooth_pixels()
    await camera.publish(image(pixels, "rgb8"), camera_info(binning_x=2))
    (result,), (info,) = camera.results, camera.result_infos
    columns = (WIDTH - parameters.get("offset_x", 0)) // parameters.get("decimation_x", 1)
    expected = pixels[part][:, :columns]
    assert (to_array(result) == expected).all()
    assert result.header.frame_id == info.header.frame_id == "part"
    assert (info.binning_x, info.binning_y) == (
        2 * parameters.get("decimation_x", 1),
        parameters.get("decimation_y", 1),
    )
    assert (info.roi.x_offset, info.roi.y_offset) == (2 * parameters.get("offset_x", 0), parameters.get("offset_y", 0))
    assert info.roi.do_rectify == ("width" in parameters)
    assert list(info.k) == K


@pytest.mark.parametrize(("interpolation", "tolerance"), [(1, 8), (3, 1)])
async def test_decimated_images_are_interpolated_as_by_opencv(harness, run_node, interpolation, tolerance):
    cv2 = pytest.importorskip("cv2")
    camera = Camera(harness, "/in", "/out/image_raw")
    await run_node(CropDecimateNode, interpolation=interpolation, decimation_x=4, decimation_y=4)
    await camera.listen()
    pixels = smooth_pixels()
    await camera.publish(image(pixels, "rgb8"), camera_info())
    expected = cv2.resize(pixels, (WIDTH // 4, HEIGHT // 4), interpolation=interpolation)
    assert np.abs(to_array(camera.results[0]).astype(int) - expected).max() <= tolerance


async def test_decimated_mosaics_have_colors(harness, run_node, log):
    camera = Camera(harness, "/in", "/out/image_raw")
    await run_node(CropDecimateNode, decimation_x=2, decimation_y=2, offset_x=1)
    await camera.listen()
    mosaic = np.zeros((HEIGHT, WIDTH, 1), "u1")
    mosaic[::2, ::2], mosaic[::2, 1::2], mosaic[1::2, ::2], mosaic[1::2, 1::2] = 200, 100, 100, 50
    await camera.publish(image(mosaic, "bayer_rggb8"), camera_info())
    (result,) = camera.results
    assert result.encoding == "bgr8"
    assert (to_array(result) == (50, 100, 200)).all()


async def test_offset_outside_of_the_image_is_logged(harness, run_node, log):
    camera = Camera(harness, "/in", "/out/image_raw")
    await run_node(CropDecimateNode, offset_x=64)
    await camera.listen()
    await camera.publish(image(smooth_pixels(), "rgb8"), camera_info())
    assert not camera.results
    assert [record for record in log if "outside of the image" in str(record.text)]


PATTERNS = {"rggb": ("rg", "gb"), "bggr": ("bg", "gr"), "gbrg": ("gb", "rg"), "grbg": ("gr", "bg")}


@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("pattern", sorted(PATTERNS))
async def test_mosaics_become_gray_and_colored(harness, run_node, pattern, bits):
    gray, color = Camera(harness, "/cam", "/cam/image_mono"), Camera(harness, "/cam", "/cam/image_color")
    names = ("image_raw", "image_mono", "image_color")
    await run_node(DebayerNode, [(name, f"/cam/{name}") for name in names])
    assert not gray.images.get_subscription_count()
    await gray.listen()
    await color.listen()
    scale = 1 if bits == 8 else 256
    values = {"r": 200 * scale, "g": 100 * scale, "b": 50 * scale}
    mosaic = np.zeros((6, 8, 1), f"u{bits // 8}")
    for row, letters in enumerate(PATTERNS[pattern]):
        for column, letter in enumerate(letters):
            mosaic[row::2, column::2] = values[letter]
    gray.images.publish(image(mosaic, f"bayer_{pattern}{bits}"))
    await harness.graph.settle()
    (colored,), (mono,) = color.results, gray.results
    assert (colored.encoding, mono.encoding) == (f"bgr{bits}", f"mono{bits}")
    assert (to_array(colored) == (values["b"], values["g"], values["r"])).all()
    luma = 0.299 * values["r"] + 0.587 * values["g"] + 0.114 * values["b"]
    assert (to_array(mono) == round(luma)).all()
    assert mono.header.frame_id == "camera"


async def test_images_that_need_no_conversion_pass(harness, run_node, log):
    color = Camera(harness, "/cam", "/cam/image_color")
    await run_node(DebayerNode, [("image_raw", "/cam/image_raw"), ("image_color", "/cam/image_color")])
    await color.listen()
    for encoding, channels in (("rgb8", 3), ("mono8", 1), ("8UC3", 3)):
        color.images.publish(image(smooth_pixels(channels), encoding))
        await harness.graph.settle()
    assert [result.encoding for result in color.results] == ["rgb8", "mono8"]
    texts = [str(record.text) for record in log]
    assert any("is grayscale" in text for text in texts)
    assert any("does not tell the colors" in text for text in texts)
