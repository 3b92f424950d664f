"""web_video_server with clients that read its pages and streams by HTTP."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from io import BytesIO

import aiohttp
import numpy as np
import pytest
from PIL import Image as Picture

from linkwright.bridge.video import WebVideoServer
from linkwright.bridge.video.requests import BadQueryError, ImageRequest
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import SENSOR_DATA_QOS, Graph
from linkwright.messages import get_message
from linkwright.nodes.options import EXECUTABLES, NodeOptions
from tests.waiting import TIMEOUT_S, eventually

pytestmark = pytest.mark.extra("image")

IMAGE, INFO = get_message("sensor_msgs/msg/Image"), get_message("sensor_msgs/msg/CameraInfo")
COMPRESSED = get_message("sensor_msgs/msg/CompressedImage")
RED, BLUE = (255, 0, 0), (0, 0, 255)
WIDTH, HEIGHT = 32, 24


def make_image(upper=RED, lower=RED, encoding: str = "rgb8", second: int = 7):
    """Return an image whose upper and lower half have one color each."""
    pixels = np.empty((HEIGHT, WIDTH, 3), np.uint8)
    pixels[: HEIGHT // 2], pixels[HEIGHT // 2 :] = upper, lower
    image = IMAGE(width=WIDTH, height=HEIGHT, encoding=encoding, step=WIDTH * 3, data=pixels.tobytes())
    image.header.stamp.sec, image.header.stamp.nanosec = second, 250_000_000
    return image


def read_picture(data: bytes):
    """Return the format, the size, and the colors of the upper left and the lower right pixel of a file."""
    picture = Picture.open(BytesIO(data))
    pixels = picture.convert("RGB")
    last = picture.width - 1, picture.height - 1
    return picture.format, picture.size, pixels.getpixel((0, 0)), pixels.getpixel(last)


def main_channel(color) -> int:
    return int(np.argmax(color))


class Setup:
    def __init__(self, **parameters) -> None:
        self.log = []
        self.graph = Graph(on_log=self.log.append)
        self.node = self.graph.create_node("robot")
        self.server = WebVideoServer(self.graph, NodeOptions(parameters={"port": 0, **parameters}))

    def texts(self) -> list[str]:
        return [record.text for record in self.log]

    def camera(self, topic: str = "/camera/image_raw", message_class=IMAGE, qos=10):
        """Return a publisher of images."""
        return self.node.create_publisher(message_class, topic, qos)

    @asynccontextmanager
    async def get(self, path: str, **options):
        timeout = aiohttp.ClientTimeout(TIMEOUT_S)
        async with (
            aiohttp.ClientSession(timeout=timeout) as session,
            session.get(f"{self.server.address.rstrip('/')}{path}", **options) as response,
        ):
            yield response

    async def get_text(self, path: str, **options) -> tuple[int, str]:
        async with self.get(path, **options) as response:
            return response.status, await response.text()

    async def get_snapshot(self, publisher, image, path: str, **options):
        """Request a snapshot, publish an image once somebody has subscribed, and return headers and bytes."""
        task = asyncio.create_task(self._read(path, options))
        await eventually(lambda: publisher.get_subscription_count() == 1 or task.done())
        publisher.publish(image)
        return await task

    async def _read(self, path: str, options):
        async with self.get(path, **options) as response:
            return response.headers, await response.read()


@asynccontextmanager
async def video_server(**parameters):
    setup = Setup(**parameters)
    await eventually(lambda: any("Waiting For connections" in text for text in setup.texts()))
    try:
        yield setup
    finally:
        setup.server.close()
        await setup.server._cleanup_task
        await setup.graph.close()


async def read_part(reader) -> tuple[dict[str, str], bytes]:
    """Read a part of a stream, after a boundary."""
    headers = {}
    while line := (await reader.readline()).strip():
        name, _, value = line.decode().partition(": ")
        headers[name] = value
    data = await reader.readexactly(int(headers["Content-Length"]))
    assert await reader.readline() == b"\r\n"
    assert await reader.readline() == b"--boundarydonotcross\r\n"
    return headers, data


def test_executable_is_registered_for_launch_files():
    assert ("web_video_server", "web_video_server") in EXECUTABLES


async def test_list_has_the_topics_with_images_by_camera():
    async with video_server() as setup:
        assert "No topic has images yet" in (await setup.get_text("/"))[1]
        for topic in ("/camera/image_raw", "/other"):
            setup.camera(topic)
        setup.camera("/camera/camera_info", INFO)
        status, text = await setup.get_text("/")
        assert status == 200
        assert '<li>/camera/<ul><li><a href="/stream_viewer?topic=/camera/image_raw">image_raw</a>' in text
        assert '<ul><li><a href="/stream_viewer?topic=/other">/other</a>' in text
        assert '<a href="/snapshot?topic=/other">Snapshot</a>' in text


async def test_viewer_shows_the_stream_of_its_query():
    async with video_server() as setup:
        _, text = await setup.get_text("/stream_viewer?topic=/a&width=20&type=png")
        assert '<img src="/stream?topic=/a&amp;width=20&amp;type=png"' in text
        _, text = await setup.get_text("/stream_viewer?topic=/%3Cscript%3E")
        assert "<script>" not in text


async def test_snapshot_is_the_next_image():
    async with video_server() as setup:
        headers, data = await setup.get_snapshot(
            setup.camera(), make_image(RED, BLUE), "/snapshot?topic=/camera/image_raw"
        )
        assert headers["Content-Type"] == "image/jpeg"
        assert headers["X-Timestamp"] == "7.250000"
        kind, size, first, last = read_picture(data)
        assert (kind, size, main_channel(first), main_channel(last)) == ("JPEG", (WIDTH, HEIGHT), 0, 2)


async def test_snapshot_is_resized_rotated_and_a_png():
    async with video_server() as setup:
        _, data = await setup.get_snapshot(
            setup.camera(),
            make_image(RED, BLUE, "bgr8"),
            "/snapshot?topic=camera/image_raw&type=png&width=16&height=12&invert",
        )
        assert read_picture(data) == ("PNG", (16, 12), RED, BLUE)  # blue above in BGR, then upside down


async def test_quality_changes_the_size_of_a_jpeg():
    noise = make_image()
    noise.data = np.random.default_rng(1).integers(0, 256, HEIGHT * WIDTH * 3, dtype=np.uint8).tobytes()
    async with video_server() as setup:
        camera = setup.camera()
        lengths = []
        for quality in (10, 95):
            _, data = await setup.get_snapshot(camera, noise, f"/snapshot?topic=/camera/image_raw&quality={quality}")
            lengths.append(len(data))
            await gone(camera)
        assert lengths[0] * 2 < lengths[1]


async def gone(publisher) -> None:
    """Wait until nobody subscribes to a topic."""
    await eventually(lambda: publisher.get_subscription_count() == 0)


async def test_depths_are_scaled_from_black_to_white():
    depths = np.linspace(1.0, 5.0, WIDTH * HEIGHT, dtype=np.float32)
    image = IMAGE(width=WIDTH, height=HEIGHT, encoding="32FC1", step=WIDTH * 4, data=depths.tobytes())
    async with video_server() as setup:
        _, data = await setup.get_snapshot(setup.camera("/depth"), image, "/snapshot?topic=/depth&type=png")
        _, _, first, last = read_picture(data)
        assert (first, last) == ((0, 0, 0), (255, 255, 255))


async def test_stream_sends_each_image_until_the_client_leaves():
    async with video_server() as setup:
        camera = setup.camera()
        await read_stream(setup, camera)
        await gone(camera)


async def publish_to_subscriber(publisher, message) -> None:
    """Publish a message once somebody has subscribed."""
    await eventually(lambda: publisher.get_subscription_count() == 1)
    publisher.publish(message)


async def read_stream(setup: Setup, camera) -> None:
    publishing = asyncio.create_task(publish_to_subscriber(camera, make_image(RED, second=1)))
    async with setup.get("/stream?topic=/camera/image_raw") as response:
        assert response.headers["Content-Type"] == "multipart/x-mixed-replace;boundary=boundarydonotcross"
        assert await response.content.readline() == b"--boundarydonotcross\r\n"
        for second, color in ((1, 0), (2, 2)):
            headers, data = await read_part(response.content)
            assert headers["Content-Type"] == "image/jpeg"
            assert headers["X-Timestamp"] == f"{second}.250000"
            assert main_channel(read_picture(data)[2]) == color
            camera.publish(IMAGE(encoding="no such", width=1, height=1, step=1, data=[0]))  # is left out
            await eventually(lambda: any("Unsupported image encoding" in text for text in setup.texts()))
            camera.publish(make_image(BLUE, second=2))
    await publishing


async def test_stream_without_images_ends_when_its_client_leaves():
    async with video_server() as setup:
        camera = setup.camera()
        task = asyncio.create_task(setup.get_text("/stream?topic=/camera/image_raw"))
        await eventually(lambda: camera.get_subscription_count() == 1)
        task.cancel()
        await gone(camera)


@pytest.mark.parametrize("steps", range(6))
def test_open_stream_ends_silently_with_the_program(caplog, steps):
    async def run() -> None:
        setup = Setup()
        await eventually(lambda: any("Waiting For connections" in text for text in setup.texts()))
        camera = setup.camera()
        client = asyncio.create_task(setup.get_text("/stream?topic=/camera/image_raw"))
        await eventually(lambda: camera.get_subscription_count() == 1)
        setup.server.close()
        for _ in range(steps):
            await asyncio.sleep(0)
        client.cancel()
        await setup.graph.close()

    asyncio.run(run())
    assert [record for record in caplog.records if record.levelname == "ERROR"] == []


async def test_last_image_is_sent_again_at_the_publish_rate():
    async with video_server(publish_rate=50.0) as setup:
        camera = setup.camera()
        publishing = asyncio.create_task(publish_to_subscriber(camera, make_image()))
        async with setup.get("/stream?topic=/camera/image_raw&type=png") as response:
            await response.content.readline()
            parts = [await read_part(response.content) for _ in range(3)]
        await publishing
        assert len({data for _, data in parts}) == 1


async def test_compressed_images_are_passed_on_unchanged():
    file = BytesIO()
    Picture.new("RGB", (8, 8), BLUE).save(file, "JPEG")
    message = COMPRESSED(format="rgb8; jpeg compressed bgr8", data=file.getvalue())
    async with video_server() as setup:
        camera = setup.camera("/camera/image_raw/compressed", COMPRESSED)
        publishing = asyncio.create_task(publish_to_subscriber(camera, message))
        async with setup.get("/stream?topic=/camera/image_raw&type=ros_compressed") as response:
            await response.content.readline()
            assert (await read_part(response.content))[1] == file.getvalue()
        await publishing
        await gone(camera)
        _, data = await setup.get_snapshot(
            camera, message, "/snapshot?topic=/camera/image_raw&default_transport=compressed&type=png"
        )
        assert read_picture(data)[:2] == ("PNG", (8, 8))


async def test_missing_compressed_topic_is_replaced_by_mjpeg():
    async with video_server(default_stream_type="ros_compressed") as setup:
        camera = setup.camera()
        await read_stream(setup, camera)
        assert any("falling back to mjpeg" in text for text in setup.texts())


async def test_qos_profile_of_the_query_receives_unreliable_images():
    async with video_server() as setup:
        camera = setup.camera(qos=SENSOR_DATA_QOS)
        _, data = await setup.get_snapshot(
            camera, make_image(), "/snapshot?topic=/camera/image_raw&qos_profile=sensor_data"
        )
        assert read_picture(data)[0] == "JPEG"


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("/stream", "Name a topic with images"),
        ("/stream?topic=/missing", "No topic '/missing' has images"),
        ("/stream?topic=/a&type=vp8", "'vp8' is not supported here: choose from mjpeg, png, ros_compressed"),
        ("/stream_viewer?topic=/a&type=gif", "There is no stream type 'gif'"),
        ("/snapshot?topic=/a&width=wide", "width cannot be 'wide': it is an integer from 1 to 8192"),
        ("/snapshot?topic=/a&quality=101", "quality cannot be '101': it is an integer from 0 to 100"),
        ("/stream?topic=/a&default_transport=theora2", "default_transport cannot be 'theora2'"),
    ],
)
async def test_request_that_cannot_be_answered_gets_the_reason(path, reason):
    async with video_server() as setup:
        status, text = await setup.get_text(path)
        assert status == 400
        assert reason in text


def test_size_of_minus_one_is_that_of_the_image():
    request = ImageRequest.of({"topic": "a", "width": "-1"}, "png")
    assert (request.topic, request.width, request.quality) == ("/a", None, 3)
    with pytest.raises(BadQueryError, match="0 to 9"):
        ImageRequest.of({"topic": "a", "quality": "50"}, "png")


@pytest.mark.parametrize(
    ("origin", "allowed"), [("http://localhost:8000", "http://localhost:8000"), ("http://example.org", None)]
)
async def test_only_pages_of_this_machine_may_read_images(origin, allowed):
    async with video_server() as setup:
        headers, _ = await setup.get_snapshot(
            setup.camera(), make_image(), "/snapshot?topic=/camera/image_raw", headers={"Origin": origin}
        )
        assert headers.get("Access-Control-Allow-Origin") == allowed


async def test_other_name_of_this_machine_is_refused():
    async with video_server() as setup:
        status, text = await setup.get_text("/", headers={"Host": "example.org"})
        assert (status, "does not answer to the name 'example.org'" in text) == (403, True)


async def test_head_request_of_a_stream_is_refused():
    async with video_server() as setup, aiohttp.ClientSession() as session:
        setup.camera()
        async with session.head(f"{setup.server.address}stream?topic=/camera/image_raw") as response:
            assert response.status == 405


async def test_port_in_use_and_address_of_another_machine_are_errors():
    async with video_server() as setup:
        port = setup.server._listener.getsockname()[1]
        with pytest.raises(LinkwrightError) as raised:
            WebVideoServer(setup.graph, NodeOptions(parameters={"port": port}))
        assert raised.value.diagnostics[0].code == "NODE702"
        assert "another port" in str(raised.value.diagnostics[0].hint)
        with pytest.raises(LinkwrightError) as raised:  # an address for documentation, which no machine has
            WebVideoServer(setup.graph, NodeOptions(parameters={"port": 0, "address": "192.0.2.1"}))
        assert "an address of this machine" in str(raised.value.diagnostics[0].hint)


async def test_missing_stream_type_as_default_is_replaced_and_unknown_one_is_an_error():
    async with video_server(default_stream_type="vp9") as setup:
        assert any("streams of type 'vp9' are not supported" in text for text in setup.texts())
        with pytest.raises(LinkwrightError) as raised:
            WebVideoServer(setup.graph, NodeOptions(parameters={"port": 0, "default_stream_type": "gif"}))
        assert raised.value.diagnostics[0].code == "NODE433"
