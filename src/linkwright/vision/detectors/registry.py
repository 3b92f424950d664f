"""The available detectors: networks by path or model name, others by entry point.

Entry points are in the group ``linkwright.detectors``. Each names a callable that takes `DetectorOptions`, returns a
`Detector`, and raises LinkwrightError if its library is missing.
"""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase, quoted_names
from linkwright.diagnostics.extension_errors import load_extension
from linkwright.loading.extensions import extensions
from linkwright.model_files import find_model, model_table
from linkwright.vision.detector import Detector
from linkwright.vision.detectors.efficientdet import EfficientDetDetector
from linkwright.vision.detectors.network import NetworkDetector
from linkwright.vision.detectors.options import DetectorOptions

DEFAULT_DETECTOR = "things"
"""The name of the detector that is used unless another is chosen."""

_GROUP = "linkwright.detectors"
_MODEL_KIND = "vision"
_OTHER_FORMATS = (".pt", ".pth", ".weights", ".engine", ".torchscript", ".pb", ".h5", ".xml", ".mlpackage")


def detector_names() -> tuple[str, ...]:
    """Return the names of the installed detectors."""
    return tuple(extensions(_GROUP))


def make_detector(model: str, options: DetectorOptions) -> Detector:
    """Create a detector by its name, or from a network in an ONNX or TFLite file.

    The name can belong to a model that `linkwright models get` has fetched.

    Raises:
        LinkwrightError: VISION102 there is no such detector or file, VISION104 the file has another format, VISION113
            the package that provides the detector cannot be imported; or an error of the detector itself.
    """
    entry_point = extensions(_GROUP).get(model)
    if entry_point is not None:
        message = phrase("the detector '{name}' cannot be imported", name=model)
        detector: Detector = load_extension(entry_point, "VISION113", message)(options)
        return detector
    entry = model_table().get(model)
    file = find_model(entry) if entry is not None and entry.kind == _MODEL_KIND else Path(model).expanduser()
    if file.suffix.lower() in _OTHER_FORMATS:
        message = phrase("'{file}' is not an ONNX file", file=file)
        ultralytics_hint = phrase(
            "export the network to ONNX, for example with Ultralytics: `yolo export model={file} format=onnx`",
            file=file.name,
        )
        export_hint = phrase("export the network to ONNX")
        hint = ultralytics_hint if file.suffix.lower() == ".pt" else export_hint
        raise LinkwrightError(Diagnostic("VISION104", message, hint=hint))
    if not file.is_file():
        names = detector_names()
        message = phrase("there is neither a file nor a detector '{model}'", model=model)
        hint = did_you_mean(model, names) or phrase("pass an ONNX file, or one of {names}", names=quoted_names(names))
        raise LinkwrightError(Diagnostic("VISION102", message, hint=hint))
    detector_class = EfficientDetDetector if file.suffix.lower() == ".tflite" else NetworkDetector
    return detector_class(file, options)
