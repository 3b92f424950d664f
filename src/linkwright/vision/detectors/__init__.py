"""Detectors: networks in ONNX files, and those of OpenCV without a network."""
