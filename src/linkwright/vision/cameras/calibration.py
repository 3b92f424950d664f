"""Calibration files of cameras, as camera_calibration and camera_info_manager write and read them.

Source: camera_info_manager and camera_calibration_parsers (URLs, default folder, YAML form). Deliberate difference:
files in the INI form and ``flash://`` are not supported.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.messages import get_message
from linkwright.packages import PackageFinder

_MATRICES = {
    "camera_matrix": ("k", 9),
    "rectification_matrix": ("r", 9),
    "projection_matrix": ("p", 12),
}
"""The matrices of a calibration file, each with its field in CameraInfo and its number of values."""


def locate_calibration(url: str, camera: str, environment: Mapping[str, str]) -> Path:
    """Return the path of a calibration file, which need not exist.

    Args:
        url: ``package://``, ``file://`` or a path, with ``${NAME}`` and ``${ROS_HOME}``; empty for
            ``ROS_HOME/camera_info/NAME.yaml``.
        camera: the name of the camera.
        environment: the environment variables.

    Raises:
        LinkwrightError: PKG101 or PKG102, see `PackageFinder.resolve`.
    """
    ros_home = environment.get("ROS_HOME") or str(Path("~/.ros").expanduser())
    address = url or "file://${ROS_HOME}/camera_info/${NAME}.yaml"
    address = address.replace("${NAME}", camera).replace("${ROS_HOME}", ros_home)
    return PackageFinder(start=[Path.cwd()]).resolve(address)


def read_calibration(path: Path) -> tuple[str, Any]:
    """Return the name of the camera and the ``sensor_msgs/msg/CameraInfo`` of a calibration file.

    Raises:
        LinkwrightError: VISION114, the file cannot be read, or is not a calibration.
    """
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
        info = get_message("sensor_msgs/msg/CameraInfo")()
        info.width, info.height = int(content["image_width"]), int(content["image_height"])
        info.distortion_model = str(content.get("distortion_model", "plumb_bob"))
        info.d = [float(value) for value in content["distortion_coefficients"]["data"]]
        for name, (field, count) in _MATRICES.items():
            setattr(info, field, _read_matrix(content[name]["data"], name, count))
        return str(content.get("camera_name", "")), info
    except OSError as error:
        reason: str = error.strerror or str(error)
    except yaml.YAMLError as error:
        reason = " ".join(str(error).split())
    except KeyError as error:
        reason = f"{error.args[0]} is missing"
    except (AttributeError, TypeError, ValueError) as error:
        reason = str(error)
    message = phrase("calibration file '{path}' cannot be read: {reason}", path=str(path), reason=reason)
    hint = phrase("it is YAML as camera_calibration saves it, with image_width, camera_matrix and the like")
    raise LinkwrightError(Diagnostic("VISION114", message, hint=hint))


def write_calibration(path: Path, camera: str, info: Any) -> None:
    """Write a calibration file, and the folders that lack.

    Args:
        path: the file.
        camera: the name of the camera.
        info: the ``sensor_msgs/msg/CameraInfo``.

    Raises:
        LinkwrightError: VISION116, the file cannot be written.
    """
    content: dict[str, Any] = {"image_width": info.width, "image_height": info.height, "camera_name": camera}
    content["distortion_model"] = info.distortion_model
    content["distortion_coefficients"] = _make_matrix(1, info.d)
    for name, (field, _) in _MATRICES.items():
        content[name] = _make_matrix(3, getattr(info, field))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole_file(path, yaml.safe_dump(content, default_flow_style=None, sort_keys=False))
    except OSError as error:
        message = phrase(
            "calibration file '{path}' cannot be written: {reason}",
            path=str(path),
            reason=foreign(error.strerror or str(error)),
        )
        raise LinkwrightError(Diagnostic("VISION116", message)) from None


def _make_matrix(rows: int, values: Any) -> dict[str, Any]:
    numbers = [float(value) for value in values]
    return {"rows": rows, "cols": len(numbers) // rows, "data": numbers}


def _read_matrix(values: Any, name: str, count: int) -> list[float]:
    numbers = [float(value) for value in values]
    if len(numbers) != count:
        raise ValueError(f"{name} has {len(numbers)} values, not {count}")
    return numbers
