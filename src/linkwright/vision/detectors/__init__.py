"""Detectors: networks in ONNX files, and those of OpenCV that need no network."""
