"""Find detectors: networks by path or by the name of a fetched model, and packages' detectors by entry point.

Entry points are in the group ``linkwright.detectors``. Each names a callable that takes `DetectorOptions`, returns a
`Detector`, and raises LinkwrightError if its library is missing.
"""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase, quoted_names
from linkwright.loading.extensions import extensions
from linkwright.model_files import find_model, model_table
from linkwright.vision.detector import Detector
from linkwright.vision.detectors.efficientdet import EfficientDetDetector
from linkwright.vision.detectors.network import NetworkDetector
from linkwright.vision.detectors.options import DetectorOptions

DEFAULT_DETECTOR = "things"
"""The default detector."""

_GROUP = "linkwright.detectors"
_KIND = "vision"
_OTHER_FORMS = (".pt", ".pth", ".weights", ".engine", ".torchscript", ".pb", ".h5", ".xml", ".mlpackage")


def detector_names() -> tuple[str, ...]:
    """Return the names of the installed detectors."""
    return tuple(extensions(_GROUP))


def make_detector(model: str, options: DetectorOptions) -> Detector:
    """Create a detector by its name, or from a network in an ONNX or TFLite file.

    Models that `linkwright models get` has fetched are found by their names.

    Raises:
        LinkwrightError: VISION102 there is neither such a detector nor such a file, VISION104 the file contains a
            network in another format; otherwise an error of the detector itself.
    """
    found = extensions(_GROUP).get(model)
    if found is not None:
        detector: Detector = found.load()(options)
        return detector
    entry = model_table().get(model)
    file = find_model(entry) if entry is not None and entry.kind == _KIND else Path(model).expanduser()
    if file.suffix.lower() in _OTHER_FORMS:
        message = phrase("'{file}' is not an ONNX file", file=file)
        export = phrase(
            "only ONNX files are run; export the network, with Ultralytics by `yolo export model={file} format=onnx`",
            file=file.name,
        )
        other = phrase("only ONNX files are run: export the network as one")
        hint = export if file.suffix.lower() == ".pt" else other
        raise LinkwrightError(Diagnostic("VISION104", message, hint=hint))
    if not file.is_file():
        names = detector_names()
        message = phrase("there is neither a file nor a detector '{model}'", model=model)
        hint = did_you_mean(model, names) or phrase("give an ONNX file, or one of {names}", names=quoted_names(names))
        raise LinkwrightError(Diagnostic("VISION102", message, hint=hint))
    kind = EfficientDetDetector if file.suffix.lower() == ".tflite" else NetworkDetector
    return kind(file, options)
