"""Datasets of a simulated world with exact labels, in COCO and YOLO format."""
