"""Calibration files of cameras, as camera_calibration writes them and camera_info_manager reads them.

Source: camera_info_manager and camera_calibration_parsers (URLs, default folder, YAML form). Deliberate difference:
files in the INI form and ``flash://`` are not read.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
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


def _read_matrix(values: Any, name: str, count: int) -> list[float]:
    numbers = [float(value) for value in values]
    if len(numbers) != count:
        raise ValueError(f"{name} has {len(numbers)} values, not {count}")
    return numbers
