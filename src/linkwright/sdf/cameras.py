"""``<camera>``: cameras of all kinds.

Source of the elements and defaults: the SDFormat specification 1.12, ``camera.sdf``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.noise import NO_NOISE, Noise, make_noise_rule
from linkwright.sdf.poses import AT_ORIGIN, POSE, RawPose
from linkwright.sdf.values import INTEGER, NUMBER, TEXT, TRUTH, VECTOR2, object_rule, value


@dataclass(frozen=True, slots=True)
class ImageFormat:
    """The size in pixels and the format of a camera's image, such as ``R8G8B8``."""

    width: int = 320
    height: int = 240
    format: str = "R8G8B8"


@dataclass(frozen=True, slots=True)
class Clip:
    """The near and the far clipping distance, in meters."""

    near: float = 0.1
    far: float = 100.0


@dataclass(frozen=True, slots=True)
class Distortion:
    """The coefficients of Brown's lens distortion.

    `center` is a fraction of the image size in x and y.
    """

    k1: float = 0.0
    k2: float = 0.0
    k3: float = 0.0
    p1: float = 0.0
    p2: float = 0.0
    center: tuple[float, float] = (0.5, 0.5)


@dataclass(frozen=True, slots=True)
class Intrinsics:
    """The focal lengths and the image center in pixels, and the skew."""

    fx: float = 277.0
    fy: float = 277.0
    cx: float = 160.0
    cy: float = 120.0
    s: float = 0.0


@dataclass(frozen=True, slots=True)
class Camera:
    """A camera that looks along the x axis of its frame, with the z axis up.

    Attributes:
        name: the name, which distinguishes several cameras of a sensor.
        pose: the pose in the frame of the sensor.
        horizontal_fov: the horizontal field of view, in radians.
        image: the size and format of the image.
        clip: the minimum and the maximum distance at which the camera sees objects.
        noise: the noise on each color value; color values are from 0 to 1.
        distortion: the distortion of the lens; None for a lens without distortion.
        intrinsics: the intrinsics, which override the field of view; None to compute them from the field of view.
        depth_clip: the range of a depth camera; None to use `clip`.
        segmentation_type: ``semantic`` or ``instance`` (also ``panoptic``).
        box_type: ``2d``, ``visible_2d``, ``full_2d`` or ``3d``.
        camera_info_topic: the topic of the camera info; empty for the default topic.
        optical_frame_id: the frame of the images; empty for the frame of the sensor.
        triggered: whether the camera renders images only on request.
        trigger_topic: the topic on which images are requested if `triggered` is set.
        visibility_mask: a bit mask; the camera sees visuals whose flags have a bit in common with it.
    """

    name: str = ""
    pose: RawPose = AT_ORIGIN
    horizontal_fov: float = 1.047
    image: ImageFormat = ImageFormat()
    clip: Clip = Clip()
    noise: Noise = NO_NOISE
    distortion: Distortion | None = None
    intrinsics: Intrinsics | None = None
    depth_clip: Clip | None = None
    segmentation_type: str = "semantic"
    box_type: str = "2d"
    camera_info_topic: str = ""
    optical_frame_id: str = ""
    triggered: bool = False
    trigger_topic: str = ""
    visibility_mask: int = 0xFFFFFFFF


_CLIP_VALUES = (
    value("near", NUMBER, "the near clipping distance", "m", default="0.1"),
    value("far", NUMBER, "the far clipping distance", "m", default="100"),
)


@dataclass(frozen=True, slots=True)
class _Lens:
    intrinsics: Intrinsics | None


@dataclass(frozen=True, slots=True)
class _DepthCamera:
    clip: Clip | None


def _create_camera(lens: _Lens | None, depth_camera: _DepthCamera | None, **values: Any) -> Camera:
    return Camera(
        intrinsics=lens.intrinsics if lens else None, depth_clip=depth_camera.clip if depth_camera else None, **values
    )


CAMERA = ElementRule(
    "camera",
    "the optics and images of a camera",
    (AttributeRule("name", TEXT, "the name, which distinguishes several cameras", default=""),),
    (
        POSE,
        value("horizontal_fov", NUMBER, "the horizontal field of view", "rad", default="1.047"),
        object_rule(
            ImageFormat,
            "image",
            "the size and format of the image",
            value("width", INTEGER, "the width", default="320"),
            value("height", INTEGER, "the height", default="240"),
            value("format", TEXT, "the pixel format, such as R8G8B8 or L8", default="R8G8B8"),
            default=ImageFormat(),
        ),
        object_rule(Clip, "clip", "the near and far clipping distances", *_CLIP_VALUES, default=Clip()),
        make_noise_rule(),
        object_rule(
            Distortion,
            "distortion",
            "the distortion of the lens",
            value("k1", NUMBER, "the first radial coefficient", default="0"),
            value("k2", NUMBER, "the second radial coefficient", default="0"),
            value("k3", NUMBER, "the third radial coefficient", default="0"),
            value("p1", NUMBER, "the first tangential coefficient", default="0"),
            value("p2", NUMBER, "the second tangential coefficient", default="0"),
            value("center", VECTOR2, "the center of distortion, as fractions of the image size", default="0.5 0.5"),
        ),
        object_rule(
            _Lens,
            "lens",
            "the lens",
            object_rule(
                Intrinsics,
                "intrinsics",
                "the focal lengths and the principal point, in pixels",
                value("fx", NUMBER, "the horizontal focal length", "pixels", default="277"),
                value("fy", NUMBER, "the vertical focal length", "pixels", default="277"),
                value("cx", NUMBER, "the principal point in x", "pixels", default="160"),
                value("cy", NUMBER, "the principal point in y", "pixels", default="120"),
                value("s", NUMBER, "the skew", default="0"),
            ),
            get=lambda camera: _Lens(camera.intrinsics) if camera.intrinsics else None,
        ),
        object_rule(
            _DepthCamera,
            "depth_camera",
            "the range of a depth camera",
            object_rule(Clip, "clip", "the minimum and maximum distance", *_CLIP_VALUES),
            get=lambda camera: _DepthCamera(camera.depth_clip) if camera.depth_clip else None,
        ),
        value("segmentation_type", TEXT, "the segmentation: semantic, instance or panoptic", default="semantic"),
        value("box_type", TEXT, "the kind of bounding box: 2d, visible_2d, full_2d or 3d", default="2d"),
        value("camera_info_topic", TEXT, "the topic of the camera info", default=""),
        value("optical_frame_id", TEXT, "the frame of the images", default=""),
        value("triggered", TRUTH, "whether the camera renders images only on request", default="false"),
        value("trigger_topic", TEXT, "the topic on which images are requested", default=""),
        value("visibility_mask", INTEGER, "a bit mask of the visuals that are visible", default="4294967295"),
    ),
    is_repeated=True,
    make=_create_camera,
    keeps_element=True,
    field="cameras",
)
