"""static_transform_publisher of tf2_ros: publishes the transform of its arguments."""

from __future__ import annotations

import asyncio
import secrets
import string
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.arrays import quaternion_from_rpy
from linkwright.geometry.single import normalized
from linkwright.graph import STATIC_TF_PUBLISHER_QOS, Graph
from linkwright.messages import TFMessage, TransformBatch
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

USAGE = (
    "static_transform_publisher [--x X] [--y Y] [--z Z] [--qx QX] [--qy QY] [--qz QZ] [--qw QW] "
    "[--roll ROLL] [--pitch PITCH] [--yaw YAW] --frame-id FRAME_ID --child-frame-id CHILD_FRAME_ID"
)
HELP = f"""A command line utility for manually sending a static transform.

usage: {USAGE}

Translations are in meters, and angles are in radians. Deprecated forms with positional arguments:
static_transform_publisher X Y Z YAW PITCH ROLL FRAME_ID CHILD_FRAME_ID
static_transform_publisher X Y Z QX QY QZ QW FRAME_ID CHILD_FRAME_ID"""
_TRANSLATION = ("--x", "--y", "--z")
_QUATERNION = ("--qx", "--qy", "--qz", "--qw")
_ANGLES = ("--roll", "--pitch", "--yaw")
_FRAMES = ("--frame-id", "--child-frame-id")
_POSITIONS_WITH_ANGLES = (*_TRANSLATION, "--yaw", "--pitch", "--roll", *_FRAMES)
_POSITIONS_WITH_QUATERNION = (*_TRANSLATION, *_QUATERNION, *_FRAMES)


@dataclass(frozen=True, slots=True)
class StaticTransform:
    """The pose of the child frame in the parent frame, from the command line.

    The translation is in meters, and the rotation is a unit quaternion x y z w. `is_old_style` is true if the values
    were positional arguments, which are deprecated in tf2_ros.
    """

    translation: tuple[float, float, float]
    rotation: tuple[float, float, float, float]
    frame_id: str
    child_frame_id: str
    is_old_style: bool


def parse_arguments(arguments: Sequence[str]) -> StaticTransform:
    """Parse the command line, with named options or the older eight or nine positional values.

    The positional forms are ``x y z yaw pitch roll frame child`` and ``x y z qx qy qz qw frame child``.

    Raises:
        LinkwrightError: the command line is invalid; the message is tf2_ros's.
    """
    options, positional = _split_arguments(arguments)
    is_old_style = bool(positional)
    if is_old_style:
        names = {8: _POSITIONS_WITH_ANGLES, 9: _POSITIONS_WITH_QUATERNION}.get(len(positional))
        if names is None:
            raise _usage_error(phrase("Extra unparsed arguments on command-line"))
        if options:
            raise _usage_error(phrase("Cannot specify both new-style (flags) and old-style (arguments)"))
        options = dict(zip(names, positional, strict=True))
    if any(name in options for name in _ANGLES) and any(name in options for name in _QUATERNION):
        raise _usage_error(phrase("Cannot specify both quaternion and Euler rotations"))
    for name, label in zip(_FRAMES, ("Frame id", "Child frame id"), strict=True):
        if not options.get(name):
            raise _usage_error(phrase("{argument} must not be empty", argument=label))
    x, y, z = (_parse_number(options, name, 0.0) for name in _TRANSLATION)
    return StaticTransform(
        (x, y, z),
        _parse_rotation(options),
        options["--frame-id"],
        options["--child-frame-id"],
        is_old_style=is_old_style,
    )


class StaticTransformPublisher(SingleNode):
    """The running static_transform_publisher node.

    Raises:
        LinkwrightError: NODE301, the command line is invalid.
    """

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, arguments = create_node(graph, options, f"static_transform_publisher_{_create_random_suffix()}")
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        if any(word in ("-h", "--help") for word in arguments):
            options.output(HELP)
            self.finished.set_result(0)
            return
        with handle_start_errors(self._node):
            self._publish(parse_arguments(arguments))

    def _publish(self, transform: StaticTransform) -> None:
        logger = self._node.get_logger()
        if transform.is_old_style:
            logger.warning("Old-style arguments are deprecated; see --help for new-style arguments")
        publisher = self._node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)
        batch = TransformBatch(
            (transform.frame_id,),
            (transform.child_frame_id,),
            self._node.get_clock().now_ns(),
            np.array([[*transform.translation, *transform.rotation]]),
        )
        publisher.publish(TFMessage(batch=batch))
        translation = ", ".join(f"'{value:f}'" for value in transform.translation)
        rotation = ", ".join(f"'{value:f}'" for value in transform.rotation)
        logger.info(
            f"Spinning until stopped - publishing transform\ntranslation: ({translation})\n"
            f"rotation: ({rotation})\nfrom '{transform.frame_id}' to '{transform.child_frame_id}'"
        )


def _create_random_suffix() -> str:
    """Return random letters and digits that make the node's name unique, as in tf2_ros."""
    return "".join(secrets.choice(string.ascii_letters + string.digits) for _ in range(16))


def _split_arguments(arguments: Sequence[str]) -> tuple[dict[str, str], list[str]]:
    options, positional = {}, []
    known_names = {*_TRANSLATION, *_QUATERNION, *_ANGLES, *_FRAMES}
    waiting = iter(arguments)
    for argument in waiting:
        if argument in known_names:
            value = next(waiting, None)
            if value is None:
                raise _usage_error(phrase("Not enough arguments for {argument}", argument=argument))
            options[argument] = value
        else:
            positional.append(argument)
    return options, positional


def _parse_rotation(options: dict[str, str]) -> tuple[float, float, float, float]:
    if any(name in options for name in _ANGLES):
        x, y, z, w = quaternion_from_rpy([_parse_number(options, name, 0.0) for name in _ANGLES]).tolist()
        return x, y, z, w
    x, y, z = (_parse_number(options, name, 0.0) for name in _QUATERNION[:3])
    w = _parse_number(options, "--qw", 1.0)
    if x == y == z == w == 0.0:
        raise _usage_error(phrase("The quaternion must not be zero"))
    return normalized(x, y, z, w)


def _parse_number(options: dict[str, str], name: str, default: float) -> float:
    text = options.get(name)
    if text is None:
        return default
    try:
        return float(text)
    except ValueError:
        raise _usage_error(phrase("Failed to parse {name} argument as float", name=name)) from None


def _usage_error(reason: str) -> LinkwrightError:
    return LinkwrightError(
        Diagnostic(
            "NODE301",
            phrase("error parsing command line arguments: {reason}", reason=reason),
            hint=phrase("usage: {usage}", usage=USAGE),
        )
    )
