"""The shipped network on rendered images of Linkwright's worlds."""

from __future__ import annotations

import re
from math import atan2, hypot, tan

import numpy as np
import pytest

from linkwright.geometry.single import quaternion_from_rpy
from linkwright.sdf.optics import Optics
from linkwright.simulation.rendering.factory import make_renderer
from linkwright.simulation.rendering.renderer import Channels
from linkwright.simulation.server.worlds import load_world
from linkwright.simulation.simulation import Simulation
from linkwright.vision.detector import Limits
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.registry import make_detector
from linkwright.vision.evaluation import intersection_over_union
from linkwright.vision.models.things import FILE

pytest.importorskip("mujoco", reason="MuJoCo is not installed")

WIDTH, HEIGHT = 640, 480
FOCAL = WIDTH / (2 * tan(0.6))

# The position of a camera in the playground, the model that it looks at, and the class of the model.
POSITIONS_AND_MODELS = [
    ((1.0, -1.6, 0.4), "red_ball", "ball"),
    ((0.3, 0.4, 0.5), "football", "ball"),
    ((1.6, -0.35, 0.4), "cone_1", "cone"),
]


@pytest.fixture(scope="module")
def playground_renderer():
    loaded = load_world("playground")
    simulation = Simulation(loaded.world, loaded.finder)
    simulation.refresh()
    renderer = make_renderer(simulation)
    yield simulation, renderer
    renderer.close()


@pytest.fixture(scope="module")
def things_detector():
    return make_detector("things", DetectorOptions())


def render_model(playground_renderer, camera_position, model):
    """Return an image with a model at its center, and the model's box.

    The box surrounds the model's visible pixels.
    """
    simulation, renderer = playground_renderer
    geoms = [
        number
        for number in range(simulation.model.ngeom)
        if simulation.model.geom(number).name.startswith(f"{model}::")
    ]
    assert geoms, [simulation.model.geom(number).name for number in range(simulation.model.ngeom)]
    x, y, z = simulation.data.geom_xpos[geoms].mean(axis=0) - camera_position
    turn = quaternion_from_rpy((0.0, atan2(-z, hypot(x, y)), atan2(y, x)))
    optics = Optics(WIDTH, HEIGHT, FOCAL, FOCAL, WIDTH / 2, HEIGHT / 2, 0.05, 30.0)
    image = renderer.render(optics, (*camera_position, *turn), Channels.COLOR | Channels.GEOMS)
    rows, columns = np.nonzero(np.isin(image.geoms, geoms))
    return image.color, np.array([[columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]], np.float32)


@pytest.mark.parametrize(
    ("camera_position", "model", "name"), POSITIONS_AND_MODELS, ids=[look[1] for look in POSITIONS_AND_MODELS]
)
def test_network_finds_object_in_front_of_camera(playground_renderer, things_detector, camera_position, model, name):
    image, box = render_model(playground_renderer, camera_position, model)
    detections = things_detector.detect(image, Limits())
    shares = intersection_over_union(box, detections.boxes)[0]
    right = [shares[place] for place in range(len(detections)) if detections.name(place) == name]
    assert max(right, default=0.0) > 0.5


def test_network_finds_nothing_on_empty_floor(things_detector):
    floor = np.full((HEIGHT, WIDTH, 3), 150, np.uint8)
    floor[: HEIGHT // 2] = (184, 204, 224)
    assert len(things_detector.detect(floor, Limits())) == 0


def test_network_is_small_and_has_all_classes(things_detector):
    assert FILE.stat().st_size < 5_000_000
    assert {"ball", "box", "cone", "cylinder", "person", "stop_sign", "table", "yield_sign", "mbot"} == set(
        things_detector.names
    )
    assert things_detector.notes == ()


def test_model_card_matches_file_and_names_failures():
    from hashlib import sha256

    card = FILE.with_suffix(".md").read_text(encoding="utf-8")
    assert sha256(FILE.read_bytes()).hexdigest() in card
    assert "linkwright vision train" in card
    assert re.search(r"^## Where it fails$", card, re.MULTILINE)
