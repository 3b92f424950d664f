"""Detectors: networks in ONNX and TFLite files, and OpenCV detectors without a network."""
